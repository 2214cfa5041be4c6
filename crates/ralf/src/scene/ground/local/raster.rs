//! Square rasters of numbers, and what is done to them cell by cell.

/// A number per cell of a square, row by row.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Raster {
    /// Cells along an edge.
    size: usize,
    pub(super) values: Vec<f32>,
}

impl Raster {
    pub(super) fn filled(size: usize, value: f32) -> Self {
        Self { size, values: vec![value; size * size] }
    }

    /// Of the known cells each clipped to `slack` above the median of the known ones within `radius`, itself among
    /// them, and to the median itself where it is lower by more than the slack; the others as they are.
    pub(super) fn clipped_to_median(&self, known: &[usize], radius: usize, slack: f32) -> Self {
        let mut clipped = self.clone();
        let mut around: Vec<f32> = Vec::new();
        for &cell in known {
            let (row, column) = (cell / self.size, cell % self.size);
            let value = self.values[cell];
            let columns = column.saturating_sub(radius)..(column + radius).min(self.size - 1) + 1;
            let rows = row.saturating_sub(radius)..(row + radius).min(self.size - 1) + 1;
            let row_of = |row: usize| &self.values[row * self.size..][columns.clone()];
            // No median of values that are all near is far. What is not known is infinite.
            let far = |other: &&f32| (**other - value).abs() > slack && other.is_finite();
            if rows.clone().all(|row| row_of(row).iter().filter(far).count() == 0) {
                continue;
            }
            around.clear();
            for row in rows {
                around.extend(row_of(row).iter().filter(|value| value.is_finite()));
            }
            let middle = around.len() / 2;
            let median = *around.select_nth_unstable_by(middle, f32::total_cmp).1;
            clipped.values[cell] = if value < median - slack { median } else { value.min(median + slack) };
        }
        clipped
    }

    /// Every cell with the value of the finite one nearest to it, and how far that is away, in cells. Ways lead from
    /// cell to cell, so that distances are up to 8 % too long.
    pub(super) fn filled_from_nearest(&self) -> (Self, Self) {
        let away = |value: &f32| if value.is_finite() { 0.0 } else { f32::INFINITY };
        let mut spread = Spread { values: self.values.clone(), away: self.values.iter().map(away).collect() };
        // There and back: backward is forward in a raster whose last cell is the first.
        for _ in 0..2 {
            spread.forward(self.size);
            spread.values.reverse();
            spread.away.reverse();
        }
        let raster = |values| Self { size: self.size, values };
        (raster(spread.values), raster(spread.away))
    }

    /// The least value within `radius` cells in row and column.
    pub(super) fn eroded(&self, radius: usize) -> Self {
        self.extreme(radius, |a, b| if b < a { b } else { a })
    }

    /// The largest value within `radius` cells in row and column.
    pub(super) fn dilated(&self, radius: usize) -> Self {
        self.extreme(radius, |a, b| if b > a { b } else { a })
    }

    /// The mean within `radius` cells in row and column; beyond the border its cells go on.
    pub(super) fn smoothed(&self, radius: usize) -> Self {
        let cells = (2 * radius + 1).pow(2) as f32;
        self.within(radius, |a, b| a + b).scaled(1.0 / cells)
    }

    pub(super) fn minus(&self, other: &Self) -> Self {
        let values = self.values.iter().zip(&other.values).map(|(a, b)| a - b).collect();
        Self { size: self.size, values }
    }

    pub(super) fn scaled(&self, factor: f32) -> Self {
        Self { size: self.size, values: self.values.iter().map(|value| value * factor).collect() }
    }

    /// The value at a place between cells' middles, linear in between and held at the border.
    pub(super) fn between(&self, column: f64, row: f64) -> f64 {
        let last = (self.size - 1) as f64;
        let [column, row] = [column, row].map(|place| place.clamp(0.0, last));
        let [left, low] = [column, row].map(|place| (place as usize).min(self.size - 2));
        let (right, up) = (column - left as f64, row - low as f64);
        let at = |row: usize, column: usize| f64::from(self.values[row * self.size + column]);
        let along = |row: usize| at(row, left) * (1.0 - right) + at(row, left + 1) * right;
        along(low) * (1.0 - up) + along(low + 1) * up
    }

    /// The same as [`Self::within`] with what may take a value twice: from pairs of cells, pairs of pairs and so on.
    fn extreme(&self, radius: usize, join: impl Fn(f32, f32) -> f32) -> Self {
        let (size, last, width) = (self.size, self.size - 1, 2 * radius + 1);
        let mut padded = Vec::with_capacity(size * (size + 2 * radius));
        for row in 0..size + 2 * radius {
            let row = row.saturating_sub(radius).min(last);
            padded.extend_from_slice(&self.values[row * size..][..size]);
        }
        let mut spare = Vec::with_capacity(padded.len());
        widen(&mut padded, &mut spare, width, size, &join);
        let mut joined = Self { size, values: padded };
        let mut padded = Vec::with_capacity(size + 2 * radius);
        for row in joined.values.chunks_mut(size) {
            padded.clear();
            padded.resize(radius, row[0]);
            padded.extend_from_slice(row);
            padded.resize(size + 2 * radius, row[last]);
            widen(&mut padded, &mut spare, width, 1, &join);
            row.copy_from_slice(&padded);
        }
        joined
    }

    /// All values within `radius` cells of each one taken together, first in its column and then in its row.
    fn within(&self, radius: usize, join: impl Fn(f32, f32) -> f32) -> Self {
        let (size, last) = (self.size, self.size - 1);
        let mut joined = self.clone();
        for row in 0..size {
            let target = &mut joined.values[row * size..][..size];
            for step in 1..=radius {
                for other in [row.saturating_sub(step), (row + step).min(last)] {
                    for (value, more) in target.iter_mut().zip(&self.values[other * size..][..size]) {
                        *value = join(*value, *more);
                    }
                }
            }
        }
        let mut padded = vec![0.0; size + 2 * radius];
        for row in joined.values.chunks_mut(size) {
            padded[..radius].fill(row[0]);
            padded[radius..radius + size].copy_from_slice(row);
            padded[radius + size..].fill(row[last]);
            row.copy_from_slice(&padded[..size]);
            for step in 1..=2 * radius {
                for (value, more) in row.iter_mut().zip(&padded[step..]) {
                    *value = join(*value, *more);
                }
            }
        }
        joined
    }
}

/// Takes each value together with those that follow it at a stride, as many as the width says, itself among them; those
/// that fewer follow fall away. `spare` is for use on the way.
fn widen(
    values: &mut Vec<f32>,
    spare: &mut Vec<f32>,
    width: usize,
    stride: usize,
    join: impl Fn(f32, f32) -> f32,
) {
    let mut joined = 1;
    while joined < width {
        let more = joined.min(width - joined);
        spare.clear();
        spare.extend(values.iter().zip(&values[more * stride..]).map(|(a, b)| join(*a, *b)));
        std::mem::swap(values, spare);
        joined += more;
    }
}

/// Values on their way from known cells to the others.
struct Spread {
    values: Vec<f32>,
    away: Vec<f32>,
}

impl Spread {
    /// Every cell takes the value of the one before it or of the three above it that is nearest to a known cell, if
    /// that is nearer than its own; of equally near ones the first. What the row above offers is told for all cells of
    /// a row at once.
    fn forward(&mut self, size: usize) {
        let mut above = Above::nothing(size);
        let rows = self.values.chunks_exact_mut(size).zip(self.away.chunks_exact_mut(size));
        for (values, aways) in rows {
            above.offer();
            let mut before = (f32::INFINITY, f32::INFINITY);
            let offers = above.offered.values.iter().zip(&above.offered.away);
            for ((value, away), offer) in values.iter_mut().zip(aways.iter_mut()).zip(offers) {
                let mut nearest = (*value, *away);
                if before.1 + 1.0 < nearest.1 {
                    nearest = (before.0, before.1 + 1.0);
                }
                if *offer.1 < nearest.1 {
                    nearest = (*offer.0, *offer.1);
                }
                (*value, *away) = nearest;
                before = nearest;
            }
            above.row.values[1..=size].copy_from_slice(values);
            above.row.away[1..=size].copy_from_slice(aways);
        }
    }
}

/// The row above another one.
struct Above {
    /// With a border of cells that know nothing.
    row: Spread,
    /// What each cell of the row below gets of it.
    offered: Spread,
}

impl Above {
    fn nothing(size: usize) -> Self {
        let row = |size| Spread { values: vec![f32::INFINITY; size], away: vec![f32::INFINITY; size] };
        Self { row: row(size + 2), offered: row(size) }
    }

    fn offer(&mut self) {
        let size = self.offered.values.len();
        let (values, away) = (&self.row.values[..size + 2], &self.row.away[..size + 2]);
        let offered = self.offered.values.iter_mut().zip(&mut self.offered.away);
        for (column, (value, least)) in offered.enumerate() {
            let diagonal = std::f32::consts::SQRT_2;
            let [left, middle, right] =
                [away[column] + diagonal, away[column + 1] + 1.0, away[column + 2] + diagonal];
            let is_middle = middle < left;
            let first = if is_middle { middle } else { left };
            let is_right = right < first;
            let of_first = if is_middle { values[column + 1] } else { values[column] };
            *least = if is_right { right } else { first };
            *value = if is_right { values[column + 2] } else { of_first };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: usize = 12;

    fn raster() -> impl Strategy<Value = Raster> {
        prop::collection::vec(-3.0f32..3.0, SIZE * SIZE).prop_map(|values| Raster { size: SIZE, values })
    }

    /// The cells within a radius, those beyond the border as often as the border's stand for them.
    fn around(raster: &Raster, cell: usize, radius: isize) -> Vec<f32> {
        let clamp = |at: usize, step: isize| (at as isize + step).clamp(0, SIZE as isize - 1) as usize;
        let (row, column) = (cell / SIZE, cell % SIZE);
        let steps = (-radius..=radius).flat_map(|down| (-radius..=radius).map(move |right| (down, right)));
        steps.map(|(down, right)| raster.values[clamp(row, down) * SIZE + clamp(column, right)]).collect()
    }

    proptest! {
        #[test]
        fn windows_are_what_a_look_at_every_cell_finds(raster in raster(), radius in 0usize..5) {
            let (eroded, dilated, smoothed) = (raster.eroded(radius), raster.dilated(radius), raster.smoothed(radius));
            for cell in 0..SIZE * SIZE {
                let around = around(&raster, cell, radius as isize);
                prop_assert_eq!(eroded.values[cell], around.iter().copied().fold(f32::INFINITY, f32::min));
                prop_assert_eq!(dilated.values[cell], around.iter().copied().fold(f32::NEG_INFINITY, f32::max));
                let mean = around.iter().sum::<f32>() / around.len() as f32;
                prop_assert!((smoothed.values[cell] - mean).abs() < 1e-4);
            }
        }

        #[test]
        fn a_gap_takes_a_value_that_is_about_nearest(
            known in prop::collection::btree_map(0..SIZE * SIZE, -3.0f32..3.0, 1..9),
        ) {
            let mut raster = Raster::filled(SIZE, f32::INFINITY);
            known.iter().for_each(|(cell, value)| raster.values[*cell] = *value);
            let (filled, away) = raster.filled_from_nearest();
            for cell in 0..SIZE * SIZE {
                let to = |other: usize| {
                    let [rows, columns] =
                        [(cell / SIZE).abs_diff(other / SIZE), (cell % SIZE).abs_diff(other % SIZE)];
                    let diagonal = rows.min(columns) as f32;
                    diagonal * std::f32::consts::SQRT_2 + (rows.max(columns) as f32 - diagonal)
                };
                let nearest = known.keys().map(|other| to(*other)).fold(f32::INFINITY, f32::min);
                prop_assert!((away.values[cell] - nearest).abs() < 1e-4);
                let as_near = known.iter().filter(|(other, _)| to(**other) < nearest + 1e-4);
                prop_assert!(as_near.into_iter().any(|(_, value)| *value == filled.values[cell]));
            }
        }
    }

    #[test]
    fn between_cells_is_linear() {
        let raster = Raster { size: 2, values: vec![0.0, 1.0, 2.0, 3.0] };
        for (column, row, expected) in
            [(0.0, 0.0, 0.0), (0.5, 0.0, 0.5), (0.5, 0.5, 1.5), (9.0, 1.0, 3.0), (-1.0, 0.25, 0.5)]
        {
            assert_eq!(raster.between(column, row), expected);
        }
    }

    #[test]
    fn the_median_is_of_the_known_cells() {
        let mut raster = Raster::filled(3, f32::INFINITY);
        for (cell, value) in [(0, 0.0), (1, 0.1), (4, -5.0), (8, 0.2), (5, 7.0)] {
            raster.values[cell] = value;
        }
        let clipped = raster.clipped_to_median(&[0, 1, 4, 5, 8], 1, 0.3);
        // Around the middle all five are known, and their median is 0.1; around cell 5 -5, 0.1, 0.2 and 7, of which the
        // upper middle is 0.2.
        assert!((clipped.values[4] - 0.1).abs() < 1e-6 && (clipped.values[5] - 0.5).abs() < 1e-6);
        assert!(clipped.values[2].is_infinite());
    }
}
