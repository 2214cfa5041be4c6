//! The keys that say how a network is fed.

use super::keys::Keys;
use super::{Feed, Fit, InputSize};
use crate::NetworkError;
use ralf::sensors::MOST_PIXELS;

/// They have no default.
pub(super) const FEED: [&str; 6] = ["input", "fit", "channels", "divide_by", "mean", "std"];

const SIZE: &str =
    "{ width, height } or { size, multiple_of, side = \"short\" | \"long\" }, of whole numbers above 0";
const FIT: &str = "\"stretch\", \"squares\" or { pad = [red, green, blue] }, of 0 to 255";
pub(super) const POSITIVE: &str = "a number above 0";

impl Feed {
    /// Takes its keys out of a card's.
    pub(super) fn take(keys: &mut Keys<'_>) -> Result<Self, NetworkError> {
        let [input, fit, channels, divide_by, mean, std] = FEED;
        Ok(Self {
            input: keys.required(input, SIZE)?,
            fit: keys.required(fit, FIT)?,
            channels: keys.required(channels, "\"rgb\" or \"bgr\"")?,
            divide_by: keys.required(divide_by, POSITIVE)?,
            mean: keys.required(mean, "three numbers")?,
            std: keys.required(std, "three numbers above 0")?,
        })
    }

    /// Refuses what no network can mean.
    pub(super) fn check(&self, keys: &Keys<'_>) -> Result<(), NetworkError> {
        self.check_numbers(keys)?;
        self.check_fit(keys)
    }

    fn check_numbers(&self, keys: &Keys<'_>) -> Result<(), NetworkError> {
        let sizes = match self.input {
            InputSize::Fixed { width, height } => [width, height],
            InputSize::Scaled { size, multiple_of, .. } => [size, multiple_of],
        };
        if let Some(size) = sizes.iter().find(|size| **size > MOST_PIXELS) {
            return Err(keys.error(
                "input",
                &format!("sizes of at most {MOST_PIXELS} px"),
                &size.to_string(),
            ));
        }
        if sizes.contains(&0) {
            return Err(keys.error("input", SIZE, &format!("{} and {}", sizes[0], sizes[1])));
        }
        keys.above_zero("divide_by", POSITIVE, &[f64::from(self.divide_by)])?;
        keys.above_zero("std", POSITIVE, &self.std.map(f64::from))?;
        if self.mean.iter().any(|value| !value.is_finite()) {
            return Err(keys.error("mean", "three numbers", &format!("{:?}", self.mean)));
        }
        Ok(())
    }

    fn check_fit(&self, keys: &Keys<'_>) -> Result<(), NetworkError> {
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
        match self.fit {
            Fit::Pad(colour) if !colour.iter().all(|value| (0.0..=255.0).contains(value)) => {
                Err(keys.error("fit", FIT, &format!("{{ pad = {colour:?} }}")))
            }
            _ => Ok(()),
        }
    }
}
