//! Whole views of any proportions through networks of few, and back: see [`Fit`].

use crate::colour::Colour;
use crate::plane::Plane;
use crate::{Feed, Fit};

/// Where a whole view lies in an image of the network's size.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Framed {
    /// Size of the view, px.
    view: [usize; 2],
    /// Size of the network's input, px.
    input: [usize; 2],
    /// Where the view begins in it, and its size there; `None` where it fills it.
    inner: Option<([usize; 2], [usize; 2])>,
}

/// Brings a plane to a width and a height.
pub(crate) type Resize = fn(&Plane, usize, usize) -> Plane;

impl Framed {
    /// The image of a view that a network is fed.
    pub(crate) fn new(feed: &Feed, view: &Colour) -> (Self, Colour) {
        let [width, height] = view.size();
        let input = feed.input.of_view(width, height);
        let framed = Self { view: [width, height], input, inner: None };
        match feed.fit {
            Fit::Pad(colour) => {
                let size = inner_size([width, height], input);
                let (padded, place) = view.resized(size[0], size[1]).padded(input[0], input[1], colour);
                (Self { inner: Some((place, size)), ..framed }, padded)
            }
            Fit::Stretch | Fit::Squares => (framed, view.resized(input[0], input[1])),
        }
    }

    /// What a network gave for that image, in the view's size.
    pub(crate) fn back(&self, plane: Plane, resize: Resize) -> Plane {
        let [width, height] = self.view;
        let Some(([left, top], [inner_width, inner_height])) = self.inner else {
            return resize(&plane, width, height);
        };
        let whole = resize(&plane, self.input[0], self.input[1]);
        resize(&whole.cut(left..left + inner_width, top..top + inner_height), width, height)
    }
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
