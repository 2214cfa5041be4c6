//! A model as text, line by line (docs/learned.md): what differs between two models shows where they differ.

mod net;
mod read;
mod write;

pub use read::ReadError;

use super::model::Model;

/// The first line of every model.
const HEAD: &str = "ralf model 1";

/// What comes with the program.
const SHIPPED: &str = include_str!("../../../models/shipped.txt");

/// The CRC-32 of lines, eight hexadecimal digits; how they end doesn't count, for tools of other systems change that.
fn checksum<'a>(lines: impl Iterator<Item = &'a str>) -> String {
    let mut sum = crc32fast::Hasher::new();
    for line in lines {
        sum.update(line.as_bytes());
        sum.update(b"\n");
    }
    format!("{:08x}", sum.finalize())
}

impl Model {
    /// The model that comes with this version of the program.
    ///
    /// # Errors
    /// None, as long as the program is whole; its tests read it.
    pub fn shipped() -> Result<Self, ReadError> {
        read::model(SHIPPED)
    }

    /// The model as text. Every number is written so that it is read back to the bit.
    pub fn to_text(&self) -> String {
        write::text(self)
    }

    /// Reads [`to_text`](Self::to_text).
    ///
    /// # Errors
    /// The first line that isn't as expected. Whether this program can use the model, [`check`](Self::check) tells.
    pub fn from_text(text: &str) -> Result<Self, ReadError> {
        read::model(text)
    }

    /// Whether a text is a model as [`to_text`](Self::to_text) made it, and nobody changed it since.
    pub fn is_as_written(text: &str) -> bool {
        let end = text.lines().next_back().and_then(|end| end.strip_prefix("end "));
        let before = || text.lines().take(text.lines().count() - 1);
        text.lines().next() == Some(HEAD)
            && end.is_some_and(|end| end == format!("{} {}", before().count(), checksum(before())))
    }
}

#[cfg(test)]
mod tests {
    use super::super::calibration::Calibration;
    use super::super::familiar::Seen;
    use super::super::forest::Forest;
    use super::super::model::{CauseForest, Corrected, Input, Origin, World};
    use super::super::net::tests::net;
    use super::super::tree::Tree;
    use super::super::tree::tests::{leaf, split};
    use super::*;

    fn model() -> Model {
        let tree = Tree::new(vec![split(1, 0.1, true), leaf(-0.3, 7.0), leaf(1e-9, 2.5)]).unwrap();
        let input = |name: &str| Input {
            name: name.to_owned(),
            seen: Seen { low: -1.5, high: 3e20, absent: 0.1, gain: 2.0 },
        };
        let scores = vec![("f1".to_owned(), "0.9123".to_owned())];
        let world = World { name: "town, by day".to_owned(), detections: 9, plausible: 4, scores };
        Model {
            origin: Origin {
                program: "0.1.0 abc".to_owned(),
                command: "ralf learn a b".to_owned(),
                seed: u64::MAX,
                worlds: vec![world.clone()],
            },
            expects: Some(0.25),
            inputs: vec![input("lidar_residual_horizontal"), input("lidar_residual_vertical")],
            plausible: Forest {
                base: -1.0 / 3.0,
                trees: vec![tree.clone(), Tree::new(vec![leaf(0.5, 1.0)]).unwrap()],
            },
            net: Some(net(2)),
            calibration: Calibration::new(vec![(-2.5, 0.01), (0.1, 0.7)]).unwrap(),
            causes: vec![CauseForest {
                name: "side lobe".to_owned(),
                forest: Forest { base: 0.5, trees: vec![tree.clone()] },
            }],
            corrected: Some(Corrected {
                forest: Forest { base: 0.0, trees: vec![tree.clone(), tree] },
                worlds: vec![World { name: "my street".to_owned(), ..world }],
            }),
        }
    }

    #[test]
    fn what_is_written_is_read_back_to_the_bit() {
        assert_eq!(Model::from_text(&model().to_text()), Ok(model()));
        let origin = Origin::default();
        let bare = Model { causes: vec![], net: None, expects: None, corrected: None, origin, ..model() };
        assert_eq!(Model::from_text(&bare.to_text()), Ok(bare));
        assert_eq!(model().check(), Ok(()));
    }

    #[test]
    fn the_shipped_model_can_be_used_and_is_small() {
        let shipped = Model::shipped().unwrap();
        assert_eq!(shipped.check(), Ok(()));
        assert_eq!(shipped.to_text(), SHIPPED);
        assert!(SHIPPED.len() < 2_000_000, "{} bytes", SHIPPED.len());
        assert!(!shipped.origin.worlds.is_empty());
    }

    #[test]
    fn a_text_that_is_cut_short_anywhere_is_refused() {
        let text = model().to_text();
        for end in 0..text.len() - 1 {
            let found = Model::from_text(&text[..end]);
            assert!(found.is_err(), "{end}: {found:?}");
        }
    }

    #[test]
    fn a_line_that_is_lost_or_there_twice_is_refused_where_their_number_is_told() {
        let text = model().to_text();
        let lines: Vec<&str> = text.lines().collect();
        for (at, line) in lines.iter().enumerate() {
            let without = [&lines[..at], &lines[at + 1..]].concat().join("\n") + "\n";
            let twice = text.replacen(line, &format!("{line}\n{line}"), 1);
            assert!(Model::from_text(&without).is_err() && Model::from_text(&twice).is_err(), "{line}");
        }
        let tree = lines.iter().find(|line| line.starts_with("tree")).unwrap();
        let error = Model::from_text(&text.replacen(&format!("{tree}\n"), "", 1)).unwrap_err().to_string();
        assert!(error.contains("for so many lines are before it, found `end "), "{error}");
        for older in ["end", &format!("end {}", lines.len() - 1)] {
            let older = text.replace(lines[lines.len() - 1], older);
            assert_eq!(Model::from_text(&older), Ok(model()));
            assert!(Model::is_as_written(&text) && !Model::is_as_written(&older));
        }
        let changed = text.replacen(lines[1], "program mine", 1);
        assert!(
            !Model::is_as_written(&changed)
                && !Model::is_as_written("")
                && !Model::is_as_written("end 0 0\n")
        );
    }

    #[test]
    fn a_digit_that_is_another_is_refused_and_another_systems_ends_of_lines_are_not() {
        let text = model().to_text();
        for (at, digit) in text.char_indices().filter(|(_, char)| char.is_ascii_digit()) {
            let other = if digit == '1' { "2" } else { "1" };
            let mut changed = text.clone();
            changed.replace_range(at..=at, other);
            assert!(Model::from_text(&changed).is_err(), "{at}: {changed}");
        }
        let error = Model::from_text(&text.replacen("0.9123", "0.9124", 1)).unwrap_err().to_string();
        assert!(error.contains("the checksum of the lines before it"), "{error}");
        assert_eq!(Model::from_text(&text.replace('\n', "\r\n")), Ok(model()));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let refusal = |from: &str, to: &str| {
            let text = model().to_text();
            assert!(text.contains(from), "{from} in {text}");
            Model::from_text(&text.replacen(from, to, 1)).unwrap_err().to_string()
        };
        for (from, to, expected) in [
            ("ralf model 1", "ralf model 2", "line 1: expected `ralf model 1`, found `ralf model 2`"),
            ("seed 18", "seed x18", "line 4: expected seed and a whole number"),
            ("world 9 4", "world 9 10", "line 5: expected world, a count, another of no more"),
            ("input lidar_residual_v", "inputs lidar_residual_v", "expected"),
            ("vertical -1.5 3e20", "vertical 1.5 -3e20", "expected input, a name, a rising range"),
            ("3e20 0.1 2.0", "3e20 -7.0 2.0", "expected input, a name, a rising range, a share in [0, 1]"),
            ("3e20 0.1 2.0", "3e20 0.1 -2.0", "and a worth of 0 or more"),
            (
                "input lidar_residual_v",
                "input lidar_residual_horizontal 0 1 0 1\ninput lidar_residual_v",
                "each input once",
            ),
            ("calibrated 0.1 0.7", "calibrated 0.1 1.7", "expected points of rising log odds"),
            ("tree 1 0.1 y", "tree 1 inf y", "expected finite numbers"),
            ("tree 1 0.1 y", "tree 70000 0.1 y", "expected"),
            ("tree 1 0.1 y", "tree 1 0.1 y 1 0.1 n", "expected a whole tree"),
            ("expects 0.25", "expects 1", "line 6: expected expects and a share between 0 and 1"),
            ("net 2 4", "net 2 0", "expected net and four numbers"),
            ("net 2 4", "net 3 4", "expected `scale`, found `weights "),
            ("scale -1.0 -1.5", "scale -1.0 9.5", "expected pairs of finite numbers whose first rises"),
            ("weights ", "weights 1.0 ", "expected weights and 16 finite numbers"),
            ("\nend", "\nend\nend", "expected no further line, found `end "),
        ] {
            let found = refusal(from, to);
            assert!(found.contains(expected), "{from} -> {to}: {found}");
        }
    }

    #[test]
    fn a_model_that_asks_for_what_nobody_observes_is_refused_by_name() {
        let mut unknown = model();
        unknown.inputs[1].name = "smell".to_owned();
        assert!(unknown.check().unwrap_err().to_string().contains("`smell`"));
        let mut narrow = model();
        narrow.inputs.pop();
        assert!(narrow.check().unwrap_err().to_string().contains("feature 1 of 1"));
        let wide = Model { net: Some(net(3)), ..model() };
        assert_eq!(wide.check().unwrap_err().to_string(), "the model's net reads 3 features of 2");
    }
}
