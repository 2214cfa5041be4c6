//! When a radar's range rates go with the motion.

use crate::doppler::DopplerFigures;

/// Speeds within.
pub(super) const RATIO: std::ops::Range<f64> = 0.9..1.1;
/// A radar whose velocity is this share of the vehicle's or less has range rates without the vehicle's motion.
pub(super) const COMPENSATED: f64 = 0.2;
/// Directions within, degrees: good recordings stay below 1.2.
pub(super) const ANGLE_DEG: f64 = 1.5;
/// And a larger angle has to be so many standard errors.
const SIGMAS: f64 = 4.0;

/// Whether size and direction are as predicted.
pub(super) fn is_explained(figures: &DopplerFigures) -> bool {
    RATIO.contains(&figures.ratio.value) && is_aligned(figures)
}

/// Whether the direction is as predicted, or known too badly to say that it is not.
pub(super) fn is_aligned(figures: &DopplerFigures) -> bool {
    let angle = figures.angle.value.abs();
    angle.to_degrees() <= ANGLE_DEG || angle <= SIGMAS * figures.angle.error
}

/// For people.
pub(super) fn in_words(figures: &DopplerFigures) -> String {
    format!(
        "range rates of {} scans give {:.2} of the speed, {:+.1} degrees off its direction \
         ({:.0} % of the detections stand still)",
        figures.scans,
        figures.ratio.value,
        figures.angle.value.to_degrees(),
        figures.inliers * 100.0
    )
}
