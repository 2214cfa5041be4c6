//! Wheel odometry from the CAN bus expansion.

use super::raw::CanPoseRow;
use crate::error::DataError;
use crate::read::scene_tables::for_each_row;
use ralf::space::OdometrySample;
use std::path::{Path, PathBuf};

/// The scene's file, where the expansion is there.
pub(super) fn file(dataset: &Path, scene: &str) -> Option<PathBuf> {
    Some(dataset.join("can_bus").join(format!("{scene}_pose.json"))).filter(|file| file.is_file())
}

/// Velocity and yaw rate, in time order, one per time.
pub(super) fn read(file: &Path) -> Result<Vec<OdometrySample>, DataError> {
    let mut samples = Vec::new();
    for_each_row(file, |row: CanPoseRow| {
        let ([velocity, _, _], [_, _, yaw_rate]) = (row.vel, row.rotation_rate);
        samples.push(OdometrySample { t_ns: row.t_ns, velocity, yaw_rate });
        Ok(())
    })?;
    samples.sort_by_key(|sample| sample.t_ns);
    samples.dedup_by_key(|sample| sample.t_ns);
    Ok(samples)
}
