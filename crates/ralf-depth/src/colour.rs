//! A colour image on its way into a network.

use crate::NetworkError;
use crate::plane::Plane;
use ralf::sensors::CameraImage;
use std::array::from_fn;
use std::ops::Range;

/// Red, green and blue planes, 0 to 255. All have the same size.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Colour(pub(crate) [Plane; 3]);

impl Colour {
    /// The pixels of a view.
    pub(crate) fn from_view(view: &CameraImage) -> Result<Self, NetworkError> {
        let CameraImage { width, height, rgb } = view;
        if rgb.is_empty() || Some(rgb.len()) != width.checked_mul(*height) {
            let found = format!("{} pixels in {width} x {height}", rgb.len());
            return Err(NetworkError::View { expected: "width x height pixels".to_owned(), found });
        }
        let plane = |channel: usize| rgb.iter().map(|pixel| f32::from(pixel[channel])).collect();
        Ok(Self(from_fn(|channel| Plane { width: *width, height: *height, values: plane(channel) })))
    }

    /// Width and height, px.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.0[0].width, self.0[0].height]
    }

    /// See [`Plane::resized`].
    pub(crate) fn resized(&self, width: usize, height: usize) -> Self {
        Self(self.0.each_ref().map(|plane| plane.resized(width, height)))
    }

    /// Left and right exchanged.
    pub(crate) fn mirrored(&self) -> Self {
        Self(self.0.each_ref().map(Plane::mirrored))
    }

    /// Full-height part.
    pub(crate) fn columns(&self, columns: Range<usize>) -> Self {
        Self(self.0.each_ref().map(|plane| plane.cut(columns.clone(), 0..plane.height)))
    }

    /// In the middle of a larger image of one colour, and where it begins there.
    pub(crate) fn padded(&self, width: usize, height: usize, colour: [f32; 3]) -> (Self, [usize; 2]) {
        let [own_width, own_height] = self.size();
        let [left, top] = [(width - own_width) / 2, (height - own_height) / 2];
        let padded = from_fn(|channel| {
            let mut values = vec![colour[channel]; width * height];
            let rows = values.chunks_exact_mut(width).skip(top);
            for (row, own) in rows.zip(self.0[channel].rows()) {
                row[left..left + own_width].copy_from_slice(own);
            }
            Plane { width, height, values }
        });
        (Self(padded), [left, top])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_without_its_pixels_is_refused() {
        for (width, height, pixels) in [(0, 0, 0), (2, 2, 3), (usize::MAX, 2, 4), (0, 5, 0)] {
            let error =
                Colour::from_view(&CameraImage { width, height, rgb: vec![[0; 3]; pixels] }).unwrap_err();
            assert!(error.to_string().contains(&format!("{pixels} pixels in {width} x {height}")), "{error}");
        }
    }

    #[test]
    fn padding_is_even_and_of_the_given_colour() {
        let view = CameraImage { width: 2, height: 1, rgb: vec![[1, 2, 3], [4, 5, 6]] };
        let (padded, place) = Colour::from_view(&view).unwrap().padded(3, 4, [7.0, 8.0, 9.0]);
        assert_eq!((padded.size(), place), ([3, 4], [0, 1]));
        assert_eq!(padded.0[1].values, [8.0, 8.0, 8.0, 2.0, 5.0, 8.0, 8.0, 8.0, 8.0, 8.0, 8.0, 8.0]);
    }
}
