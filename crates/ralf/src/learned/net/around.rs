//! Which detections of a scan lie around each, and where.

use super::matrix::Matrix;
use crate::space::NeighborIndex;

/// Numbers that tell where a detection lies, seen from another: along and across the line of sight, and above, each as
/// `asinh` of metres; and how far away, seen from above, as `ln(1 + m)`.
pub const WAYS: usize = 4;

/// The detections around each one of a scan, or of several, one after the other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Around {
    /// How many each detection has.
    nearest: usize,
    /// The places of those of each detection, side by side; its own where there are fewer in its scan.
    of: Vec<u32>,
    /// Where each of them lies.
    ways: Matrix,
}

impl Around {
    /// The nearest ones of each detection of a scan, seen from above, of places in the vehicle frame, m, which are
    /// finite.
    pub fn of(places: &[[f32; 3]], nearest: usize) -> Self {
        let mut around = Self {
            nearest,
            of: Vec::with_capacity(places.len() * nearest),
            ways: Matrix::zeros(places.len() * nearest, WAYS),
        };
        let in_plan: Vec<[f32; 3]> = places.iter().map(|[x, y, _]| [*x, *y, 0.0]).collect();
        let ids: Vec<u32> = (0..places.len() as u32).collect();
        let index = NeighborIndex::new(&in_plan, &ids);
        let mut found = Vec::new();
        for (id, from) in (0_u32..).zip(&in_plan) {
            let seat = Seat::at(places[id as usize]);
            // One more, for it finds itself; where many lie at one place, perhaps it doesn't.
            index.nearest(*from, nearest + 1, &mut found);
            let others = found.iter().map(|neighbour| neighbour.id).filter(|other| *other != id);
            let others = others.chain(std::iter::repeat(id)).take(nearest);
            for other in others {
                let way = seat.way_to(places[other as usize]);
                around.ways.row_mut(around.of.len()).copy_from_slice(&way);
                around.of.push(other);
            }
        }
        around
    }

    /// Those of several scans, whose detections come one after the other.
    pub fn joined<'a>(scans: impl IntoIterator<Item = &'a Self> + Clone, nearest: usize) -> Self {
        let pairs = scans.clone().into_iter().map(|scan| scan.of.len()).sum();
        let mut joined = Self { nearest, of: Vec::with_capacity(pairs), ways: Matrix::zeros(pairs, WAYS) };
        for scan in scans {
            let pairs = joined.of.len();
            let before = (pairs / nearest) as u32;
            joined.of.extend(scan.of.iter().map(|other| before + other));
            joined.ways.values_mut()[pairs * WAYS..][..scan.ways.values().len()]
                .copy_from_slice(scan.ways.values());
        }
        joined
    }

    /// The places of those around a detection.
    pub fn of_one(&self, row: usize) -> &[u32] {
        &self.of[row * self.nearest..][..self.nearest]
    }

    /// The same, each behind the number of the pair: its row of [`Self::ways`].
    pub fn pairs_of(&self, row: usize) -> impl Iterator<Item = (usize, u32)> + '_ {
        (row * self.nearest..).zip(self.of_one(row).iter().copied())
    }

    /// How many each detection has.
    pub fn nearest(&self) -> usize {
        self.nearest
    }

    /// Where each of them lies: [`WAYS`] numbers a row, as many rows for each detection as it has others.
    pub fn ways(&self) -> &Matrix {
        &self.ways
    }
}

/// A detection from which others are seen.
struct Seat {
    place: [f32; 3],
    /// From the frame's origin to it, seen from above, of length 1; 0 at the origin.
    ahead: [f32; 2],
}

impl Seat {
    fn at(place: [f32; 3]) -> Self {
        let [x, y, _] = place;
        let range = (x * x + y * y).sqrt().max(f32::MIN_POSITIVE);
        Self { place, ahead: [x / range, y / range] }
    }

    /// Where another detection lies.
    fn way_to(&self, other: [f32; 3]) -> [f32; WAYS] {
        let [dx, dy, dz]: [f32; 3] = std::array::from_fn(|axis| other[axis] - self.place[axis]);
        let [x, y] = self.ahead;
        let (along, across) = (dx * x + dy * y, dy * x - dx * y);
        let apart = (dx * dx + dy * dy).sqrt();
        // asinh v is ln (|v| + sqrt(v^2 + 1)), with the sign of v.
        let above_one = |v: f32| v.abs() + (v * v + 1.0).sqrt();
        let [near, aside, above, away] =
            [above_one(along), above_one(across), above_one(dz), 1.0 + apart].map(logarithm);
        [near.copysign(along), aside.copysign(across), above.copysign(dz), away]
    }
}

/// The natural logarithm of a number from 1 on, within 1e-6 of it: the same bits on every machine, and side by side.
fn logarithm(number: f32) -> f32 {
    const MANTISSA: u32 = f32::MANTISSA_DIGITS - 1;
    // So that what is left of the number lies between sqrt(1/2) and sqrt(2).
    let twos = (number.to_bits() - std::f32::consts::FRAC_1_SQRT_2.to_bits()) >> MANTISSA;
    let left = f32::from_bits(number.to_bits() - (twos << MANTISSA));
    // ln m = 2 (s + s^3 / 3 + s^5 / 5 + ...) with s = (m - 1) / (m + 1).
    let s = (left - 1.0) / (left + 1.0);
    let squared = s * s;
    let series = 1.0 + squared * (1.0 / 3.0 + squared * (0.2 + squared * (1.0 / 7.0 + squared / 9.0)));
    twos as f32 * std::f32::consts::LN_2 + 2.0 * s * series
}

#[cfg(test)]
mod tests {
    use super::super::tests::scan;
    use super::*;

    #[test]
    fn those_around_are_the_nearest_of_all() {
        for count in [1, 3, 4, 90] {
            let (_, mut places) = scan(count, 1);
            // Some lie at one place.
            let last = count - 1;
            places[last] = places[0];
            let around = Around::of(&places, 3);
            for (row, from) in places.iter().enumerate() {
                let far = |other: usize| (from[0] - places[other][0]).hypot(from[1] - places[other][1]);
                let mut others: Vec<f32> = (0..count).filter(|other| *other != row).map(far).collect();
                others.sort_by(f32::total_cmp);
                let found: Vec<usize> = around.of_one(row).iter().map(|other| *other as usize).collect();
                for (place, other) in found.iter().enumerate() {
                    match others.get(place) {
                        Some(expected) => assert!(*other != row && (far(*other) - expected).abs() < 1e-4),
                        None => assert_eq!(*other, row),
                    }
                }
            }
        }
    }

    #[test]
    fn a_way_is_told_along_the_line_of_sight() {
        // 3 m behind and 4 m to the left of what lies ahead, on the left.
        let seat = Seat::at([0.0, 10.0, 1.0]);
        let found = seat.way_to([-4.0, 13.0, 1.5]).map(|number| (number * 1e3).round() / 1e3);
        let expected = [3.0_f32.asinh(), 4.0_f32.asinh(), 0.5_f32.asinh(), 6.0_f32.ln()];
        assert_eq!(found, expected.map(|number| (number * 1e3).round() / 1e3));
        assert_eq!(Seat::at([0.0; 3]).way_to([0.0; 3]), [0.0; WAYS]);
    }

    #[test]
    fn a_logarithm_is_that_of_the_library() {
        for step in 0..4000 {
            let number = (0.02 * step as f32).exp();
            let expected = number.ln();
            assert!((logarithm(number) - expected).abs() <= 1e-6 * expected.max(1.0), "{number}");
        }
        assert_eq!(logarithm(1.0), 0.0);
        assert!(logarithm(f32::INFINITY).is_finite() && logarithm(f32::NAN).is_finite());
    }

    #[test]
    fn several_scans_keep_to_themselves() {
        let scans: Vec<Around> = [5, 1, 7].map(|count| Around::of(&scan(count, 1).1, 2)).to_vec();
        let joined = Around::joined(&scans, 2);
        assert_eq!(joined.of_one(5), [5, 5], "one alone");
        assert!((6..13).all(|row| joined.of_one(row).iter().all(|other| (6..13).contains(other))));
        assert_eq!(joined.ways().row(2 * 6), scans[2].ways().row(0));
    }
}
