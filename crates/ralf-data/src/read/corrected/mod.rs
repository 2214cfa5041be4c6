//! A recording as the settings correct it: mountings, clocks, units and signs of sensors, and where the vehicle's motion comes from.
//!
//! Nothing is corrected that the settings don't name, with one exception: where a recording knows no motion at all, it is taken
//! from the radars' range rates, and this is warned of.

mod reader;
mod settings;
mod trajectory;

pub use settings::{MotionSettings, MotionSource, SensorCorrection};

use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use crate::settings::Settings;
use nalgebra::Translation3;
use ralf::sensors::{Sequence, Source};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform};
use reader::Corrected;
use std::path::PathBuf;

/// The recording with what the settings say of it. Refused: a name that no sensor has, a trajectory that is none, and a sequence whose motion
/// nobody knows.
pub(crate) fn corrected(recording: Recording, settings: &Settings) -> Result<Recording, DataError> {
    let Recording { path, format, sequences } = recording;
    let one = |inner: Box<dyn SequenceReader>| {
        let known = inner.sequence().motion.is_known();
        if known && settings.corrections.is_empty() && settings.motion == MotionSettings::default() {
            return Ok(inner);
        }
        let corrected = with_motion(with_sensors(inner, settings, &path)?, settings, &path)?;
        Ok(Box::new(corrected) as Box<dyn SequenceReader>)
    };
    let sequences = sequences.into_iter().map(one).collect::<Result<Vec<_>, DataError>>()?;
    Ok(Recording { path, format, sequences })
}

fn unsuitable(path: &std::path::Path, sequence: &Sequence, reason: String) -> DataError {
    DataError::Unsuitable { file: path.to_owned(), place: format!("sequence {}", sequence.name), reason }
}

/// The sensors first, for a motion from range rates needs them as they are.
fn with_sensors(
    inner: Box<dyn SequenceReader>,
    settings: &Settings,
    path: &std::path::Path,
) -> Result<Corrected, DataError> {
    let mut sequence = inner.sequence().clone();
    for (name, correction) in &settings.corrections {
        correction.apply_to(&mut sequence, name).map_err(|reason| unsuitable(path, &sequence, reason))?;
    }
    Ok(Corrected::new(inner, sequence, &settings.corrections))
}

fn with_motion(
    mut reader: Corrected,
    settings: &Settings,
    path: &std::path::Path,
) -> Result<Corrected, DataError> {
    let wanted = &settings.motion;
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
