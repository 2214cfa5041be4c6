//! Words about a recording's files that are the same from wherever the program is started, as the names of inputs are.

use std::path::Path;

/// The words, with files of the recording at `root` named as they lie in it.
pub(crate) fn told_within(words: &str, root: &Path) -> String {
    let typed = root.display().to_string();
    let typed = typed.trim_end_matches(std::path::is_separator);
    if typed.is_empty() {
        return words.to_owned();
    }
    let own_name = root.file_name().unwrap_or_default().to_string_lossy();
    let (mut told, mut rest) = (String::with_capacity(words.len()), words);
    while let Some(at) = rest.find(typed) {
        let (before, after) = (&rest[..at], &rest[at + typed.len()..]);
        let begins = !before.chars().next_back().or_else(|| told.chars().next_back()).is_some_and(goes_on);
        told += before;
        rest = after;
        match after.chars().next() {
            Some(separator) if begins && std::path::is_separator(separator) => {
                rest = &after[separator.len_utf8()..];
            }
            next if begins && !own_name.is_empty() && !next.is_some_and(goes_on) => told += &own_name,
            _ => told += typed,
        }
    }
    told + rest
}

/// Whether a path may go on with this, or a name.
fn goes_on(next: char) -> bool {
    next.is_alphanumeric() || matches!(next, '.' | '-' | '_') || std::path::is_separator(next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_as_they_lie_in_the_recording() {
        let within = |words: &str, root: &str| told_within(words, Path::new(root));
        assert_eq!(within("a/rec/x/1.bin: byte 3", "a/rec"), "x/1.bin: byte 3");
        assert_eq!(within("2 of 3: a/rec/1.bin, a/rec/2.bin", "a/rec/"), "2 of 3: 1.bin, 2.bin");
        assert_eq!(within("./1.bin: of ../b", "."), "1.bin: of ../b");
        assert_eq!(within("drive.mcap: chunk 3", "drive.mcap"), "drive.mcap: chunk 3");
        assert_eq!(within("/data/drive.mcap: chunk 3", "/data/drive.mcap"), "drive.mcap: chunk 3");
        for other in ["b/a/rec/1.bin", "a/record/1.bin", "expected 3.5, found a.5", ""] {
            assert_eq!(within(other, "a/rec"), other);
        }
        assert_eq!(within("/a: not found", "/"), "/a: not found");
    }
}
