//! Walls: what stands in the radar's way, as the straight line of columns that it belongs to.

use super::way::TALL;
use crate::scene::{ColumnGrid, StaticMap};

/// A wall is followed so far to each side, m.
const REACH: f64 = 3.0;
/// The columns within this show at first which way it leads, m.
const NEAR: f64 = 1.0;
/// No fewer of them do.
const COLUMNS: usize = 3;
/// Columns within this of its line belong to it, m.
const THICK: f64 = 0.4;
/// How often the line is drawn anew through what belongs to it.
const TIMES: usize = 3;

/// The wall that something tall belongs to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Wall {
    /// How long it is without a gap of more than a column, at most 3 m to each side, m.
    pub(super) length: f64,
    /// Height of its highest column, m.
    pub(super) top: f64,
}

/// A column in which something tall stands.
struct Upright {
    /// From the place that is asked about, m.
    place: [f64; 2],
    /// m
    top: f64,
}

impl Wall {
    /// The wall at a place, which may be no more than a post; `None` where too little stands to tell.
    pub(super) fn at(map: &StaticMap, [x, y]: [f64; 2]) -> Option<Self> {
        let columns = map.columns.around(x, y, REACH).filter(|(_, column)| column.top >= TALL);
        let columns: Vec<Upright> =
            columns.map(|(place, column)| Upright { place, top: column.top }).collect();
        let line = line_of(&columns)?;
        let foot = line.along([0.0, 0.0]);
        let (mut filled, mut top) = (0, 0.0_f64);
        for Upright { place, top: height } in
            columns.iter().filter(|column| line.across(column.place).abs() < THICK)
        {
            let beside = ((line.along(*place) - foot) / ColumnGrid::CELL).round();
            filled |= 1_u64 << (beside + MIDDLE as f64).clamp(0.0, 2.0 * MIDDLE as f64) as u32;
            top = top.max(*height);
        }
        let columns = run(filled, MIDDLE..=2 * MIDDLE) + run(filled, (0..MIDDLE).rev());
        Some(Self { length: ColumnGrid::CELL * f64::from(columns), top })
    }
}

/// Where the radar's way meets the wall, among the columns along it.
const MIDDLE: u32 = (REACH / ColumnGrid::CELL) as u32;

/// So many columns follow one another; one may lack.
fn run(filled: u64, along: impl Iterator<Item = u32>) -> u32 {
    let (mut length, mut lacking) = (0, 0);
    for column in along {
        if filled >> column & 1 == 1 {
            length += 1 + lacking;
            lacking = 0;
        } else {
            lacking += 1;
            if lacking > 1 {
                break;
            }
        }
    }
    length
}

/// The line of the columns at hand, drawn anew through what lies along it.
fn line_of(columns: &[Upright]) -> Option<Line> {
    let places = || columns.iter().map(|column| column.place);
    let mut chosen: Vec<[f64; 2]> = places().filter(|[x, y]| x * x + y * y <= NEAR * NEAR).collect();
    if chosen.len() < COLUMNS {
        return None;
    }
    let mut line = Line::through(&chosen);
    let mut before = Vec::with_capacity(columns.len());
    for _ in 0..TIMES {
        std::mem::swap(&mut chosen, &mut before);
        chosen.clear();
        chosen.extend(places().filter(|place| line.across(*place).abs() < THICK));
        // Through the same columns leads the same line.
        if chosen.len() < COLUMNS || chosen == before {
            break;
        }
        line = Line::through(&chosen);
    }
    Some(line)
}

/// A straight line through places, seen from above: the principal axis of their scatter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Line {
    /// Their mean, m.
    pub(super) middle: [f64; 2],
    /// Of unit length.
    pub(super) normal: [f64; 2],
    /// Their scatter across the line and along it, m^2.
    scatter: [f64; 2],
}

impl Line {
    /// Through one place at least.
    pub(super) fn through(places: &[[f64; 2]]) -> Self {
        let count = places.len() as f64;
        let middle = [0, 1].map(|axis| places.iter().map(|place| place[axis]).sum::<f64>() / count);
        let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
        for place in places {
            let [x, y] = [place[0] - middle[0], place[1] - middle[1]];
            xx += x * x;
            xy += x * y;
            yy += y * y;
        }
        // The principal axes of the scatter: half the trace, more and less by this.
        let (half, difference) = (0.5 * (xx + yy), 0.5 * (xx - yy));
        let apart = (difference * difference + xy * xy).sqrt();
        // The larger coordinate of the direction first: half of the angle whose cosine is `difference / apart`.
        let larger = (0.5 * (apart + difference.abs()) / apart).sqrt();
        let smaller = 0.5 * xy / (apart * larger);
        let [x, y] = if apart == 0.0 {
            [1.0, 0.0]
        } else if difference >= 0.0 {
            [larger, smaller]
        } else {
            [smaller.abs(), larger.copysign(xy)]
        };
        Self { middle, normal: [-y, x], scatter: [half - apart, half + apart] }
    }

    /// Whether the places scatter across the line by no more than this share of how they scatter along it.
    pub(super) fn is_thin(&self, share: f64) -> bool {
        self.scatter[0] <= share * share * self.scatter[1]
    }

    /// How far a place lies beside the line, m.
    fn across(&self, place: [f64; 2]) -> f64 {
        (place[0] - self.middle[0]) * self.normal[0] + (place[1] - self.middle[1]) * self.normal[1]
    }

    /// How far along the line a place lies from the middle, m.
    fn along(&self, place: [f64; 2]) -> f64 {
        (place[0] - self.middle[0]) * self.normal[1] - (place[1] - self.middle[1]) * self.normal[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_line_by_hand() {
        let slanted: Vec<[f64; 2]> =
            (0..9).map(|k| [0.25 * f64::from(k), 1.0 + 0.25 * f64::from(k)]).collect();
        let line = Line::through(&slanted);
        let half = 0.5_f64.sqrt();
        assert!((line.middle[0] - 1.0).abs() < 1e-12 && (line.middle[1] - 2.0).abs() < 1e-12);
        assert!((line.normal[0] + half).abs() < 1e-12 && (line.normal[1] - half).abs() < 1e-12);
        // From (1, 2) half a square's diagonal across, and as much along.
        assert!((line.across([0.0, 2.0]) - half).abs() < 1e-12, "{line:?}");
        assert!((line.along([0.0, 2.0]) + half).abs() < 1e-12, "{line:?}");
        assert!(line.is_thin(0.25));
        let upright: Vec<[f64; 2]> = (0..9).map(|k| [3.0, f64::from(k)]).collect();
        assert!((Line::through(&upright).normal[0].abs() - 1.0).abs() < 1e-12);
        let post = Line::through(&[[1.0, 2.0], [1.0, 2.0]]);
        assert_eq!((post.normal, post.scatter), ([0.0, 1.0], [0.0, 0.0]));
        let heap: Vec<[f64; 2]> = (0..9).map(|k| [f64::from(k % 3), f64::from(k / 3)]).collect();
        assert!(!Line::through(&heap).is_thin(0.25));
    }

    proptest! {
        #[test]
        fn a_line_leads_along_half_the_angle_of_its_scatter(
            places in prop::collection::vec([-3f64..3.0, -3f64..3.0], 2..30),
        ) {
            let line = Line::through(&places);
            let beside = |axis: usize| places.iter().map(move |place| place[axis] - line.middle[axis]);
            let product = |a: usize, b: usize| beside(a).zip(beside(b)).map(|(a, b)| a * b).sum::<f64>();
            let [xx, xy, yy] = [product(0, 0), product(0, 1), product(1, 1)];
            let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
            // Of a round heap no direction is the principal one.
            prop_assume!((xx - yy).hypot(xy) > 1e-6);
            prop_assert!((line.normal[0] + angle.sin()).abs() < 1e-6, "{line:?} {angle}");
            prop_assert!((line.normal[1] - angle.cos()).abs() < 1e-6, "{line:?} {angle}");
        }
    }

    #[test]
    fn a_run_ends_at_a_gap_of_two() {
        assert_eq!(run(0b1_1011, 0..5), 5);
        assert_eq!(run(0b1_1001, 0..5), 1);
        assert_eq!(run(0b1_0110, 0..5), 5, "one may lack at its begin");
        assert_eq!([run(0, 0..5), run(0b100, 0..5)], [0, 0]);
    }
}
