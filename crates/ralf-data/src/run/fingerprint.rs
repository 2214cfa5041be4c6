//! What results depend on, in short: equal where the results are equal.

use crate::result::{Input, RunRecord};

/// Of all that the sequences of an output folder have in common: program, format and settings.
pub(super) fn of_run(run: &RunRecord) -> String {
    // Debug shows every digit of every setting.
    let settings = format!("{:?}", run.settings);
    let evidence = if run.evidence { "with evidence" } else { "without" };
    let model = run.model.as_deref().unwrap_or("no model");
    of_texts([run.version.as_str(), &run.program, &run.format, &settings, evidence, model])
}

/// Of one sequence: what it has in common with the others, its name and the files that it was read from.
pub(super) fn of_sequence(run: &str, name: &str, inputs: &[Input]) -> String {
    let files = inputs.iter().flat_map(|input| [input.file.as_str(), &input.blake3]);
    of_texts([run, name].into_iter().chain(files))
}

fn of_texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> String {
    let mut hasher = blake3::Hasher::new();
    for text in texts {
        // With its length, so that no two lists of texts look alike.
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    }
    hasher.finalize().to_hex()[..32].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_tells_names_and_contents_apart() {
        let input = |file: &str, blake3: &str| Input {
            sequence: "00".to_owned(),
            file: file.to_owned(),
            bytes: 1,
            mtime_ns: None,
            blake3: blake3.to_owned(),
        };
        let all = [
            of_sequence("run", "00", &[input("a", "b")]),
            of_sequence("run", "01", &[input("a", "b")]),
            of_sequence("other", "00", &[input("a", "b")]),
            of_sequence("run", "00", &[input("a", "c")]),
            of_sequence("run", "00", &[input("c", "b")]),
            of_sequence("run", "00", &[input("ab", "")]),
            of_sequence("run", "00", &[input("a", "b"), input("a", "b")]),
        ];
        assert_eq!(all[0], of_sequence("run", "00", &[input("a", "b")]));
        assert!(all[1..].iter().all(|other| *other != all[0]), "{all:?}");
    }
}
