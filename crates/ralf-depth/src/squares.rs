//! A wide view covered with squares of its full height, and their depths made one: see [`crate::Fit::Squares`].

use crate::NetworkError;
use crate::plane::Plane;

/// First columns of the squares that cover a view, evenly spread; neighbours share at least half of their columns.
pub(crate) fn places(width: usize, height: usize) -> Vec<usize> {
    let rest = width.saturating_sub(height);
    let steps = rest.div_ceil((height / 2).max(1));
    // Without a rest there is one step only, the first.
    (0..=steps).map(|step| step * rest / steps.max(1)).collect()
}

/// What to multiply each square by, that all have the scale of the middle one: medians of the ratios between
/// neighbours.
///
/// Squares come with their first column, from left to right, in the view's resolution.
pub(crate) fn scales(squares: &[(usize, Plane)]) -> Result<Vec<f32>, NetworkError> {
    let mut scales = vec![1.0; squares.len()];
    let middle = squares.len() / 2;
    for right in middle + 1..squares.len() {
        scales[right] = scales[right - 1] * median_ratio(&squares[right - 1], &squares[right])?;
    }
    for left in (0..middle).rev() {
        scales[left] = scales[left + 1] / median_ratio(&squares[left], &squares[left + 1])?;
    }
    Ok(scales)
}

/// The squares in one, each weighted down linearly towards its left and right edges where it has a neighbour.
pub(crate) fn blended(width: usize, squares: &[(usize, Plane)], scales: &[f32]) -> Plane {
    let height = squares.first().map_or(0, |(_, square)| square.height);
    let mut values = vec![0.0; width * height];
    let mut total = vec![0.0; width];
    for (left, square) in squares {
        for column in 0..square.width {
            total[left + column] += weight(column, square.width);
        }
    }
    for ((left, square), scale) in squares.iter().zip(scales) {
        for (row, own) in values.chunks_exact_mut(width.max(1)).zip(square.rows()) {
            for (column, value) in own.iter().enumerate() {
                let share = weight(column, square.width) / total[left + column];
                row[left + column] += share * scale * value;
            }
        }
    }
    Plane { width, height, values }
}

/// Distance of a column's centre from the nearer edge, px.
fn weight(column: usize, width: usize) -> f32 {
    column.min(width - 1 - column) as f32 + 0.5
}

/// Median of left / right over the pixels of which both have depth.
fn median_ratio(left: &(usize, Plane), right: &(usize, Plane)) -> Result<f32, NetworkError> {
    let (start, shared) = (right.0 - left.0, (left.0 + left.1.width).saturating_sub(right.0));
    let rows = left.1.rows().zip(right.1.rows());
    let pairs = rows.flat_map(|(left, right)| left[start..].iter().zip(&right[..shared]));
    let mut ratios: Vec<f32> = pairs.filter(|(l, r)| **l > 0.0 && **r > 0.0).map(|(l, r)| l / r).collect();
    let middle = ratios.len() / 2;
    if ratios.is_empty() {
        return Err(NetworkError::Seam { left: left.0, right: right.0 });
    }
    Ok(*ratios.select_nth_unstable_by(middle, f32::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_reach_from_edge_to_edge_and_share_half() {
        assert_eq!(places(1600, 900), [0, 350, 700]);
        assert_eq!(places(640, 480), [0, 160]);
        assert_eq!(places(480, 480), [0]);
        assert_eq!(places(3, 1), [0, 1, 2]);
        for (width, height) in [(1936, 1216), (1242, 375), (1000, 3), (7, 2), (901, 900)] {
            let places = places(width, height);
            assert_eq!((places[0], places[places.len() - 1]), (0, width - height));
            let most = places.windows(2).map(|pair| pair[1] - pair[0]).max().unwrap();
            assert!(most <= height.div_ceil(2), "{width} x {height}: {places:?}");
        }
    }

    /// Squares cut out of one image, each multiplied by a factor of its own.
    fn cut(image: &Plane, factors: &[f32]) -> Vec<(usize, Plane)> {
        let side = image.height;
        let places = places(image.width, side);
        assert_eq!(places.len(), factors.len());
        let square = |(left, factor): (usize, &f32)| {
            let mut square = image.cut(left..left + side, 0..side);
            square.values.iter_mut().for_each(|value| *value *= factor);
            (left, square)
        };
        places.into_iter().zip(factors).map(square).collect()
    }

    #[test]
    fn scales_of_their_own_vanish() {
        let values: Vec<f32> = (0..12 * 30).map(|i| 3.0 + ((i * 37) % 101) as f32).collect();
        let image = Plane { width: 30, height: 12, values };
        let squares = cut(&image, &[4.0, 0.5, 2.0, 8.0]);
        let whole = blended(30, &squares, &scales(&squares).unwrap());
        // The middle one of four is the third: the image comes out twice as large.
        for (found, expected) in whole.values.iter().zip(&image.values) {
            assert!((found / 2.0 - expected).abs() < 1e-4 * expected, "{found} {expected}");
        }
    }

    #[test]
    fn one_square_fades_linearly_into_the_next() {
        let flat = |value| Plane { width: 4, height: 4, values: vec![value; 16] };
        let whole = blended(6, &[(0, flat(0.0)), (2, flat(1.0))], &[1.0, 1.0]);
        // Columns 2 and 3 are shared: 1.5 : 0.5 px and 0.5 : 1.5 px from the edges.
        assert_eq!(whole.values[..6], [0.0, 0.0, 0.25, 0.75, 1.0, 1.0]);
    }

    #[test]
    fn pixels_without_depth_dont_count_and_a_seam_without_any_is_an_error() {
        let of = |values: [f32; 4]| Plane { width: 4, height: 1, values: values.to_vec() };
        let left = (0, of([9.0, 9.0, 0.0, 6.0]));
        assert_eq!(scales(&[left.clone(), (2, of([5.0, 2.0, 9.0, 9.0]))]).unwrap(), [1.0 / 3.0, 1.0]);
        let error = scales(&[left, (2, of([5.0, 0.0, 9.0, 9.0]))]).unwrap_err();
        assert!(error.to_string().starts_with("squares at columns 0 and 2"), "{error}");
    }
}
