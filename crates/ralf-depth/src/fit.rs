//! Views of any proportions through networks of few: see [`Fit`].

use crate::colour::Colour;
use crate::plane::Plane;
use crate::runner::Runner;
use crate::squares;
use crate::{Card, DepthError, Fit};
use ralf::sensors::DepthOutput;

/// The depth of a view, in the view's size.
pub(crate) fn depth(runner: &Runner<'_>, view: &Colour) -> Result<Plane, DepthError> {
    let [width, height] = view.size();
    let input = runner.card.input.of_view(width, height);
    match runner.card.fit {
        Fit::Stretch => {
            let depth = runner.run(&view.resized(input[0], input[1]))?;
            Ok(depth.resized(width, height))
        }
        Fit::Squares => in_squares(runner, view, input),
        Fit::Pad(colour) => {
            let [inner_width, inner_height] = inner_size([width, height], input);
            let inner = view.resized(inner_width, inner_height);
            let (padded, [left, top]) = inner.padded(input[0], input[1], colour);
            let depth = runner.run(&padded)?.resized(input[0], input[1]);
            let kept = depth.cut(left..left + inner_width, top..top + inner_height);
            Ok(kept.resized(width, height))
        }
    }
}

/// How many pixels of the network one pixel of the view becomes, where both sides scale alike.
pub(crate) fn zoom(card: &Card, view: [usize; 2]) -> f64 {
    let [width, height] = card.input.of_view(view[0], view[1]);
    let [across, down] = [width as f64 / view[0] as f64, height as f64 / view[1] as f64];
    match card.fit {
        Fit::Pad(_) => across.min(down),
        Fit::Squares | Fit::Stretch => down,
    }
}

fn in_squares(runner: &Runner<'_>, view: &Colour, input: [usize; 2]) -> Result<Plane, DepthError> {
    let [width, height] = view.size();
    if width < height {
        let expected = "at least as wide as high, for fit = \"squares\"".to_owned();
        return Err(DepthError::View { expected, found: format!("{width} x {height} px") });
    }
    let estimated = squares::places(width, height).into_iter().map(|left| {
        let square = view.columns(left..left + height).resized(input[0], input[1]);
        Ok((left, runner.run(&square)?.resized(height, height)))
    });
    let estimated: Vec<_> = estimated.collect::<Result<_, DepthError>>()?;
    let scales = match runner.card.output {
        DepthOutput::Metric => vec![1.0; estimated.len()],
        DepthOutput::Depth | DepthOutput::Disparity => squares::scales(&estimated)?,
    };
    Ok(squares::blended(width, &estimated, &scales))
}

/// The largest size in the view's proportions that fits into the network's.
fn inner_size(view: [usize; 2], input: [usize; 2]) -> [usize; 2] {
    let scale = (input[0] as f64 / view[0] as f64).min(input[1] as f64 / view[1] as f64);
    // Up by a hair, that the side that decides isn't rounded below its own size.
    let scaled = |length: usize, limit: usize| ((length as f64 * scale + 1e-6) as usize).clamp(1, limit);
    [scaled(view[0], input[0]), scaled(view[1], input[1])]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_padded_view_keeps_its_proportions() {
        for (view, input, expected) in [
            ([1600, 900], [1064, 616], [1064, 598]),
            ([900, 1600], [1064, 616], [346, 616]),
            ([49, 7], [7, 7], [7, 1]),
            ([1000, 1], [8, 8], [8, 1]),
        ] {
            assert_eq!(inner_size(view, input), expected);
        }
    }
}
