//! Detections to be searched for those within a few standard deviations of a place.
//!
//! Most that are near in metres are far in standard deviations. Numbers of half the precision, some at a time, tell
//! these apart; what they leave is for [`chi_within`](super::distance::chi_within) to decide.

use super::distance::{DriftingSpot, ROOM, Spot, farthest_within};
use crate::scene::Detection;
use crate::space::NeighborIndex;
use std::borrow::Cow;
use std::ops::Range;
use wide::f32x8;

/// Detections that are looked at together.
const LANES: usize = 8;
/// Distances of so much more than wanted, squared, are left for a closer look: coordinates are rounded.
const ROUNDED: f32 = 1.02;
/// Sums and products are rounded by less than this share of their parts.
const ROUNDING: f32 = 1e-6;

/// Detections, to be searched. What is visited together lies together: all is in the order of the index.
pub(super) struct Cloud<'a> {
    index: Cow<'a, NeighborIndex>,
    spots: Vec<Spot>,
    flat: Flat,
    variances: Variances,
}

impl<'a> Cloud<'a> {
    /// The detections of an index, each of which `detection` tells by its identity.
    pub(super) fn new<'d>(index: Cow<'a, NeighborIndex>, detection: impl Fn(usize) -> &'d Detection) -> Self {
        let spots: Vec<Spot> = index.ids().iter().map(|id| Spot::new(detection(*id as usize))).collect();
        let (flat, variances) = (Flat::new(&spots), Variances::new(&spots));
        Self { index, spots, flat, variances }
    }

    /// Visits all within a distance `limit` of a spot, in standard deviations, and some beyond, but none farther than
    /// `most`, m, seen from above: each with its place in the order of the index.
    pub(super) fn each_near(&self, spot: &Spot, limit: f64, most: f32, mut visit: impl FnMut(usize, &Spot)) {
        let reach = self.variances.farthest(spot, limit, most);
        let seeker = Seeker::new(spot, limit, reach);
        for run in self.index.runs_around(spot.in_plan(), reach) {
            self.visit_run(run, |begin| self.flat.meet(begin, &seeker), &mut visit);
        }
    }

    /// The same around where a drifting spot is at the time of each detection. Some may be a hair farther than `most`.
    pub(super) fn each_met(
        &self,
        seeker: &DriftingSpot,
        times: &Times,
        limit: f64,
        most: f32,
        mut visit: impl FnMut(usize, &Spot),
    ) {
        let DriftingSpot { spot, drift } = seeker;
        let [first, last] = times.span;
        let longest = last.max(-first);
        let least_certain = seeker.after(longest);
        let [from, to] = times.span.map(|time| least_certain.moved(&(drift.place * (time - longest))));
        let farther = if to.place.xy().norm() > from.place.xy().norm() { &to } else { &from };
        let reach = self.variances.farthest(farther, limit, most) + SLACK as f32;
        let (seeker, drifting) = (Seeker::new(spot, limit, reach), Drifting::new(drift));
        let way = [from, to].map(|end| end.in_plan());
        for run in self.index.runs_along(way, reach) {
            let meet = |begin| self.flat.meet_moving(begin, &seeker, &drifting, &times.each);
            self.visit_run(run, meet, &mut visit);
        }
    }

    /// Visits those of a stretch of the index that are near; `meet` tells which of a few that begin at a place are, a
    /// bit each.
    #[inline]
    fn visit_run(
        &self,
        run: Range<usize>,
        meet: impl Fn(usize) -> u32,
        visit: &mut impl FnMut(usize, &Spot),
    ) {
        let spots = &self.spots[run.clone()];
        for (begin, spots) in run.step_by(LANES).zip(spots.chunks(LANES)) {
            let mut near = meet(begin);
            while let Some(spot) = spots.get(near.trailing_zeros() as usize) {
                visit(begin + near.trailing_zeros() as usize, spot);
                near &= near - 1;
            }
        }
    }

    /// What is known of each detection by its identity, in the order of the index.
    pub(super) fn in_order<T>(&self, known: impl Fn(usize) -> T) -> impl Iterator<Item = T> {
        self.index.ids().iter().map(move |id| known(*id as usize))
    }

    /// A detection by its place in the order of the index.
    pub(super) fn spot(&self, place: usize) -> &Spot {
        &self.spots[place]
    }

    /// The detections' places, to be searched in metres.
    pub(super) fn index(&self) -> &NeighborIndex {
        &self.index
    }
}

/// When the detections of a cloud were made.
pub(super) struct Times {
    /// s, in the order of the index, with as many more as are looked at together.
    each: Vec<f32>,
    /// The first and the last of them, s.
    span: [f64; 2],
}

impl Times {
    /// `each` is in the order of the index, s, and not a number of detections that are out of the question; `span` is
    /// the first and the last.
    pub(super) fn new(each: impl Iterator<Item = f32>, span: [f64; 2]) -> Self {
        Self { each: each.chain(std::iter::repeat_n(f32::NAN, LANES)).collect(), span }
    }
}

/// Places, m, and horizontal covariances, m^2, each number apart; with a few more at the end, so that some can be taken
/// together anywhere.
struct Flat {
    x: Vec<f32>,
    y: Vec<f32>,
    xx: Vec<f32>,
    xy: Vec<f32>,
    yy: Vec<f32>,
}

impl Flat {
    fn new(spots: &[Spot]) -> Self {
        let [mut x, mut y, mut xx, mut xy, mut yy] = [0; 5].map(|_| vec![0.0; spots.len() + LANES]);
        let numbers = x.iter_mut().zip(&mut y).zip(&mut xx).zip(&mut xy).zip(&mut yy);
        for (spot, ((((x, y), xx), xy), yy)) in spots.iter().zip(numbers) {
            [*x, *y] = spot.in_plan();
            [*xx, *xy, *yy] = spot.horizontal.map(|number| number as f32);
        }
        Self { x, y, xx, xy, yy }
    }

    /// Which of those that begin at a place may be near a seeker, a bit each.
    #[inline]
    fn meet(&self, begin: usize, seeker: &Seeker) -> u32 {
        let [Some(x), Some(y)] = [&self.x, &self.y].map(|column| few(column, begin)) else { return 0 };
        let Some(covariance) = self.covariance(begin) else { return 0 };
        seeker.meet([x, y], covariance)
    }

    /// The same where the seeker drifts: each of them meets it at its own time.
    #[inline]
    fn meet_moving(&self, begin: usize, seeker: &Seeker, drifting: &Drifting, times: &[f32]) -> u32 {
        let [Some(x), Some(y)] = [&self.x, &self.y].map(|column| few(column, begin)) else { return 0 };
        let Some(times) = few(times, begin) else { return 0 };
        let [along_x, along_y] = drifting.velocity.map(|velocity| velocity * times);
        let place = [x - along_x, y - along_y];
        // Of a long way most is far from where the seeker is at the time.
        if !seeker.reaches_any(place) {
            return 0;
        }
        let Some([xx, xy, yy]) = self.covariance(begin) else { return 0 };
        let [more_xx, more_xy, more_yy] = drifting.horizontal.map(|growth| growth * times * times);
        seeker.meet(place, [xx + more_xx, xy + more_xy, yy + more_yy])
    }

    /// xx, xy and yy of those that begin at a place.
    #[inline]
    fn covariance(&self, begin: usize) -> Option<[f32x8; 3]> {
        Some([few(&self.xx, begin)?, few(&self.xy, begin)?, few(&self.yy, begin)?])
    }
}

/// Numbers that follow each other in a column.
#[inline]
fn few(column: &[f32], begin: usize) -> Option<f32x8> {
    column.get(begin..)?.first_chunk::<LANES>().map(|few| f32x8::from(*few))
}

/// A spot whose neighbours are sought: the same numbers for each of a few.
struct Seeker {
    place: [f32x8; 2],
    /// xx, xy and yy with the room that all have, m^2.
    horizontal: [f32x8; 3],
    limit_squared: f32x8,
    reach_squared: f32x8,
}

impl Seeker {
    fn new(spot: &Spot, limit: f64, reach: f32) -> Self {
        let [xx, xy, yy] = spot.horizontal;
        let all = |v: f64| f32x8::splat(v as f32);
        Self {
            place: [spot.place.x, spot.place.y].map(all),
            horizontal: [xx + ROOM * ROOM, xy, yy + ROOM * ROOM].map(all),
            limit_squared: f32x8::splat((limit * limit) as f32 * ROUNDED),
            reach_squared: f32x8::splat(reach * reach),
        }
    }

    /// Whether any of a few lies within reach.
    #[inline]
    fn reaches_any(&self, [x, y]: [f32x8; 2]) -> bool {
        let [x, y] = [x - self.place[0], y - self.place[1]];
        (x * x + y * y).simd_le(self.reach_squared).any()
    }

    /// Which of a few may lie within limit and reach, seen from above, a bit each; what can't be told may.
    #[inline]
    fn meet(&self, [x, y]: [f32x8; 2], [xx, xy, yy]: [f32x8; 3]) -> u32 {
        let [x, y] = [x - self.place[0], y - self.place[1]];
        let [xx, xy, yy] = [self.horizontal[0] + xx, self.horizontal[1] + xy, self.horizontal[2] + yy];
        let (distance_squared, trace) = (x * x + y * y, xx + yy);
        let determinant = xx * yy - xy * xy;
        let by_determinant = x * x * yy - f32x8::splat(2.0) * x * y * xy + y * y * xx;
        let slack = f32x8::splat(ROUNDING) * trace * (distance_squared + self.limit_squared * trace);
        let is_far = by_determinant.simd_gt(self.limit_squared * determinant + slack);
        distance_squared.simd_le(self.reach_squared).to_bitmask() & !is_far.to_bitmask()
    }
}

/// How a spot drifts: the same numbers for each of a few.
struct Drifting {
    /// m/s
    velocity: [f32x8; 2],
    /// How xx, xy and yy grow with the square of the time, m^2/s^2.
    horizontal: [f32x8; 3],
}

impl Drifting {
    fn new(drift: &Spot) -> Self {
        let all = |v: f64| f32x8::splat(v as f32);
        Self { velocity: [drift.place.x, drift.place.y].map(all), horizontal: drift.horizontal.map(all) }
    }
}

/// How uncertain detections are by how far they lie from the frame's origin.
struct Variances {
    /// No horizontal variance within this many metres and one is larger, m^2.
    within: Vec<f64>,
}

impl Variances {
    /// Farther than this all are taken together, m.
    const FARTHEST: usize = 400;

    fn new(spots: &[Spot]) -> Self {
        let mut within = vec![0.0f64; Self::FARTHEST + 1];
        for spot in spots {
            let metre = &mut within[metre(spot.place.xy().norm())];
            *metre = metre.max(spot.variance);
        }
        let mut largest = 0.0f64;
        for metre in &mut within {
            largest = largest.max(*metre);
            *metre = largest;
        }
        Self { within }
    }

    /// Nothing is within a distance `limit` of a spot that is farther away than this, m, seen from above, or it is
    /// farther than `most`.
    fn farthest(&self, spot: &Spot, limit: f64, most: f32) -> f32 {
        let away = spot.place.xy().norm();
        let within = |reach: f32| {
            let largest = self.within[metre(away + SLACK + f64::from(reach))];
            farthest_within(limit, spot, largest).min(reach)
        };
        // What is as near as that asks for is perhaps less uncertain than what is farther.
        within(within(most))
    }
}

/// Places are rounded by less than this, m.
const SLACK: f64 = 0.01;

/// The entry of a distance, m.
fn metre(distance: f64) -> usize {
    (distance as usize).min(Variances::FARTHEST)
}

#[cfg(test)]
mod tests {
    use super::super::distance::chi_within;
    use super::*;
    use crate::space::Point;
    use nalgebra::Matrix3;
    use proptest::prelude::*;

    /// Some long and thin, as azimuths far away make them.
    fn detection() -> impl Strategy<Value = Detection> {
        let sigmas = (0.001f64..0.4, 0.001f64..9.0, 0.0f64..6.3);
        (-30.0f64..30.0, -30.0f64..30.0, 0i32..4, sigmas).prop_map(|(x, y, far, (thin, long, angle))| {
            let far = 10f64.powi(far);
            let (sin, cos) = angle.sin_cos();
            let axes = Matrix3::new(cos * thin, -sin * long, 0.0, sin * thin, cos * long, 0.0, 0.0, 0.0, 0.3);
            Detection { position: Point::new(far + x, y, 0.0), axes }
        })
    }

    fn cloud(detections: &[Detection]) -> Cloud<'static> {
        let places: Vec<[f32; 3]> =
            detections.iter().map(|d| d.position.coords.cast::<f32>().into()).collect();
        let ids: Vec<u32> = (0..places.len() as u32).collect();
        Cloud::new(Cow::Owned(NeighborIndex::new(&places, &ids)), |id| &detections[id])
    }

    proptest! {
        #[test]
        fn all_that_are_near_are_visited_once(
            detections in prop::collection::vec(detection(), 0..200),
            seekers in prop::collection::vec(detection(), 5), limit in 0.5f64..4.0, most in 0.1f32..40.0,
        ) {
            let cloud = cloud(&detections);
            for seeker in seekers.iter().map(Spot::new) {
                let (mut found, mut beside) = (Vec::new(), Vec::new());
                cloud.each_near(&seeker, limit, most, |at, _| found.push(cloud.index().ids()[at]));
                found.sort_unstable();
                prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "none twice");
                cloud.index().beside(seeker.in_plan(), most, &mut beside);
                prop_assert!(found.iter().all(|id| beside.contains(id)), "none farther than that");
                for id in beside {
                    let spot = Spot::new(&detections[id as usize]);
                    let is_near = chi_within(limit, &seeker, &spot, true).is_some();
                    prop_assert!(!is_near || found.contains(&id), "{seeker:?} {spot:?}");
                }
            }
        }
    }

    proptest! {
        #[test]
        fn all_that_are_near_a_drifting_spot_at_their_time_are_visited_once(
            timed in prop::collection::vec((detection(), prop_oneof![3 => -0.7f64..0.7, 1 => Just(f64::NAN)]), 0..200),
            seekers in prop::collection::vec(detection(), 5), velocity in prop::array::uniform2(-40f64..40.0),
            growth in prop::array::uniform4(-6f64..6.0), limit in 0.5f64..4.0, most in 0.1f32..40.0,
        ) {
            let (detections, times): (Vec<Detection>, Vec<f64>) = timed.into_iter().unzip();
            let cloud = cloud(&detections);
            let in_order = Times::new(cloud.in_order(|id| times[id] as f32), [-0.7, 0.7]);
            let [a, b, c, d] = growth;
            let axes = Matrix3::new(a, b, 0.0, c, d, 0.0, 0.0, 0.0, 0.0);
            let drift = Spot::new(&Detection { position: Point::new(velocity[0], velocity[1], 0.0), axes });
            for seeker in seekers.iter().map(|seeker| DriftingSpot { spot: Spot::new(seeker), drift }) {
                let mut found = Vec::new();
                cloud.each_met(&seeker, &in_order, limit, most, |at, _| {
                    found.push(cloud.index().ids()[at] as usize);
                });
                found.sort_unstable();
                prop_assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "none twice");
                prop_assert!(found.iter().all(|id| times[*id].is_finite()), "none that is out of the question");
                for (id, detection) in detections.iter().enumerate().filter(|(id, _)| times[*id].is_finite()) {
                    let (there, spot) = (seeker.after(times[id]), Spot::new(detection));
                    let distance = (there.place - spot.place).xy().norm();
                    let is_near = chi_within(limit, &there, &spot, true).is_some() && distance <= f64::from(most);
                    prop_assert!(!is_near || found.binary_search(&id).is_ok(), "{there:?} {spot:?}");
                }
            }
        }
    }

    #[test]
    fn what_is_far_in_standard_deviations_is_passed_over() {
        let at = |x: f64, y: f64| {
            let axes = Matrix3::from_diagonal(&nalgebra::Vector3::new(0.1, 1.0, 0.1));
            Detection { position: Point::new(x, y, 0.0), axes }
        };
        // Variances of 0.03 and 2.01: three standard deviations are 0.52 m along x and 4.25 m along y.
        let cloud = cloud(&[at(10.5, 0.0), at(10.55, 0.0), at(10.0, 4.2), at(10.0, 4.35)]);
        let mut found = Vec::new();
        cloud.each_near(&Spot::new(&at(10.0, 0.0)), 3.0, 8.0, |at, _| found.push(cloud.index().ids()[at]));
        found.sort_unstable();
        assert_eq!(found, [0, 2]);
    }
}
