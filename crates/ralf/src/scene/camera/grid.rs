//! Places in a view, sorted into square buckets: which lie near a pixel?

/// Places in the image plane, sorted into buckets row by row; within a bucket they keep their order.
#[derive(Debug)]
pub(super) struct PixelGrid {
    origin: [f64; 2],
    cell: f64,
    /// `1 / cell`, for a product is quicker than a quotient.
    per_px: f64,
    columns: usize,
    rows: usize,
    /// Where each bucket begins among the places, and the end of the last.
    starts: Vec<usize>,
    places: Vec<Entry>,
}

/// A place, and its index in the list that the grid was made of.
#[derive(Debug, Clone, Copy)]
pub(super) struct Entry {
    pub(super) pixel: [f64; 2],
    pub(super) index: usize,
}

impl PixelGrid {
    /// Sorts finite places into buckets of a width, px, above 0.
    pub(super) fn new(pixels: &[[f64; 2]], cell: f64) -> Self {
        let ([left, top], [right, bottom]) = bounds(pixels);
        let per_px = 1.0 / cell;
        let count = |extent: f64| (extent * per_px) as usize + 1;
        let mut grid = Self {
            origin: [left, top],
            cell,
            per_px,
            columns: count(right - left),
            rows: count(bottom - top),
            starts: vec![],
            places: vec![Entry { pixel: [0.0; 2], index: 0 }; pixels.len()],
        };
        let buckets: Vec<usize> = pixels.iter().map(|pixel| grid.bucket(*pixel)).collect();
        // A counting sort: ends first, then filled from behind.
        let mut starts = vec![0; grid.columns * grid.rows + 1];
        for bucket in &buckets {
            starts[*bucket] += 1;
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        for (index, bucket) in buckets.iter().enumerate().rev() {
            starts[*bucket] -= 1;
            grid.places[starts[*bucket]] = Entry { pixel: pixels[index], index };
        }
        grid.starts = starts;
        grid
    }

    /// A grid whose buckets hold about two places each.
    pub(super) fn balanced(pixels: &[[f64; 2]]) -> Self {
        let ([left, top], [right, bottom]) = bounds(pixels);
        let area = (right - left + 1.0) * (bottom - top + 1.0);
        Self::new(pixels, (2.0 * area / pixels.len().max(1) as f64).sqrt().max(1.0))
    }

    pub(super) fn rows(&self) -> usize {
        self.rows
    }

    /// Width of a bucket, px.
    pub(super) fn cell(&self) -> f64 {
        self.cell
    }

    /// The upper border of a row of buckets, px.
    pub(super) fn top(&self, row: usize) -> f64 {
        self.origin[1] + row as f64 * self.cell
    }

    /// The row of buckets of a place, the nearest where it lies outside.
    pub(super) fn row(&self, v: f64) -> usize {
        // A cast holds at 0.
        (((v - self.origin[1]) * self.per_px) as usize).min(self.rows - 1)
    }

    fn column(&self, u: f64) -> usize {
        (((u - self.origin[0]) * self.per_px) as usize).min(self.columns - 1)
    }

    /// The bucket of a place.
    pub(super) fn bucket(&self, [u, v]: [f64; 2]) -> usize {
        self.row(v) * self.columns + self.column(u)
    }

    /// The buckets of one row that hold the places from `left` to `right`, as one range of bucket numbers.
    pub(super) fn buckets(&self, row: usize, left: f64, right: f64) -> std::ops::Range<usize> {
        let first = row * self.columns;
        first + self.column(left)..first + self.column(right) + 1
    }

    /// The places of a range of buckets.
    pub(super) fn places(&self, buckets: std::ops::Range<usize>) -> &[Entry] {
        &self.places[self.starts[buckets.start]..self.starts[buckets.end]]
    }

    /// How many buckets there are.
    pub(super) fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// All indices, bucket by bucket: places that follow each other lie near each other.
    pub(super) fn order(&self) -> impl Iterator<Item = usize> {
        self.places.iter().map(|place| place.index)
    }
}

/// Least and greatest coordinates; (0, 0) without places.
fn bounds(pixels: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let first = pixels.first().copied().unwrap_or_default();
    pixels.iter().fold((first, first), |(low, high), [u, v]| {
        ([low[0].min(*u), low[1].min(*v)], [high[0].max(*u), high[1].max(*v)])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_place_lies_in_its_bucket_in_order() {
        let pixels = [[5.0, 1.0], [0.0, 0.0], [5.5, 1.5], [0.1, 3.9], [5.0, 1.0]];
        let grid = PixelGrid::new(&pixels, 2.0);
        assert_eq!((grid.rows(), grid.len()), (2, 6));
        let indices = |row, left, right| {
            grid.places(grid.buckets(row, left, right)).iter().map(|place| place.index).collect::<Vec<_>>()
        };
        assert_eq!(indices(0, 0.0, 1.0), [1]);
        assert_eq!(indices(0, 4.0, 6.0), [0, 2, 4]);
        assert_eq!(indices(0, -9.0, 99.0), [1, 0, 2, 4]);
        assert_eq!(indices(1, -9.0, 99.0), [3]);
        assert_eq!(grid.order().collect::<Vec<_>>(), [1, 0, 2, 4, 3]);
    }

    #[test]
    fn no_places_and_equal_places() {
        let none = PixelGrid::balanced(&[]);
        assert!(none.places(none.buckets(0, 0.0, 9.0)).is_empty());
        let equal = PixelGrid::balanced(&[[3.0, 4.0]; 5]);
        assert_eq!(equal.order().collect::<Vec<_>>(), [0, 1, 2, 3, 4]);
    }
}
