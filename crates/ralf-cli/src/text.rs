//! Printing results, and numbers as people read them.

use anyhow::Context;
pub(crate) use ralf_report::{counted, grouped, listed};
use std::borrow::Cow;
use std::io::{self, Write};
use std::path::Path;

/// What may go to a terminal: names and files of others could do anything to it by control characters. These stand as
/// JSON writes them, so that JSON stays what it is; lines and tabs stay.
pub(crate) fn tamed(text: &str) -> Cow<'_, str> {
    let is_wild = |character: char| character.is_control() && !"\n\t".contains(character);
    if !text.contains(is_wild) {
        return text.into();
    }
    let tame = |character: char| match is_wild(character) {
        true => format!("\\u{:04x}", u32::from(character)),
        false => character.to_string(),
    };
    text.chars().map(tame).collect()
}

/// Prints a result to standard output. Whoever reads it may have enough of it, as in `ralf inspect x | head`: that is
/// no failure, and what a command has to say besides is said.
pub(crate) fn print(text: &str) -> anyhow::Result<()> {
    let text = tamed(text);
    let end = if text.ends_with('\n') { "" } else { "\n" };
    let mut stdout = io::stdout().lock();
    let printed = stdout.write_all(text.as_bytes()).and_then(|()| stdout.write_all(end.as_bytes()));
    match printed.and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        printed => printed.context("standard output"),
    }
}

/// What is said over several lines, as one.
pub(crate) fn in_a_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// An error's text in two: the lines of a file that a parser shows, with their numbers, and all else as one line.
pub(crate) fn without_shown_lines(text: &str) -> (String, String) {
    let is_shown = |line: &&str| {
        line.trim_start_matches(|character: char| character == ' ' || character.is_ascii_digit())
            .starts_with('|')
    };
    let lines = text.lines().filter(|line| !line.trim().is_empty());
    let (shown, told): (Vec<&str>, Vec<&str>) = lines.partition(is_shown);
    let mut line = String::new();
    for part in told {
        let goes_on = line.ends_with([':', ',', ';', '.']) || part.starts_with("in `");
        let between = match line.is_empty() || part.starts_with(':') {
            true => "",
            false if goes_on => " ",
            false => ": ",
        };
        line = line + between + part.trim();
    }
    (shown.join("\n"), line)
}

/// A word of a command, so that a shell takes it back as it is.
pub(crate) fn shell_word(word: &str) -> String {
    let is_plain = |character: char| character.is_alphanumeric() || "_-./=:,+@%".contains(character);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// The same of a path.
pub(crate) fn shell_path(path: &Path) -> String {
    shell_word(&path.to_string_lossy())
}

/// That a file's times are later than the recording's, of a warning.
pub(crate) fn delayed(delay_ns: i64) -> String {
    let seconds = counted((delay_ns / 1_000_000_000) as usize, "second");
    format!(
        "all times are {seconds} later than in the recording, for some are before 1970, which ROS doesn't know"
    )
}

/// A share in percent with one decimal, or a dash of nothing.
pub(crate) fn percent(part: u64, whole: u64) -> String {
    if whole == 0 { "-".to_owned() } else { format!("{:.1} %", 100.0 * part as f64 / whole as f64) }
}

/// A value with three decimals; an absent one is a dash.
pub(crate) fn decimal(value: Option<f64>) -> String {
    value.map_or("-".to_owned(), |value| format!("{value:.3}"))
}

/// Rows of cells as aligned columns: the first to the left, the others to the right. The first row is the head.
pub(crate) fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width =
        |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_ends_with_one_line() {
        let text = "a.toml: TOML parse error at line 1, column 9\n  |\n1 | lidar = 3\n  |         ^\nno table\nin `lidar`\n";
        let (shown, told) = without_shown_lines(text);
        assert_eq!(shown, "  |\n1 | lidar = 3\n  |         ^");
        assert_eq!(told, "a.toml: TOML parse error at line 1, column 9: no table in `lidar`");
        assert_eq!(without_shown_lines("a: b").1, "a: b");
        assert_eq!(without_shown_lines("a:\n b\n: c").1, "a: b: c");
    }

    #[test]
    fn control_characters_are_shown_as_json_has_them() {
        assert_eq!(tamed("a\tb\nc\u{e9}"), "a\tb\nc\u{e9}");
        assert_eq!(tamed("\u{1b}[2J\r\u{7}\u{9b}m\u{7f}"), "\\u001b[2J\\u000d\\u0007\\u009bm\\u007f");
        let told = tamed("\"\u{9b}\"");
        assert_eq!(serde_json::from_str::<String>(&told).unwrap(), "\u{9b}");
    }

    #[test]
    fn columns_are_aligned() {
        let rows = [vec!["radar".to_owned(), "n".to_owned()], vec!["a".to_owned(), "1,263".to_owned()]];
        assert_eq!(aligned(&rows), "radar      n\na      1,263\n");
    }
}
