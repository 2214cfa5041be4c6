//! From metres to pixels: x points up and y to the left.

use crate::extent::Window;

/// Where a part of the ground lies in a picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Viewport {
    /// x and y (m) in the middle of the picture.
    centre: [f64; 2],
    /// Columns and rows, pixels.
    size: [u32; 2],
    /// Pixels per metre.
    scale: f64,
}

impl Viewport {
    /// The largest view of a window that shows all of it in `size` pixels, to the same scale in both directions.
    pub(crate) fn showing(window: &Window, size: [u32; 2]) -> Self {
        let [columns, rows] = size.map(f64::from);
        let scale = (rows / window.half[0]).min(columns / window.half[1]) / 2.0;
        Self { centre: window.centre, size, scale }
    }

    /// Pixels per metre.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Columns and rows, pixels.
    pub(crate) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The column and row of a place (x, y in m). Pixel (0, 0) covers 0..1 in both.
    pub(crate) fn pixel_from_world(&self, [x, y]: [f64; 2]) -> [f32; 2] {
        let [columns, rows] = self.size.map(f64::from);
        let column = columns / 2.0 - (y - self.centre[1]) * self.scale;
        let row = rows / 2.0 - (x - self.centre[0]) * self.scale;
        [column as f32, row as f32]
    }

    /// The place (x, y in m) of a column and row.
    pub(crate) fn world_from_pixel(&self, [column, row]: [f32; 2]) -> [f64; 2] {
        let [columns, rows] = self.size.map(f64::from);
        let x = self.centre[0] + (rows / 2.0 - f64::from(row)) / self.scale;
        let y = self.centre[1] + (columns / 2.0 - f64::from(column)) / self.scale;
        [x, y]
    }

    /// Whether a pixel lies in the picture, at least `margin` away from its edges.
    pub(crate) fn contains(&self, [column, row]: [f32; 2], margin: f32) -> bool {
        let [columns, rows] = self.size.map(|pixels| pixels as f32);
        let within = |value: f32, size: f32| value >= margin && value <= size - margin;
        within(column, columns) && within(row, rows)
    }

    /// The smallest and the largest x and y that are shown, m.
    pub(crate) fn limits(&self) -> [[f64; 2]; 2] {
        let [columns, rows] = self.size.map(|pixels| pixels as f32);
        let [high_x, high_y] = self.world_from_pixel([0.0, 0.0]);
        let [low_x, low_y] = self.world_from_pixel([columns, rows]);
        [[low_x, high_x], [low_y, high_y]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn view(centre: [f64; 2]) -> Viewport {
        Viewport::showing(&Window { centre, half: [50.0, 25.0] }, [400, 600])
    }

    #[test]
    fn forward_is_up_and_left_is_left() {
        let view = view([0.0, 0.0]);
        assert_eq!(view.scale(), 6.0);
        assert_eq!(view.pixel_from_world([0.0, 0.0]), [200.0, 300.0]);
        assert_eq!(view.pixel_from_world([10.0, 0.0]), [200.0, 240.0]);
        assert_eq!(view.pixel_from_world([0.0, 10.0]), [140.0, 300.0]);
        let [[low_x, high_x], [low_y, high_y]] = view.limits();
        assert_eq!([low_x, high_x], [-50.0, 50.0]);
        assert!((low_y + high_y).abs() < 1e-9 && (high_y - 200.0 / 6.0).abs() < 1e-9);
    }

    proptest! {
        #[test]
        fn world_to_pixel_and_back(
            cx in -1e6..1e6f64, cy in -1e6..1e6f64, dx in -50.0..50.0f64, dy in -25.0..25.0f64,
        ) {
            let view = view([cx, cy]);
            let pixel = view.pixel_from_world([cx + dx, cy + dy]);
            prop_assert!(view.contains(pixel, -1e-3));
            let back = view.world_from_pixel(pixel);
            prop_assert!((back[0] - cx - dx).abs() < 1e-4 && (back[1] - cy - dy).abs() < 1e-4);
        }
    }
}
