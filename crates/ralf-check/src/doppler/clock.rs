//! By how much a radar's clock is off against the motion's: where the curves of speed fall upon each other.

use super::{DopplerFigures, Timed, predicted};
use crate::statistics::paired_sigmas;
use nalgebra::Rotation2;
use ralf::space::EgoMotion;
use ralf::space::Transform;

/// Offsets that are tried, ms.
const WIDEST_MS: i64 = 500;
const STEP_MS: i64 = 20;
/// What a single scan can add, m/s: an outlier counts no more than this.
const CAP: f64 = 1.0;
/// A minimum is sharp when its surroundings are so many standard errors worse.
const SHARP: f64 = 3.0;

/// What offset fits best.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct ClockFigures {
    /// To be added to the radar's timestamps, ms.
    pub(crate) offset_ms: f64,
    /// Mean distance of the velocities as given and with this offset, m/s.
    pub(crate) now: f64,
    pub(crate) then: f64,
    /// The gain in its standard errors.
    pub(crate) sigmas: f64,
    /// Whether offsets 100 ms from it are clearly worse, so that a small offset says that the clock is right.
    pub(crate) is_sharp: bool,
}

/// Minimises the mean of `|v_est(t) - v_pred(t + tau)|` over tau. A constant factor and a constant angle between the
/// two are taken out first, for they are no matter of time. `None` of fewer than ten scans.
pub(crate) fn clock(
    fits: &[Timed],
    motion: &EgoMotion,
    mount: &Transform,
    figures: &DopplerFigures,
) -> Option<ClockFigures> {
    if fits.len() < 10 || !figures.angle.error.is_finite() || figures.ratio.value < 1e-3 {
        return None;
    }
    let back = Rotation2::new(-figures.angle.value);
    let misfits = |offset_ms: i64| -> Vec<f64> {
        let shift = offset_ms * 1_000_000;
        let misfit = |timed: &Timed| {
            let found = back * timed.fit.velocity / figures.ratio.value;
            (found - predicted(motion, mount, timed.t_ns.saturating_add(shift))).norm().min(CAP)
        };
        fits.iter().map(misfit).collect()
    };
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let tried: Vec<i64> = (-WIDEST_MS / STEP_MS..=WIDEST_MS / STEP_MS).map(|i| i * STEP_MS).collect();
    let costs: Vec<f64> = tried.iter().map(|offset| mean(&misfits(*offset))).collect();
    let best = (0..tried.len()).min_by(|a, b| costs[*a].total_cmp(&costs[*b]))?;
    let (now, then) = (misfits(0), misfits(tried[best]));
    let gain = |worse: &[f64]| -> Vec<f64> { worse.iter().zip(&then).map(|(a, b)| a - b).collect() };
    let is_worse = |offset: i64| paired_sigmas(&gain(&misfits(offset))) > SHARP;
    Some(ClockFigures {
        offset_ms: tried[best] as f64 + vertex(&costs, best) * STEP_MS as f64,
        now: mean(&now),
        then: costs[best],
        sigmas: paired_sigmas(&gain(&now)),
        is_sharp: [-100, 100].into_iter().all(|side| is_worse(tried[best] + side)),
    })
}

/// Where the parabola through the lowest cost and its neighbours has its vertex, in steps from the lowest.
fn vertex(costs: &[f64], best: usize) -> f64 {
    if best == 0 || best + 1 >= costs.len() {
        return 0.0;
    }
    let [before, lowest, after] = [costs[best - 1], costs[best], costs[best + 1]];
    let bend = before - 2.0 * lowest + after;
    if bend > 1e-12 { ((before - after) / (2.0 * bend)).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::compare::tests::{driving, seen};
    use super::super::{Timed, compare, predicted};
    use super::*;

    const MS: i64 = 1_000_000;

    /// A speed that swings by 1 m/s in 7 s.
    fn swinging() -> EgoMotion {
        driving((0..500).map(|i| (i * 20 * MS, 8.0 + (i as f64 * 0.02 * 0.9).sin(), 0.0)))
    }

    #[test]
    fn a_stamp_that_comes_late_is_told_by_how_much() {
        let (motion, mount) = (swinging(), Transform::identity());
        // Measured at t, stamped 180 ms later.
        let fits: Vec<Timed> = (10..90)
            .map(|i| i * 100 * MS)
            .map(|t| seen(t + 180 * MS, predicted(&motion, &mount, t)))
            .collect();
        let figures = compare(&fits, &motion, &mount).unwrap();
        let found = clock(&fits, &motion, &mount, &figures).unwrap();
        assert!((found.offset_ms + 180.0).abs() < 15.0, "{found:?}");
        assert!(found.sigmas > 4.0 && found.then < 0.3 * found.now, "{found:?}");
    }

    #[test]
    fn a_constant_speed_tells_nothing_of_time() {
        let (motion, mount) = (driving([(0, 8.0, 0.0)].into_iter()), Transform::identity());
        let fits: Vec<Timed> = (0..50).map(|t| seen(t * 100 * MS, predicted(&motion, &mount, 0))).collect();
        let figures = compare(&fits, &motion, &mount).unwrap();
        let found = clock(&fits, &motion, &mount, &figures).unwrap();
        assert!(found.sigmas < 1.0, "{found:?}");
    }
}
