//! How green an image is, and where: grass and bushes against roads and walls.

use super::scaling::median;
use crate::sensors::CameraImage;

/// One in so many columns and rows of an image is looked at.
const STEP: usize = 8;

/// The excess green of an image, `(2 G - R - B) / (R + G + B)`, on a lattice of pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Greenness {
    columns: usize,
    rows: usize,
    values: Vec<f32>,
    median: f64,
}

impl Greenness {
    /// How green an image is; `None` of an empty one.
    pub fn new(image: &CameraImage) -> Option<Self> {
        let every = |size: usize| (STEP / 2..size).step_by(STEP);
        let mut values = Vec::with_capacity(every(image.width).count() * every(image.height).count());
        for row in every(image.height) {
            let pixels = image.rgb.get(row * image.width..(row + 1) * image.width)?;
            values.extend(pixels.iter().skip(STEP / 2).step_by(STEP).map(excess_green));
        }
        let median = median(values.iter().copied().map(f64::from).collect())?;
        Some(Self { columns: every(image.width).count(), rows: every(image.height).count(), values, median })
    }

    /// How much greener the image is around a pixel than in its median: the mean of nine pixels of the lattice. `None`
    /// outside the image.
    pub fn over_median(&self, [u, v]: [f64; 2]) -> Option<f64> {
        let place = |value: f64, count: usize| {
            let nearest = (value - (STEP / 2) as f64) / STEP as f64;
            (nearest >= -0.5 && nearest < count as f64 - 0.5).then(|| nearest.round().max(0.0) as usize)
        };
        let (column, row) = (place(u, self.columns)?, place(v, self.rows)?);
        let (mut sum, mut count) = (0.0, 0);
        for row in row.saturating_sub(1)..(row + 2).min(self.rows) {
            for column in column.saturating_sub(1)..(column + 2).min(self.columns) {
                sum += f64::from(self.values[row * self.columns + column]);
                count += 1;
            }
        }
        Some(sum / f64::from(count) - self.median)
    }
}

/// In [-1, 2]; 0 of grey and of black.
fn excess_green(pixel: &[u8; 3]) -> f32 {
    let [red, green, blue] = pixel.map(f32::from);
    (2.0 * green - red - blue) / (red + green + blue).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn green_against_grey_by_hand() {
        // 40 by 16 px: lattice columns at 4, 12, 20, 28, 36 and rows at 4 and 12. Grey but for green from column 24 on.
        let pixel = |i: usize| if i % 40 >= 24 { [50, 100, 50] } else { [80; 3] };
        let image = CameraImage { width: 40, height: 16, rgb: (0..40 * 16).map(pixel).collect() };
        let greenness = Greenness::new(&image).unwrap();
        // Six grey, four green ones: the median is grey. Excess green is 100 / 200.
        assert_eq!(greenness.over_median([4.0, 4.0]), Some(0.0));
        assert_eq!(greenness.over_median([36.0, 12.0]), Some(0.5));
        assert!((greenness.over_median([21.0, 4.0]).unwrap() - 0.5 / 3.0).abs() < 1e-7);
        assert!(greenness.over_median([0.0, 0.0]).is_some() && greenness.over_median([39.9, 15.9]).is_some());
        for outside in [[-0.1, 4.0], [40.0, 4.0], [4.0, 16.0], [f64::NAN, 4.0]] {
            assert_eq!(greenness.over_median(outside), None, "{outside:?}");
        }
    }

    #[test]
    fn an_image_without_pixels_or_cut_short_has_none() {
        assert_eq!(Greenness::new(&CameraImage { width: 0, height: 0, rgb: vec![] }), None);
        assert_eq!(Greenness::new(&CameraImage { width: 40, height: 16, rgb: vec![[1; 3]; 100] }), None);
    }
}
