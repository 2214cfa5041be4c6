//! Which part of the ground a picture shows.

use crate::error::PlotError;
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// Which part of the ground a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum Extent {
    /// All detections but the farthest 0.5 % to each side, the vehicle and its path. How many lie outside is written
    /// into the picture.
    #[default]
    Fit,
    /// At least this far around the vehicle, or around the middle of the path in an overview, m.
    Radius(f64),
}

/// A rectangle on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Window {
    /// x and y, m.
    pub(crate) centre: [f64; 2],
    /// Half its lengths along x and y, m, above 0.
    pub(crate) half: [f64; 2],
}

/// No recording is wider than this, nor lies farther from the origin of its frame, m.
const FARTHEST: f64 = 1e8;
/// Part of the places left out at each end of each axis.
const TAIL: f64 = 0.005;
/// Part of the window's half length kept free around its content.
const MARGIN: f64 = 0.05;
/// The smallest half length, m.
const LEAST_HALF: f64 = 5.0;
/// The smallest radius that can be asked for, m: what is drawn up to 1 km away, such as a sensor, has a place in pixels
/// of the widest picture that 32 bits can hold.
const LEAST_RADIUS: f64 = 0.01;
/// Half length where there is nothing to show, m.
const EMPTY_HALF: f64 = 20.0;

/// Whether x and y are a place that can be drawn: finite, and on earth.
pub(crate) fn is_place(place: &[f64; 2]) -> bool {
    place.iter().all(|value| value.abs() <= FARTHEST)
}

impl Extent {
    /// Refuses a radius that is no length, or one in which nothing can be drawn.
    pub(crate) fn check(&self) -> Result<(), PlotError> {
        match *self {
            Self::Radius(found) if !(LEAST_RADIUS..=FARTHEST).contains(&found) => {
                Err(PlotError::Radius { least: LEAST_RADIUS, most: FARTHEST, found })
            }
            _ => Ok(()),
        }
    }

    /// The window to show. `scattered` lose their farthest, `kept` are shown in any case; a radius is taken around
    /// `kept`'s middle or, without any, the middle of `scattered`.
    pub(crate) fn window(self, scattered: impl Iterator<Item = [f64; 2]>, kept: &[[f64; 2]]) -> Window {
        self.window_of(bounds(scattered, TAIL), kept)
    }

    /// The same, where the bounds of what is scattered are known.
    pub(crate) fn window_of(self, scattered: Option<Bounds>, kept: &[[f64; 2]]) -> Window {
        let kept = bounds(kept.iter().copied(), 0.0);
        match self {
            Self::Fit => around(union(scattered, kept)),
            Self::Radius(radius) => {
                let middle = around(kept.or(scattered));
                Window { centre: middle.centre, half: [radius; 2] }
            }
        }
    }
}

/// Lowest and highest value of x and of y.
pub(crate) type Bounds = [[f64; 2]; 2];

/// The bounds of very many places without their tails, with no more in memory than the tails: the lowest and highest
/// values along each axis, as many as may be left out at most.
pub(crate) struct Tails {
    /// Values that are kept at each end.
    kept: usize,
    places: usize,
    lowest: [BinaryHeap<Ordered>; 2],
    highest: [BinaryHeap<Reverse<Ordered>>; 2],
}

/// A number with the order of [`f64::total_cmp`].
#[derive(Clone, Copy, PartialEq)]
struct Ordered(f64);

impl Eq for Ordered {}

impl Ord for Ordered {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Ordered {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Tails {
    /// For at most so many places.
    pub(crate) fn of_at_most(places: usize) -> Self {
        let kept = dropped(places) + 1;
        Self { kept, places: 0, lowest: Default::default(), highest: Default::default() }
    }

    pub(crate) fn add(&mut self, place: [f64; 2]) {
        if !is_place(&place) {
            return;
        }
        self.places += 1;
        for (axis, value) in place.into_iter().map(Ordered).enumerate() {
            let (lowest, highest) = (&mut self.lowest[axis], &mut self.highest[axis]);
            lowest.push(value);
            highest.push(Reverse(value));
            if lowest.len() > self.kept {
                lowest.pop();
                highest.pop();
            }
        }
    }

    /// The bounds of what was added.
    pub(crate) fn bounds(self) -> Option<Bounds> {
        let at = dropped(self.places);
        let [x, y] = self.lowest.map(BinaryHeap::into_sorted_vec);
        let [high_x, high_y] = self.highest.map(BinaryHeap::into_sorted_vec);
        let of = |lowest: &[Ordered], highest: &[Reverse<Ordered>]| {
            Some([lowest.get(at)?.0, highest.get(at)?.0.0])
        };
        Some([of(&x, &high_x)?, of(&y, &high_y)?])
    }
}

/// How many of so many values are left out at each end.
fn dropped(values: usize) -> usize {
    (values.saturating_sub(1) as f64 * TAIL) as usize
}

fn bounds(places: impl Iterator<Item = [f64; 2]>, tail: f64) -> Option<Bounds> {
    let (mut xs, mut ys): (Vec<f64>, Vec<f64>) = places.filter(is_place).map(|[x, y]| (x, y)).unzip();
    Some([without_tails(&mut xs, tail)?, without_tails(&mut ys, tail)?])
}

fn without_tails(values: &mut [f64], tail: f64) -> Option<[f64; 2]> {
    let last = values.len().checked_sub(1)?;
    let dropped = (last as f64 * tail) as usize;
    let (_, low, _) = values.select_nth_unstable_by(dropped, f64::total_cmp);
    let low = *low;
    let (_, high, _) = values.select_nth_unstable_by(last - dropped, f64::total_cmp);
    Some([low, *high])
}

fn union(a: Option<Bounds>, b: Option<Bounds>) -> Option<Bounds> {
    let join = |[a_low, a_high]: [f64; 2], [b_low, b_high]: [f64; 2]| [a_low.min(b_low), a_high.max(b_high)];
    match (a, b) {
        (Some([ax, ay]), Some([bx, by])) => Some([join(ax, bx), join(ay, by)]),
        (one, other) => one.or(other),
    }
}

fn around(bounds: Option<Bounds>) -> Window {
    let Some(bounds) = bounds else {
        return Window { centre: [0.0; 2], half: [EMPTY_HALF; 2] };
    };
    let half = bounds.map(|[low, high]| ((high - low) / 2.0 * (1.0 + MARGIN)).max(LEAST_HALF));
    Window { centre: bounds.map(|[low, high]| low + (high - low) / 2.0), half }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid() -> impl Iterator<Item = [f64; 2]> {
        (0..=1000).map(|i| [f64::from(i), -f64::from(i) / 10.0])
    }

    #[test]
    fn the_farthest_are_left_out_and_what_is_kept_is_shown() {
        let window = Extent::Fit.window(grid(), &[]);
        assert_eq!(window.centre, [500.0, -50.0]);
        assert!((window.half[0] - 495.0 * 1.05).abs() < 1e-9);
        let window = Extent::Fit.window(grid(), &[[-505.0, 0.0]]);
        assert_eq!(window.centre[0], 245.0);
        assert!((window.half[0] - 750.0 * 1.05).abs() < 1e-9);
    }

    /// However many may come, and however many do.
    #[test]
    fn tails_are_left_out_the_same_with_little_in_memory() {
        let mut state = 7_u64;
        let mut chance = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / 1e3 - 8e3
        };
        for count in [0, 1, 2, 199, 200, 201, 202, 999, 5000] {
            let places: Vec<[f64; 2]> = (0..count)
                .map(|i| if i % 17 == 3 { [f64::NAN, 1.0] } else { [chance(), -chance()] })
                .collect();
            for more in [0, 1, 1000] {
                let mut tails = Tails::of_at_most(count + more);
                places.iter().for_each(|place| tails.add(*place));
                assert_eq!(tails.bounds(), bounds(places.iter().copied(), TAIL), "{count}");
            }
        }
    }

    #[test]
    fn nothing_one_and_no_places_at_all() {
        assert_eq!(Extent::Fit.window(std::iter::empty(), &[]).half, [EMPTY_HALF; 2]);
        let hollow = [[f64::NAN, 0.0], [0.0, f64::INFINITY], [1e300, 0.0]];
        assert_eq!(Extent::Fit.window(hollow.into_iter(), &hollow).half, [EMPTY_HALF; 2]);
        let one = Extent::Fit.window([[7.0, 8.0]].into_iter(), &[]);
        assert_eq!(one, Window { centre: [7.0, 8.0], half: [LEAST_HALF; 2] });
    }

    #[test]
    fn a_radius_is_around_what_is_kept() {
        let window = Extent::Radius(30.0).window(grid(), &[[10.0, 0.0], [20.0, 4.0]]);
        assert_eq!(window, Window { centre: [15.0, 2.0], half: [30.0; 2] });
        assert_eq!(Extent::Radius(30.0).window(grid(), &[]).centre, [500.0, -50.0]);
        for bad in [0.0, -1.0, 1e-30, 1e-6, 0.009, f64::NAN, f64::INFINITY] {
            assert!(Extent::Radius(bad).check().is_err(), "{bad}");
        }
        assert!(Extent::Radius(LEAST_RADIUS).check().is_ok() && Extent::Radius(FARTHEST).check().is_ok());
    }
}
