//! Where the vehicle was.

use super::calibration::vehicle_from_ego;
use crate::disk::json;
use crate::error::DataError;
use crate::read::rotation::{Matrix, relative_to_first, rigid};
use ralf::space::{EgoMotion, PoseSample};
use ralf_files::Kind;
use serde::Deserialize;
use std::path::Path;

/// What is read of the file.
#[derive(Deserialize)]
struct MotionFile {
    /// Ego to the place where the sequence began.
    poses: Vec<Matrix>,
    /// s of Unix.
    timestamps: Vec<f64>,
}

/// The poses of the vehicle frame, relative to the first.
pub(super) fn read(file: &Path) -> Result<EgoMotion, DataError> {
    let MotionFile { poses, timestamps } = json::read(file, Kind::Table, "poses and their timestamps")?;
    if poses.len() != timestamps.len() {
        let expected = format!("{}, one per pose", poses.len());
        return Err(DataError::content(file, "timestamps", expected, timestamps.len().to_string()));
    }
    let ego_from_vehicle = vehicle_from_ego().inverse();
    let mut samples: Vec<PoseSample> = Vec::with_capacity(poses.len());
    for (n, (pose, seconds)) in poses.iter().zip(&timestamps).enumerate() {
        let t_ns = (seconds * 1e9).round() as i64;
        if samples.last().is_some_and(|before| t_ns <= before.t_ns) || !seconds.is_finite() {
            let expected = "a time after the one before";
            return Err(DataError::content(file, format!("timestamps, {n}"), expected, seconds.to_string()));
        }
        let odom_from_vehicle = rigid(file, &format!("poses, {n}"), pose)? * ego_from_vehicle;
        samples.push(PoseSample { t_ns, odom_from_vehicle });
    }
    relative_to_first(&mut samples);
    EgoMotion::new(Vec::new(), samples)
        .ok_or_else(|| DataError::content(file, "poses", "at least one", "none"))
}
