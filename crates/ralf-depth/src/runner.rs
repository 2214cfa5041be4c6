//! One image of the network's size through the network.

use crate::colour::Colour;
use crate::network::{Network, Tensor, depth_size};
use crate::plane::Plane;
use crate::{Card, Channels, DepthError};
use std::path::Path;

/// A network that goes with its card.
#[derive(Clone, Copy)]
pub(crate) struct Runner<'a> {
    /// For errors.
    pub(crate) file: &'a Path,
    pub(crate) card: &'a Card,
    pub(crate) network: &'a dyn Network,
    /// Index of the depth among the network's outputs.
    pub(crate) output: usize,
}

impl Runner<'_> {
    /// The network's depth for an image of its input's size, in a size of the network's own; averaged with the mirror
    /// image's where the card says so.
    pub(crate) fn run(&self, image: &Colour) -> Result<Plane, DepthError> {
        let mut depth = self.run_once(image)?;
        if self.card.flip {
            let mirrored = self.run_once(&image.mirrored())?.mirrored();
            for (value, other) in depth.values.iter_mut().zip(mirrored.values) {
                *value = 0.5 * (*value + other);
            }
        }
        Ok(depth)
    }

    fn run_once(&self, image: &Colour) -> Result<Plane, DepthError> {
        let [width, height] = image.size();
        let input = Tensor { shape: vec![1, 3, height, width], values: self.normalised(image) };
        let output = self.network.run(input, self.output).map_err(|reason| DepthError::Failed {
            file: self.file.to_owned(),
            runtime: self.network.runtime(),
            reason,
        })?;
        self.checked(output, [width, height])
    }

    /// Channel by channel in the network's order, row by row.
    fn normalised(&self, image: &Colour) -> Vec<f32> {
        let Card { channels, divide_by, mean, std, .. } = self.card;
        let order = match channels {
            Channels::Rgb => [0, 1, 2],
            Channels::Bgr => [2, 1, 0],
        };
        let planes = order.iter().map(|channel| &image.0[*channel]).zip(mean.iter().zip(std));
        let values = planes.flat_map(|(plane, (mean, std))| {
            plane.values.iter().map(move |value| (value / divide_by - mean) / std)
        });
        values.collect()
    }

    /// The output as an image, refused unless it has the input's proportions and is finite everywhere.
    fn checked(&self, output: Tensor, input: [usize; 2]) -> Result<Plane, DepthError> {
        let wrong = |expected: &str, found: String| {
            let port = self.network.outputs().swap_remove(self.output);
            DepthError::content(self.file, format!("output `{}`", port.name), expected, found)
        };
        let shape: Vec<_> = output.shape.iter().copied().map(Some).collect();
        let [width, height] = match depth_size(&shape) {
            // Networks may answer in a fraction of the input's resolution, but of all of it.
            Some([Some(height), Some(width)]) if width > 0 && width * input[1] == height * input[0] => {
                [width, height]
            }
            _ => {
                let expected = format!("[1, 1, {}, {}] or the same smaller", input[1], input[0]);
                return Err(wrong(&expected, format!("{:?}", output.shape)));
            }
        };
        if let Some(index) = output.values.iter().position(|value| !value.is_finite()) {
            let found =
                format!("{} in row {}, column {}", output.values[index], index / width, index % width);
            return Err(wrong("finite values", found));
        }
        Ok(Plane { width, height, values: output.values })
    }
}
