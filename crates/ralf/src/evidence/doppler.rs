//! What the range rate says: does the detection stand still with the world, do those around it move with it, and does
//! it go where its range rate says it goes?

use super::columns::{set, unobserved};
use super::meeting::Meeting;
use super::rates::Rates;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::median;

pub(super) const PIECE: Piece = Piece {
    features: &[
        feature(
            "doppler_residual",
            "sigma",
            "compensated range rate, in units of the scan's own spread: how surely the detection doesn't stand still",
        ),
        feature(
            "doppler_agreeing_share",
            "1",
            "share of the scan's other detections within 1.5 m, seen from above, whose compensated range rate agrees",
        ),
        feature(
            "doppler_agreeing",
            "1",
            "how many of the scan's other detections within 1.5 m, seen from above, have an agreeing range rate",
        ),
        feature(
            "doppler_track_residual",
            "sigma",
            "difference of range rates from the radar's detections that lie where this one should be in its scans \
             around, moved along the ray or along the vehicle's course if it moves; the least of each scan, of which \
             the median",
        ),
    ],
    observe,
};

/// Detections of one object lie at most so far apart, m.
const NEAR: f64 = 1.5;

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Doppler", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let detections = surroundings.frame.scan.detections.as_slice();
    let mut columns = unobserved(PIECE.features, detections.len());
    let Some(rates) = surroundings.rates() else {
        return columns;
    };
    let mut near = Vec::new();
    for (i, detection) in detections.iter().enumerate() {
        let residual = rates.residual(i).filter(|_| detection.is_some());
        let agreement = detection.as_ref().map(|detection| {
            surroundings.beside(detection, NEAR, &mut near);
            Agreement::new(rates, i, &near)
        });
        let agreement = agreement.filter(|_| residual.is_some());
        let values = [
            residual,
            agreement.and_then(|agreement| agreement.share()),
            agreement.map(|agreement| agreement.agreeing as f64),
            track_residual(&surroundings.recurrences()[i].met),
        ];
        set(&mut columns, i, values);
    }
    columns
}

/// How many of the detections near another have a range rate that agrees with its own.
#[derive(Debug, Clone, Copy)]
struct Agreement {
    agreeing: usize,
    /// How many have a range rate at all.
    measured: usize,
}

impl Agreement {
    /// `near` are detections of the same scan, itself perhaps among them.
    fn new(rates: &Rates, i: usize, near: &[u32]) -> Self {
        let others = near.iter().map(|other| *other as usize).filter(|other| *other != i);
        let mut agreement = Self { agreeing: 0, measured: 0 };
        for agrees in others.filter_map(|other| rates.agrees(i, rates.values[other])) {
            agreement.agreeing += usize::from(agrees);
            agreement.measured += 1;
        }
        agreement
    }

    fn share(self) -> Option<f64> {
        (self.measured > 0).then(|| self.agreeing as f64 / self.measured as f64)
    }
}

/// The median over the scans in which anything lies where the detection should be.
fn track_residual(met: &[Meeting]) -> Option<f64> {
    median(met.iter().map(|meeting| meeting.rate_difference).filter(|found| found.is_finite()).collect())
}
