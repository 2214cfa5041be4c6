//! Values of detections as colours.

use crate::legend::{Entry, Symbol};
use crate::marks::MarkLabel;

/// Colours that the legend shows.
const SHADES: u8 = 5;

/// What the colours of a picture's detections mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ValueScale<'a> {
    /// What it is, with its unit.
    pub name: &'a str,
    /// The value of the darkest colour, which all smaller ones have, too.
    pub least: f64,
    /// The value of the brightest colour, which all larger ones have, too.
    pub largest: f64,
    /// Whether there are smaller and larger values than these, which have their colours.
    pub goes_beyond: [bool; 2],
}

impl<'a> ValueScale<'a> {
    /// A scale on which the middle nine tenths of some values have colours of their own.
    pub fn fitting(name: &'a str, values: &[f64]) -> Self {
        let mut sorted: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let rank =
            |share: f64| sorted.get(((sorted.len().max(1) - 1) as f64 * share).round() as usize).copied();
        let (least, largest) = (rank(0.05).unwrap_or(0.0), rank(0.95).unwrap_or(1.0));
        // Where nearly all values are equal, the few that are not still differ in colour.
        let (least, largest) = if least < largest {
            (least, largest)
        } else {
            (rank(0.0).unwrap_or(0.0), rank(1.0).unwrap_or(1.0))
        };
        let largest = if least < largest { largest } else { least + 1.0 };
        let goes_beyond = [
            sorted.first().is_some_and(|value| *value < least),
            sorted.last().is_some_and(|value| *value > largest),
        ];
        Self { name, least, largest, goes_beyond }
    }

    /// How a detection of a value is drawn; one without is [`MarkLabel::Unlabelled`].
    pub fn mark(&self, value: Option<f64>) -> MarkLabel {
        let share = |value: f64| ((value - self.least) / (self.largest - self.least)).clamp(0.0, 1.0);
        let value = value.filter(|value| value.is_finite());
        value.map_or(MarkLabel::Unlabelled, |value| MarkLabel::Valued((share(value) * 255.0).round() as u8))
    }

    /// The colours with their values.
    pub(crate) fn entries(&self) -> Vec<Entry> {
        let mut entries = vec![Entry::new(Symbol::Nothing, self.name)];
        for step in 0..SHADES {
            let share = f64::from(step) / f64::from(SHADES - 1);
            let value = self.least + share * (self.largest - self.least);
            let shade = MarkLabel::Valued((share * 255.0).round() as u8);
            let sign = match self.goes_beyond {
                [true, _] if step == 0 => "≤ ",
                [_, true] if step == SHADES - 1 => "≥ ",
                _ => "",
            };
            let text = format!("{sign}{}", number(value, self.largest - self.least));
            entries.push(Entry::new(Symbol::Mark(shade), text));
        }
        entries
    }
}

/// A value with as many decimals as its scale needs.
fn number(value: f64, span: f64) -> String {
    let decimals = (2.0 - span.abs().log10()).ceil().clamp(0.0, 6.0) as usize;
    let text = format!("{value:.decimals$}");
    // No zero is negative.
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::text::Typeface;

    #[test]
    fn values_have_the_colours_of_their_place_on_the_scale() {
        let scale = ValueScale { name: "height, m", least: -1.0, largest: 3.0, goes_beyond: [false; 2] };
        for (value, expected) in [
            (Some(-1.0), MarkLabel::Valued(0)),
            (Some(-9.0), MarkLabel::Valued(0)),
            (Some(1.0), MarkLabel::Valued(128)),
            (Some(4.0), MarkLabel::Valued(255)),
            (Some(f64::NAN), MarkLabel::Unlabelled),
            (None, MarkLabel::Unlabelled),
        ] {
            assert_eq!(scale.mark(value), expected, "{value:?}");
        }
        let texts: Vec<String> = scale.entries().into_iter().map(|entry| entry.text).collect();
        assert_eq!(texts, ["height, m", "-1.00", "0.00", "1.00", "2.00", "3.00"]);
        let beyond = ValueScale { goes_beyond: [true, true], ..scale }.entries();
        assert_eq!((beyond[1].text.as_str(), beyond[5].text.as_str()), ("≤ -1.00", "≥ 3.00"));
        let typeface = Typeface::load().unwrap();
        assert!(["≤", "≥"].iter().all(|sign| typeface.has(sign)), "the signs are in the typeface");
    }

    #[test]
    fn a_scale_fits_whatever_there_is() {
        let fitted = |values: &[f64]| {
            let ValueScale { least, largest, .. } = ValueScale::fitting("", values);
            (least, largest)
        };
        let many: Vec<f64> = (0..=100).map(f64::from).collect();
        assert_eq!(fitted(&many), (5.0, 95.0));
        assert_eq!(ValueScale::fitting("", &many).goes_beyond, [true, true]);
        assert_eq!(ValueScale::fitting("", &[1.0, 2.0]).goes_beyond, [false, false]);
        assert_eq!(fitted(&[]), (0.0, 1.0));
        assert_eq!(fitted(&[2.0, 2.0, f64::NAN]), (2.0, 3.0));
        let mut few = vec![0.0; 99];
        few.push(7.0);
        assert_eq!(fitted(&few), (0.0, 7.0));
    }
}
