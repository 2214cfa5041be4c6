//! The depth of a view through a network.

use crate::colour::Colour;
use crate::fit::Framed;
use crate::network::depth_size;
use crate::plane::Plane;
use crate::runner::{Runner, whole};
use crate::squares;
use crate::{Card, Fit, NetworkError};
use ralf::sensors::DepthOutput;

/// A depth network with its card.
#[derive(Clone, Copy)]
pub(crate) struct DepthRunner<'a> {
    pub(crate) runner: Runner<'a>,
    pub(crate) card: &'a Card,
}

impl DepthRunner<'_> {
    /// The depth of a view, in the view's size.
    pub(crate) fn depth(&self, view: &Colour) -> Result<Plane, NetworkError> {
        if self.card.feed.fit == Fit::Squares {
            return self.in_squares(view);
        }
        let (framed, image) = Framed::new(&self.card.feed, view);
        Ok(framed.back(self.run(&image)?, Plane::resized))
    }

    fn in_squares(&self, view: &Colour) -> Result<Plane, NetworkError> {
        let [width, height] = view.size();
        let input = self.card.feed.input.of_view(width, height);
        if width < height {
            let expected = "at least as wide as high, for fit = \"squares\"".to_owned();
            return Err(NetworkError::View { expected, found: format!("{width} x {height} px") });
        }
        let estimated = squares::places(width, height).into_iter().map(|left| {
            let square = view.columns(left..left + height).resized(input[0], input[1]);
            Ok((left, self.run(&square)?.resized(height, height)))
        });
        let estimated: Vec<_> = estimated.collect::<Result<_, NetworkError>>()?;
        let scales = match self.card.output {
            DepthOutput::Metric => vec![1.0; estimated.len()],
            DepthOutput::Depth | DepthOutput::Disparity => squares::scales(&estimated)?,
        };
        Ok(squares::blended(width, &estimated, &scales))
    }

    /// The network's depth for an image of its input's size, in a size of the network's own; averaged with the mirror
    /// image's where the card says so.
    fn run(&self, image: &Colour) -> Result<Plane, NetworkError> {
        let mut depth = self.run_once(image)?;
        if self.card.flip {
            let mirrored = self.run_once(&image.mirrored())?.mirrored();
            for (value, other) in depth.values.iter_mut().zip(mirrored.values) {
                *value = 0.5 * (*value + other);
            }
        }
        Ok(depth)
    }

    /// The output as an image, refused unless it has the input's proportions and is finite everywhere.
    fn run_once(&self, image: &Colour) -> Result<Plane, NetworkError> {
        let (input, output) = (image.size(), self.runner.run(image)?);
        let shape: Vec<_> = output.shape.iter().copied().map(Some).collect();
        let Some([width, height]) = whole(depth_size(&shape), input) else {
            let expected = format!("[1, 1, {}, {}] or the same smaller", input[1], input[0]);
            return Err(self.runner.wrong(&expected, format!("{:?}", output.shape)));
        };
        self.runner.finite(&output.values, width)?;
        Ok(Plane { width, height, values: output.values })
    }
}

/// How many pixels of the network one pixel of the view becomes, where both sides scale alike.
pub(crate) fn zoom(card: &Card, view: [usize; 2]) -> f64 {
    let [width, height] = card.feed.input.of_view(view[0], view[1]);
    let [across, down] = [width as f64 / view[0] as f64, height as f64 / view[1] as f64];
    match card.feed.fit {
        Fit::Pad(_) => across.min(down),
        Fit::Squares | Fit::Stretch => down,
    }
}
