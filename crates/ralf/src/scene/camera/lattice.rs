//! The depth of a view where it was calibrated: everywhere the camera looks, the ground and what is far away too.

use crate::sensors::StraightView;

/// The calibrated depths of the pixels `(floor(s/2) + a s, floor(s/2) + b s)` of a view, row by row.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DepthLattice {
    /// `s`: pixels from one to the next, at least 1.
    stride: usize,
    columns: usize,
    rows: usize,
    /// `Z`, m; 0 where there is no depth.
    depths: Vec<f32>,
}

impl DepthLattice {
    /// A lattice over a view, so far without any depth.
    pub(super) fn new(view: &StraightView, stride: usize) -> Self {
        let count = |size: usize| (stride / 2..size).step_by(stride).count();
        let (columns, rows) = (count(view.width), count(view.height));
        Self { stride, columns, rows, depths: vec![0.0; columns * rows] }
    }

    /// All pixels, row by row.
    pub(super) fn pixels(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let Self { stride, columns, rows, .. } = *self;
        let at = move |place: usize| stride / 2 + place * stride;
        (0..rows).flat_map(move |row| (0..columns).map(move |column| [at(column), at(row)]))
    }

    /// Sets the depth of a pixel of the lattice, m.
    pub(super) fn set(&mut self, [column, row]: [usize; 2], depth: f64) {
        self.depths[row / self.stride * self.columns + column / self.stride] = depth as f32;
    }

    /// The pixels that have a depth, m, row by row.
    pub(super) fn known(&self) -> impl Iterator<Item = ([f64; 2], f64)> {
        let all = self.pixels().zip(&self.depths).filter(|(_, depth)| **depth > 0.0);
        all.map(|([column, row], depth)| ([column as f64, row as f64], f64::from(*depth)))
    }

    /// Pixels from one of the lattice to the next.
    pub fn stride(&self) -> usize {
        self.stride
    }

    /// The depths, m, of the lattice's pixels at most `half_width` columns and `half_height` rows, px, from a place in
    /// the view; those without depth are left out.
    pub fn around(&self, [u, v]: [f64; 2], [half_width, half_height]: [f64; 2]) -> impl Iterator<Item = f64> {
        let columns = self.places(u - half_width, u + half_width, self.columns);
        let rows = self.places(v - half_height, v + half_height, self.rows);
        let of_row = move |row: usize| &self.depths[row * self.columns..][columns.clone()];
        rows.flat_map(of_row).filter(|depth| **depth > 0.0).map(|depth| f64::from(*depth))
    }

    /// The lattice's columns or rows from one pixel to another.
    fn places(&self, first: f64, last: f64, count: usize) -> std::ops::Range<usize> {
        let (half, stride) = ((self.stride / 2) as f64, self.stride.max(1) as f64);
        // Casts hold at 0.
        let begin = (((first - half) / stride).ceil().max(0.0) as usize).min(count);
        let end = (((last - half) / stride).floor() + 1.0).max(0.0) as usize;
        begin..end.clamp(begin, count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::View;
    use proptest::prelude::*;

    fn lattice(stride: usize) -> DepthLattice {
        let view = View { yaw: 0.0, pitch: 0.0, horizontal_fov: 1.0, width: 30, height: 22 };
        let mut lattice = DepthLattice::new(&StraightView::from(&view), stride);
        let pixels: Vec<[usize; 2]> = lattice.pixels().collect();
        // Each depth names its pixel; one in seven has none.
        for [column, row] in pixels {
            let depth = if (column + row) % 7 == 0 { 0.0 } else { (100 * row + column) as f64 };
            lattice.set([column, row], depth);
        }
        lattice
    }

    proptest! {
        #[test]
        fn those_around_a_place_are_what_looking_at_all_gives(
            stride in 1usize..9, u in -9.0..40.0, v in -9.0..30.0, width in 0.0..12.0, height in 0.0..12.0,
        ) {
            let lattice = lattice(stride);
            let found: Vec<f64> = lattice.around([u, v], [width, height]).collect();
            let mut expected = Vec::new();
            for [column, row] in lattice.pixels() {
                let inside = (column as f64 - u).abs() <= width && (row as f64 - v).abs() <= height;
                if inside && (column + row) % 7 != 0 {
                    expected.push((100 * row + column) as f64);
                }
            }
            prop_assert_eq!(found, expected);
        }
    }

    #[test]
    fn nothing_is_around_what_is_no_number() {
        assert_eq!(lattice(4).around([f64::NAN, 3.0], [50.0, 50.0]).count(), 0);
        assert_eq!(DepthLattice::default().around([0.0, 0.0], [9.0, 9.0]).count(), 0);
    }
}
