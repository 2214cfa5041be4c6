//! A recording as the settings correct it: mountings, clocks, units and signs of sensors, and where the vehicle's
//! motion comes from.
//!
//! Nothing is corrected that the settings don't name, with one exception: where a recording knows no motion at all,
//! it is taken from the radars' range rates, and this is warned of.

mod reader;
mod trajectory;

use crate::error::DataError;
use crate::read::corrections::{MotionSettings, MotionSource, SensorCorrection};
use crate::read::recording::{Recording, SequenceReader};
use nalgebra::Translation3;
use ralf::sensors::{Sequence, Source};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform};
use reader::Corrected;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// By sensor name.
pub(crate) type Corrections = BTreeMap<String, SensorCorrection>;

/// The recording with what the settings say of it. Refused: a name that no sensor has, a trajectory that is none, and a
/// sequence whose motion nobody knows.
pub(crate) fn corrected(
    recording: Recording,
    corrections: &Corrections,
    motion: &MotionSettings,
) -> Result<Recording, DataError> {
    let Recording { path, format, sequences } = recording;
    let mut read = Vec::with_capacity(sequences.len());
    for inner in sequences {
        let known = inner.sequence().motion.is_known();
        if known && corrections.is_empty() && *motion == MotionSettings::default() {
            read.push(inner);
            continue;
        }
        let sensors = with_sensors(inner, corrections, &path)?;
        read.push(Box::new(with_motion(sensors, motion, &path)?));
    }
    Ok(Recording { path, format, sequences: read })
}

fn unsuitable(path: &Path, sequence: &Sequence, reason: String) -> DataError {
    DataError::Unsuitable { file: path.to_owned(), place: format!("sequence {}", sequence.name), reason }
}

/// The sensors first, for a motion from range rates needs them as they are.
fn with_sensors(
    inner: Box<dyn SequenceReader>,
    corrections: &Corrections,
    path: &Path,
) -> Result<Corrected, DataError> {
    let mut sequence = inner.sequence().clone();
    for (name, correction) in corrections {
        correction.apply_to(&mut sequence, name).map_err(|reason| unsuitable(path, &sequence, reason))?;
    }
    Ok(Corrected::new(inner, sequence, corrections))
}

fn with_motion(mut reader: Corrected, wanted: &MotionSettings, path: &Path) -> Result<Corrected, DataError> {
    let sequence = reader.sequence();
    let from_radar = wanted.source == MotionSource::Radar || !sequence.motion.is_known();
    let (motion, source, file): (EgoMotion, MotionSource, Option<PathBuf>) = match &wanted.trajectory {
        Some(file) => {
            (trajectory::read(file, wanted, sequence)?, MotionSource::Trajectory, Some(file.clone()))
        }
        None if from_radar => {
            let found = ralf_check::doppler::from_doppler(&reader);
            let found = found.map_err(|error| {
                unsuitable(
                    path,
                    sequence,
                    format!("the vehicle's motion: {error}; a trajectory would do as well (--trajectory)"),
                )
            })?;
            (found, MotionSource::Radar, None)
        }
        None => (sequence.motion.clone(), MotionSource::Recorded, None),
    };
    if source == MotionSource::Radar && wanted.source != MotionSource::Radar {
        reader.warn(
            "neither odometry nor poses: the vehicle's motion is taken from the radars' range rates".into(),
        );
    }
    reader.set_motion(scaled(&motion, wanted), source, file);
    Ok(reader)
}

/// A motion with the factors and the offset of the settings.
fn scaled(motion: &EgoMotion, settings: &MotionSettings) -> EgoMotion {
    let shift = (settings.time_offset_ms * 1e6) as i64;
    let odometry = motion.odometry().iter().map(|sample| OdometrySample {
        t_ns: sample.t_ns.saturating_add(shift),
        velocity: sample.velocity * settings.speed_factor,
        yaw_rate: sample.yaw_rate * settings.yaw_rate_factor,
    });
    let place = |pose: &Transform| {
        Transform::from_parts(
            Translation3::from(pose.translation.vector * settings.speed_factor),
            pose.rotation,
        )
    };
    let poses = motion.poses().iter().map(|pose| PoseSample {
        t_ns: pose.t_ns.saturating_add(shift),
        odom_from_vehicle: place(&pose.odom_from_vehicle),
    });
    EgoMotion::new(odometry.collect(), poses.collect()).unwrap_or_else(|| motion.clone())
}
