//! What a depth network's values mean (docs/method.md, section 5).

use crate::sensors::{DepthImage, DepthOutput};

/// A disparity of at most this share of the view's largest says nothing: it is the sky.
const LEAST_DISPARITY: f64 = 1e-3;

/// A depth image read as relative depth: larger is farther, in a unit of its own.
#[derive(Debug, Clone, Copy)]
pub(super) struct RelativeDepth<'a> {
    image: &'a DepthImage,
    output: DepthOutput,
    /// Values at or below this have no depth.
    floor: f64,
}

impl<'a> RelativeDepth<'a> {
    /// Reads an image as what the network gave.
    pub(super) fn new(image: &'a DepthImage, output: DepthOutput) -> Self {
        let floor = match output {
            DepthOutput::Disparity => LEAST_DISPARITY * largest(&image.values),
            DepthOutput::Depth | DepthOutput::Metric => 0.0,
        };
        Self { image, output, floor }
    }

    /// The relative depth of a pixel, counted row by row; `None` where there is none.
    pub(super) fn at(&self, index: usize) -> Option<f64> {
        let value = f64::from(*self.image.values.get(index)?);
        (value > self.floor && value.is_finite()).then(|| match self.output {
            DepthOutput::Disparity => 1.0 / value,
            DepthOutput::Depth | DepthOutput::Metric => value,
        })
    }
}

/// The largest finite value, at least 0.
fn largest(values: &[f32]) -> f64 {
    f64::from(values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(values: &[f32]) -> DepthImage {
        DepthImage { width: values.len(), height: 1, values: values.to_vec() }
    }

    fn all(image: &DepthImage, output: DepthOutput) -> Vec<Option<f64>> {
        let relative = RelativeDepth::new(image, output);
        (0..=image.width).map(|index| relative.at(index)).collect()
    }

    #[test]
    fn no_number_and_zero_and_below_are_no_depth() {
        let given = image(&[2.0, 0.0, -1.0, f32::NAN, f32::INFINITY, 1e-9]);
        let expected = [Some(2.0), None, None, None, None, Some(f64::from(1e-9_f32)), None];
        assert_eq!(all(&given, DepthOutput::Depth), expected);
        assert_eq!(all(&given, DepthOutput::Metric), expected);
    }

    #[test]
    fn disparity_is_turned_over_and_the_sky_has_none() {
        let given = image(&[500.0, 0.5, 0.501, f32::INFINITY, f32::NAN, -900.0]);
        let expected = [Some(1.0 / 500.0), None, Some(1.0 / f64::from(0.501_f32)), None, None, None, None];
        assert_eq!(all(&given, DepthOutput::Disparity), expected);
        assert_eq!(all(&image(&[0.0, f32::NAN]), DepthOutput::Disparity), [None; 3]);
    }
}
