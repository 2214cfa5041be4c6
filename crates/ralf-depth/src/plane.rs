//! One channel of an image, resized with the triangle filter.

use std::ops::Range;

/// Values row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plane {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) values: Vec<f32>,
}

impl Plane {
    /// Rows from the top; there are none in a plane without columns.
    pub(crate) fn rows(&self) -> std::slice::ChunksExact<'_, f32> {
        self.values.chunks_exact(self.width.max(1))
    }

    /// Left and right exchanged.
    pub(crate) fn mirrored(&self) -> Self {
        let values = self.rows().flat_map(|row| row.iter().rev().copied()).collect();
        Self { values, ..*self }
    }

    /// A part of it.
    pub(crate) fn cut(&self, columns: Range<usize>, rows: Range<usize>) -> Self {
        let (width, height) = (columns.len(), rows.len());
        let kept = self.rows().skip(rows.start).take(height);
        Self { width, height, values: kept.flat_map(|row| &row[columns.clone()]).copied().collect() }
    }

    /// Bilinear where it grows; where it shrinks the triangle widens to the pixels that fall into one (as in Pillow),
    /// so that fine patterns don't alias. Pixel areas, not centres, map onto each other: edges stay at edges.
    pub(crate) fn resized(&self, width: usize, height: usize) -> Self {
        self.resized_across(width).resized_down(height)
    }

    /// The nearest pixel's value, for numbers that have no mean.
    pub(crate) fn nearest(&self, width: usize, height: usize) -> Self {
        let from = |place: usize, own: usize, other: usize| (2 * place + 1) * own / (2 * other);
        let row = |row: usize| &self.values[from(row, self.height, height) * self.width..][..self.width];
        let values = (0..height)
            .flat_map(|place| (0..width).map(move |column| row(place)[from(column, self.width, width)]));
        Self { width, height, values: values.collect() }
    }

    fn resized_across(&self, width: usize) -> Self {
        if width == self.width {
            return self.clone();
        }
        let taps = taps(self.width, width);
        let sample = |row: &[f32], tap: &Tap| -> f32 {
            let from = &row[tap.first..tap.first + tap.weights.len()];
            from.iter().zip(&tap.weights).map(|(value, weight)| value * weight).sum()
        };
        let values = self.rows().flat_map(|row| taps.iter().map(move |tap| sample(row, tap))).collect();
        Self { width, height: self.height, values }
    }

    fn resized_down(self, height: usize) -> Self {
        if height == self.height {
            return self;
        }
        let mut values = vec![0.0; self.width * height];
        for (row, tap) in values.chunks_exact_mut(self.width.max(1)).zip(taps(self.height, height)) {
            for (from, weight) in self.rows().skip(tap.first).zip(&tap.weights) {
                row.iter_mut().zip(from).for_each(|(sum, value)| *sum += weight * value);
            }
        }
        Self { width: self.width, height, values }
    }
}

/// Neighbouring source pixels that make up a target pixel. Weights sum to 1.
struct Tap {
    first: usize,
    weights: Vec<f32>,
}

fn taps(from: usize, to: usize) -> Vec<Tap> {
    let scale = from as f64 / to as f64;
    let support = scale.max(1.0);
    let tap = |target: usize| {
        let center = (target as f64 + 0.5) * scale;
        let first = (center - support + 0.5).floor().max(0.0) as usize;
        let end = ((center + support + 0.5).floor() as usize).min(from);
        let weight = |source: usize| (1.0 - (source as f64 + 0.5 - center).abs() / support).max(0.0);
        let sum: f64 = (first..end).map(weight).sum();
        Tap { first, weights: (first..end).map(|source| (weight(source) / sum) as f32).collect() }
    };
    (0..to).map(tap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(values: &[f32]) -> Plane {
        Plane { width: values.len(), height: 1, values: values.to_vec() }
    }

    fn close(found: &[f32], expected: &[f32]) {
        assert_eq!(found.len(), expected.len());
        for (f, e) in found.iter().zip(expected) {
            assert!((f - e).abs() < 1e-5, "found {found:?}, expected {expected:?}");
        }
    }

    #[test]
    fn growing_is_bilinear_between_pixel_centres_and_held_at_the_edges() {
        close(&row(&[0.0, 4.0]).resized(4, 1).values, &[0.0, 1.0, 3.0, 4.0]);
        let square = Plane { width: 2, height: 2, values: vec![0.0, 4.0, 8.0, 12.0] };
        let first_column = square.resized(4, 4).cut(0..1, 0..4);
        close(&first_column.values, &[0.0, 2.0, 6.0, 8.0]);
    }

    #[test]
    fn shrinking_weighs_all_pixels_under_the_triangle() {
        // Halved: weights 1/4, 3/4, 3/4, 1/4 around each new centre, the outer ones cut off and the rest made 1 again.
        let expected =
            [(0.75 * 1.0 + 0.75 * 2.0 + 0.25 * 10.0) / 1.75, (0.25 * 2.0 + 0.75 * 10.0 + 0.75 * 20.0) / 1.75];
        close(&row(&[1.0, 2.0, 10.0, 20.0]).resized(2, 1).values, &expected);
        // A pattern of single pixels becomes its mean, where plain bilinear sampling would pick one phase.
        let stripes: Vec<f32> = (0..64).map(|i| (i % 2) as f32).collect();
        let shrunk = row(&stripes).resized(8, 1);
        assert!(shrunk.values[1..7].iter().all(|v| (v - 0.5).abs() < 0.01), "{shrunk:?}");
    }

    #[test]
    fn a_constant_stays_and_a_ramp_stays_straight_whatever_the_sizes() {
        for (from, to) in [(7, 3), (3, 7), (48, 900), (900, 48), (1, 5), (5, 1), (6, 6)] {
            let flat = Plane { width: from, height: 2, values: vec![2.5; from * 2] };
            close(&flat.resized(to, 3).values, &vec![2.5; to * 3]);
            let ramp: Vec<f32> = (0..from).map(|i| (i as f32 + 0.5) / from as f32).collect();
            let resized = row(&ramp).resized(to, 1);
            let margin = (to / from + 1).max(1);
            for i in margin..to.saturating_sub(margin) {
                assert!(
                    (resized.values[i] - (i as f32 + 0.5) / to as f32).abs() < 1e-5,
                    "{from} -> {to} at {i}"
                );
            }
        }
    }

    #[test]
    fn the_nearest_pixel_keeps_its_value() {
        let plane = Plane { width: 3, height: 2, values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        assert_eq!(plane.nearest(6, 2).values[..6], [1.0, 1.0, 2.0, 2.0, 3.0, 3.0]);
        assert_eq!(plane.nearest(1, 1).values, [5.0]);
        assert_eq!(plane.nearest(3, 2), plane);
    }

    #[test]
    fn parts_and_mirrors() {
        let plane = Plane { width: 3, height: 2, values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        assert_eq!(plane.mirrored().values, [3.0, 2.0, 1.0, 6.0, 5.0, 4.0]);
        assert_eq!(plane.cut(1..3, 1..2), Plane { width: 2, height: 1, values: vec![5.0, 6.0] });
        assert_eq!(plane.resized(7, 5).mirrored().values.len(), 35);
    }
}
