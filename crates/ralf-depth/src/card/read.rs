//! Reading cards, and refusing what no network can mean.

use super::feed::{FEED, POSITIVE};
use super::keys::Keys;
use super::presets::{DEPTH, Presets};
use super::{Card, Feed, Fit};
use crate::NetworkError;
use ralf::sensors::DepthOutput;
use ralf_files::Kind;
use std::path::{Path, PathBuf};

const OUTPUT: &str = "output";

/// The text of a card; where there is none, the error says what to write.
pub(super) fn text_of(file: &Path, presets: &Presets, further: &'static str) -> Result<String, NetworkError> {
    ralf_files::read_text(file, Kind::Settings).map_err(|error| match error.kind() {
        std::io::ErrorKind::NotFound => NetworkError::NoCard {
            card: file.to_owned(),
            presets: presets.names(),
            keys: FEED.into_iter().chain([further]).collect(),
        },
        _ => NetworkError::io(file)(error),
    })
}

impl Card {
    /// Where the card of a network is looked for: beside it, ending in `.toml`.
    pub fn beside(model: &Path) -> PathBuf {
        model.with_extension("toml")
    }

    /// Reads the card `file`.
    pub fn read(file: &Path) -> Result<Self, NetworkError> {
        Self::parse(file, &text_of(file, &DEPTH, OUTPUT)?)
    }

    /// Reads a card's text. Errors name `file`.
    pub fn parse(file: &Path, text: &str) -> Result<Self, NetworkError> {
        let mut keys = Keys::parse(file, text, &DEPTH)?;
        let card = Self {
            feed: Feed::take(&mut keys)?,
            output: keys.required(OUTPUT, "\"depth\", \"disparity\" or \"metric\"")?,
            output_name: keys.optional("output_name", "the name of an output")?,
            flip: keys.optional("flip", "true or false")?.unwrap_or(false),
            canonical_focal: keys.optional("canonical_focal", POSITIVE)?,
        };
        card.feed.check(&keys)?;
        card.check_focal(&keys)?;
        keys.finish()?;
        Ok(card)
    }

    fn check_focal(&self, keys: &Keys<'_>) -> Result<(), NetworkError> {
        keys.above_zero("canonical_focal", POSITIVE, self.canonical_focal.as_slice())?;
        if self.canonical_focal.is_none() {
            return Ok(());
        }
        let expected = "none of it, unless output = \"metric\" and fit = \"squares\" or { pad }";
        let usable = self.output == DepthOutput::Metric && self.feed.fit != Fit::Stretch;
        usable.then_some(()).ok_or_else(|| keys.error("canonical_focal", expected, "a value"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::card::{Channels, InputSize, Side};

    const WHOLE: &str = r#"
        input = { width = 48, height = 48 }
        fit = "squares"
        channels = "bgr"
        divide_by = 255
        mean = [0.5, 0, 0.25]
        std = [1, 2.0, 3]
        output = "disparity"
        flip = true
    "#;

    fn parse(text: &str) -> Result<Card, String> {
        Card::parse(Path::new("net.toml"), text).map_err(|error| error.to_string())
    }

    #[test]
    fn every_key_is_read() {
        let card = parse(&format!("{WHOLE}\noutput_name = \"disp\"")).unwrap();
        let expected = Card {
            feed: Feed {
                input: InputSize::Fixed { width: 48, height: 48 },
                fit: Fit::Squares,
                channels: Channels::Bgr,
                divide_by: 255.0,
                mean: [0.5, 0.0, 0.25],
                std: [1.0, 2.0, 3.0],
            },
            output: DepthOutput::Disparity,
            output_name: Some("disp".to_owned()),
            flip: true,
            canonical_focal: None,
        };
        assert_eq!(card, expected);
    }

    #[test]
    fn every_preset_is_a_card_and_own_keys_replace_its_keys() {
        for name in DEPTH.names() {
            let line = format!("preset = \"{name}\"");
            let card = parse(&line).unwrap();
            assert_eq!(card, parse(DEPTH.text(name).unwrap()).unwrap(), "{name}");
            let changed = parse(&format!("{line}\nflip = true\nmean = [0, 0, 0]")).unwrap();
            let feed = Feed { mean: [0.0; 3], ..card.feed };
            assert_eq!(changed, Card { flip: true, feed, ..card }, "{name}");
        }
        let fixed = "preset = \"depth-anything-v2-small\"\ninput = { width = 518, height = 518 }";
        assert_eq!(parse(fixed).unwrap().feed.input, InputSize::Fixed { width: 518, height: 518 });
        let metric = parse("preset = \"metric3d-v2-small\"").unwrap();
        assert_eq!((metric.canonical_focal, metric.output), (Some(1000.0), DepthOutput::Metric));
        let scaled = InputSize::Scaled { size: 518, multiple_of: 14, side: Side::Short };
        assert_eq!(parse("preset = \"depth-anything-v2-metric-outdoor\"").unwrap().feed.input, scaled);
    }

    #[test]
    fn whatever_is_wrong_is_named() {
        let with = |line: &str| {
            let key = line.split(' ').next().unwrap();
            let kept = WHOLE.lines().filter(|own| !own.trim().starts_with(&format!("{key} ")));
            format!("{}\n{line}", kept.collect::<Vec<_>>().join("\n"))
        };
        for (text, parts) in [
            (
                with("flipp = true"),
                ["net.toml: flipp: expected one of the keys preset, input", "an unknown key"],
            ),
            (with("flip = 1"), ["flip: expected true or false", "found 1"]),
            (
                with("input = { width = 48 }"),
                ["input: expected { width, height } or", "found { width = 48 }"],
            ),
            (with("input = { width = 48, height = 0 }"), ["input: expected", "found 48 and 0"]),
            (with("input = { width = 48, height = 48, x = 1 }"), ["input: expected", "x = 1"]),
            (with("input = { width = -4, height = 48 }"), ["input: expected", "-4"]),
            (with("input = { width = 48, height = 32 }"), ["because fit = \"squares\"", "48 and 32"]),
            (
                with("input = { size = 48, multiple_of = 2, side = \"long\" }"),
                ["fit = \"squares\"", "{ size, multiple_of, side }"],
            ),
            (with("fit = \"crop\""), ["fit: expected \"stretch\", \"squares\" or", "found \"crop\""]),
            (with("fit = { pad = [0, 0, 256] }"), ["fit: expected", "256"]),
            (with("channels = \"gray\""), ["channels: expected \"rgb\" or \"bgr\"", "\"gray\""]),
            (with("divide_by = 0"), ["divide_by: expected a number above 0", "found 0"]),
            (with("std = [1, 0, 1]"), ["std: expected", "found 0"]),
            (with("std = [1, 1]"), ["std: expected three numbers", "found [1, 1]"]),
            (with("mean = [0, nan, 0]"), ["mean: expected three numbers", "NaN"]),
            (
                with("output = \"height\""),
                ["output: expected \"depth\", \"disparity\" or \"metric\"", "height"],
            ),
            (
                with("canonical_focal = 1000"),
                ["canonical_focal: expected none of it, unless", "found a value"],
            ),
            (with("preset = \"midas\""), ["preset: expected one of midas-small, midas-dpt", "found midas"]),
            ("fit = \"squares\"".to_owned(), ["input: expected", "found nothing"]),
            ("flip = true\nfit = \"".to_owned(), ["net.toml: line 2: expected TOML", "found "]),
        ] {
            let error = parse(&text).expect_err(&text);
            assert!(parts.iter().all(|part| error.contains(part)), "{error}\nlacks one of {parts:?}");
        }
    }

    #[test]
    fn a_missing_card_says_what_to_write() {
        let error = Card::read(&Card::beside(Path::new("nowhere/net.onnx"))).unwrap_err().to_string();
        for part in ["nowhere/net.toml", "preset = \"NAME\"", "midas-small", "input, fit, channels"] {
            assert!(error.contains(part), "{error}");
        }
    }
}
