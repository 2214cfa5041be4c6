//! One image of the network's size through the network.

use crate::colour::Colour;
use crate::network::{Network, Tensor};
use crate::{Channels, Feed, NetworkError};
use std::path::Path;

/// A network that goes with its card.
#[derive(Clone, Copy)]
pub(crate) struct Runner<'a> {
    /// For errors.
    pub(crate) file: &'a Path,
    pub(crate) feed: &'a Feed,
    pub(crate) network: &'a dyn Network,
    /// Index of what is wanted among the network's outputs.
    pub(crate) output: usize,
}

impl Runner<'_> {
    /// The network's output for an image of its input's size.
    pub(crate) fn run(&self, image: &Colour) -> Result<Tensor, NetworkError> {
        let [width, height] = image.size();
        let input = Tensor { shape: vec![1, 3, height, width], values: self.normalised(image) };
        self.network.run(input, self.output).map_err(|reason| NetworkError::Failed {
            file: self.file.to_owned(),
            runtime: self.network.runtime(),
            reason,
        })
    }

    /// An output that isn't what it should be.
    pub(crate) fn wrong(&self, expected: &str, found: impl Into<String>) -> NetworkError {
        let port = self.network.outputs().swap_remove(self.output);
        NetworkError::content(self.file, format!("output `{}`", port.name), expected, found)
    }

    /// Refuses values that aren't finite; rows are `width` long.
    pub(crate) fn finite(&self, values: &[f32], width: usize) -> Result<(), NetworkError> {
        let Some(index) = values.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let found = format!("{} in row {}, column {}", values[index], index / width, index % width);
        Err(self.wrong("finite values", found))
    }

    /// Channel by channel in the network's order, row by row.
    fn normalised(&self, image: &Colour) -> Vec<f32> {
        let Feed { channels, divide_by, mean, std, .. } = self.feed;
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
}

/// Width and height of an output for an input of a size, where it has all of it: networks may answer in a fraction of
/// the input's resolution.
pub(crate) fn whole(size: Option<[Option<usize>; 2]>, input: [usize; 2]) -> Option<[usize; 2]> {
    match size {
        Some([Some(height), Some(width)]) if width > 0 && width * input[1] == height * input[0] => {
            Some([width, height])
        }
        _ => None,
    }
}
