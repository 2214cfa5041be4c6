//! Reading cards, and refusing what no network can mean.

use super::keys::Keys;
use super::{Card, Fit, InputSize, presets};
use crate::DepthError;
use ralf::sensors::DepthOutput;
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// Keys that have no default.
const REQUIRED: [&str; 7] = ["input", "fit", "channels", "divide_by", "mean", "std", "output"];

const SIZE: &str =
    "{ width, height } or { size, multiple_of, side = \"short\" | \"long\" }, of whole numbers above 0";
const FIT: &str = "\"stretch\", \"squares\" or { pad = [red, green, blue] }, of 0 to 255";
/// The widest image that a network is fed, px.
const WIDEST: usize = 16_384;
const POSITIVE: &str = "a number above 0";

impl Card {
    /// Where the card of a network is looked for: beside it, ending in `.toml`.
    pub fn beside(model: &Path) -> PathBuf {
        model.with_extension("toml")
    }

    /// Reads the card `file`.
    pub fn read(file: &Path) -> Result<Self, DepthError> {
        match ralf_files::read_text(file, Kind::Settings) {
            Ok(text) => Self::parse(file, &text),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(DepthError::NoCard {
                card: file.to_owned(),
                presets: presets::names(),
                keys: REQUIRED.to_vec(),
            }),
            Err(error) => Err(DepthError::io(file)(error)),
        }
    }

    /// Reads a card's text. Errors name `file`.
    pub fn parse(file: &Path, text: &str) -> Result<Self, DepthError> {
        let mut keys = Keys::parse(file, text)?;
        let [input, fit, channels, divide_by, mean, std, output] = REQUIRED;
        let card = Self {
            input: keys.required(input, SIZE)?,
            fit: keys.required(fit, FIT)?,
            channels: keys.required(channels, "\"rgb\" or \"bgr\"")?,
            divide_by: keys.required(divide_by, POSITIVE)?,
            mean: keys.required(mean, "three numbers")?,
            std: keys.required(std, "three numbers above 0")?,
            output: keys.required(output, "\"depth\", \"disparity\" or \"metric\"")?,
            output_name: keys.optional("output_name", "the name of an output")?,
            flip: keys.optional("flip", "true or false")?.unwrap_or(false),
            canonical_focal: keys.optional("canonical_focal", POSITIVE)?,
        };
        card.check_numbers(&keys)?;
        card.check_fit(&keys)?;
        keys.finish()?;
        Ok(card)
    }

    fn check_numbers(&self, keys: &Keys<'_>) -> Result<(), DepthError> {
        let sizes = match self.input {
            InputSize::Fixed { width, height } => [width, height],
            InputSize::Scaled { size, multiple_of, .. } => [size, multiple_of],
        };
        if let Some(size) = sizes.iter().find(|size| **size > WIDEST) {
            return Err(keys.error("input", &format!("sizes of at most {WIDEST} px"), &size.to_string()));
        }
        if sizes.contains(&0) {
            return Err(keys.error("input", SIZE, &format!("{} and {}", sizes[0], sizes[1])));
        }
        let above_zero = |key, values: &[f64]| match values.iter().find(|v| !(v.is_finite() && **v > 0.0)) {
            Some(value) => Err(keys.error(key, POSITIVE, &value.to_string())),
            None => Ok(()),
        };
        above_zero("divide_by", &[f64::from(self.divide_by)])?;
        above_zero("std", &self.std.map(f64::from))?;
        above_zero("canonical_focal", self.canonical_focal.as_slice())?;
        if self.mean.iter().any(|value| !value.is_finite()) {
            return Err(keys.error("mean", "three numbers", &format!("{:?}", self.mean)));
        }
        Ok(())
    }

    fn check_fit(&self, keys: &Keys<'_>) -> Result<(), DepthError> {
        let fixed = match self.input {
            InputSize::Fixed { width, height } => Some([width, height]),
            InputSize::Scaled { .. } => None,
        };
        let expected = match self.fit {
            Fit::Squares if fixed.is_none_or(|[width, height]| width != height) => {
                Some("{ width, height } of one value, because fit = \"squares\"")
            }
            Fit::Pad(_) if fixed.is_none() => Some("{ width, height }, because of fit = { pad }"),
            _ => None,
        };
        if let Some(expected) = expected {
            let found = match self.input {
                InputSize::Fixed { width, height } => format!("{width} and {height}"),
                InputSize::Scaled { .. } => "{ size, multiple_of, side }".to_owned(),
            };
            return Err(keys.error("input", expected, &found));
        }
        if let Fit::Pad(colour) = self.fit
            && !colour.iter().all(|value| (0.0..=255.0).contains(value))
        {
            return Err(keys.error("fit", FIT, &format!("{{ pad = {colour:?} }}")));
        }
        if self.canonical_focal.is_none() {
            return Ok(());
        }
        let expected = "none of it, unless output = \"metric\" and fit = \"squares\" or { pad }";
        let usable = self.output == DepthOutput::Metric && self.fit != Fit::Stretch;
        usable.then_some(()).ok_or_else(|| keys.error("canonical_focal", expected, "a value"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::card::{Channels, Side};

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
            input: InputSize::Fixed { width: 48, height: 48 },
            fit: Fit::Squares,
            channels: Channels::Bgr,
            divide_by: 255.0,
            mean: [0.5, 0.0, 0.25],
            std: [1.0, 2.0, 3.0],
            output: DepthOutput::Disparity,
            output_name: Some("disp".to_owned()),
            flip: true,
            canonical_focal: None,
        };
        assert_eq!(card, expected);
    }

    #[test]
    fn every_preset_is_a_card_and_own_keys_replace_its_keys() {
        for name in presets::names() {
            let line = format!("preset = \"{name}\"");
            let card = parse(&line).unwrap();
            assert_eq!(card, parse(presets::text(name).unwrap()).unwrap(), "{name}");
            let changed = parse(&format!("{line}\nflip = true\nmean = [0, 0, 0]")).unwrap();
            assert_eq!(changed, Card { flip: true, mean: [0.0; 3], ..card }, "{name}");
        }
        let fixed = "preset = \"depth-anything-v2-small\"\ninput = { width = 518, height = 518 }";
        assert_eq!(parse(fixed).unwrap().input, InputSize::Fixed { width: 518, height: 518 });
        let metric = parse("preset = \"metric3d-v2-small\"").unwrap();
        assert_eq!((metric.canonical_focal, metric.output), (Some(1000.0), DepthOutput::Metric));
        let scaled = InputSize::Scaled { size: 518, multiple_of: 14, side: Side::Short };
        assert_eq!(parse("preset = \"depth-anything-v2-metric-outdoor\"").unwrap().input, scaled);
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
