//! Settings of readers that change nothing of a recording are refused: who writes them means something by them.

use crate::error::DataError;
use crate::read::corrected::Corrections;
use crate::read::{MotionSettings, Recording, SensorCorrection};
use std::path::Path;

/// Refuses what says something of what isn't there: of a trajectory, or of the ticks of a clock.
pub(crate) fn refuse_alone(
    recording: &Path,
    corrections: &Corrections,
    motion: &MotionSettings,
) -> Result<(), DataError> {
    let refused = |key: String, expected| Err(DataError::content(recording, key, expected, "none"));
    if motion.trajectory.is_none() {
        let frame = motion.trajectory_frame.as_ref().filter(|name| *name != "vehicle");
        for (key, given) in
            [("trajectory_frame", frame), ("trajectory_order", motion.trajectory_order.as_ref())]
        {
            if given.is_some() {
                let expected = "a trajectory that it tells of (--trajectory, motion.trajectory)";
                return refused(format!("motion.{key}"), expected);
            }
        }
    }
    let is_alone = |c: &SensorCorrection| c.tick_ms != 0.0 && c.period_ms <= 0.0;
    match corrections.iter().find(|(_, correction)| is_alone(correction)) {
        Some((name, _)) => refused(format!("corrections.{name}.tick_ms"), "a period_ms above 0 beside it"),
        None => Ok(()),
    }
}

/// Refuses a factor of yaw rates where no sequence has any. Of several it may be meant for some.
pub(crate) fn refuse_yaw_rate_factor(
    recording: &Recording,
    motion: &MotionSettings,
) -> Result<(), DataError> {
    let mut motions = recording.sequences.iter().map(|reader| &reader.sequence().motion);
    let has_none = motions.all(|motion| motion.odometry().is_empty());
    if motion.yaw_rate_factor == 1.0 || !has_none {
        return Ok(());
    }
    let expected = "a motion with yaw rates";
    Err(DataError::content(&recording.path, "motion.yaw_rate_factor", expected, "poses alone"))
}
