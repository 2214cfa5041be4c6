//! A recording as the settings correct it: mountings, clocks, units, signs and models of sensors, and where the
//! vehicle's motion comes from.
//!
//! Nothing is corrected that the settings don't name, with one exception: where a recording knows no motion at all,
//! it is taken from the radars' range rates, else from a LiDAR's scans, and this is warned of.

mod reader;
mod trajectory;

use crate::error::DataError;
use crate::read::corrections::{Altered, MotionSettings, MotionSource, SensorCorrection};
use crate::read::opened::Opened;
use crate::read::recording::{Recording, SequenceReader};
use nalgebra::Translation3;
use ralf::config::Config;
use ralf::sensors::{Sequence, Source, SourceError};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform};
use ralf_check::doppler::from_doppler;
use ralf_check::odometry::from_lidar;
use reader::Corrected;
use std::collections::BTreeMap;
use std::path::Path;

/// By sensor name.
pub(crate) type Corrections = BTreeMap<String, SensorCorrection>;

/// The recording with what the settings say of the sequences concerned; of the method's settings those of the sensors.
/// Refused: a name that no sensor has, and a trajectory that is none or of more than one sequence. A sequence that was
/// not asked for, and whose motion neither a file nor the sensors tell, is left out; if none is left, it is refused.
pub(crate) fn corrected(
    recording: Recording,
    method: &Config,
    corrections: &Corrections,
    motion: &MotionSettings,
    is_concerned: &dyn Fn(&str) -> bool,
) -> Result<Recording, DataError> {
    let Recording { path, format, sequences, incomplete, is_selected } = recording;
    let count = sequences.iter().filter(|reader| is_concerned(&reader.sequence().name)).count();
    let mut read = Opened { sequences: Vec::with_capacity(sequences.len()), incomplete };
    let as_recorded =
        method.sensors.is_empty() && corrections.is_empty() && *motion == MotionSettings::default();
    for inner in sequences {
        let Sequence { name, motion: known, .. } = inner.sequence();
        if !is_concerned(name) || as_recorded && known.is_known() {
            read.sequences.push(inner);
            continue;
        }
        let (name, may_be_lost) = (name.clone(), !is_selected && is_seen(motion, known));
        let sensors = with_sensors(inner, method, corrections, &path)?;
        let own = motion_of(motion, &sensors.sequence().name, count)?;
        match with_motion(sensors, &own, &path) {
            Ok(reader) => read.sequences.push(Box::new(reader)),
            Err(error) if may_be_lost => read.lose(name, error),
            Err(error) => return Err(error),
        }
    }
    let Opened { sequences, incomplete } = read.or_first_error()?;
    Ok(Recording { path, format, sequences, incomplete, is_selected })
}

/// Whether nothing but the sensors tells a motion: neither the recording nor what the settings name.
fn is_seen(wanted: &MotionSettings, known: &EgoMotion) -> bool {
    wanted.trajectory.is_none() && wanted.source == MotionSource::Recorded && !known.is_known()
}

/// What the settings say of the motion of one of so many sequences: of a folder of trajectories its own.
fn motion_of(wanted: &MotionSettings, sequence: &str, sequences: usize) -> Result<MotionSettings, DataError> {
    let place = wanted.trajectory.as_deref();
    let trajectory = place.map(|place| trajectory::file_of(place, sequence, sequences)).transpose()?;
    Ok(MotionSettings { trajectory, ..wanted.clone() })
}

fn unsuitable(path: &Path, sequence: &Sequence, reason: String) -> DataError {
    DataError::Unsuitable { file: path.to_owned(), place: format!("sequence {}", sequence.name), reason }
}

/// The sensors first, for a motion from range rates needs them as they are.
fn with_sensors(
    inner: Box<dyn SequenceReader>,
    method: &Config,
    corrections: &Corrections,
    path: &Path,
) -> Result<Corrected, DataError> {
    let mut sequence = inner.sequence().clone();
    let replaced = method.apply_to(&mut sequence.rig, inner.absent());
    replaced.map_err(|error| unsuitable(path, &sequence, error.to_string()))?;
    let is_there = |name: &String| !inner.absent().contains(name);
    let mut altered = match method.sensors.keys().any(is_there) {
        true => Altered::Models,
        false => Altered::Nothing,
    };
    for (name, correction) in corrections.iter().filter(|(name, _)| is_there(name)) {
        correction.apply_to(&mut sequence, name).map_err(|reason| unsuitable(path, &sequence, reason))?;
        if *correction != SensorCorrection::default() {
            altered = Altered::Measurements;
        }
    }
    let mut reader = Corrected::new(inner, sequence, corrections);
    reader.alter(altered);
    Ok(reader)
}

fn with_motion(mut reader: Corrected, wanted: &MotionSettings, path: &Path) -> Result<Corrected, DataError> {
    // A motion that the settings don't name, and the sensors see, takes the place of none.
    if *wanted != MotionSettings::default() {
        reader.alter(Altered::Measurements);
    }
    if let Some(file) = &wanted.trajectory {
        let motion = trajectory::read(file, wanted, reader.sequence())?;
        reader.set_motion(scaled(&motion, wanted), MotionSource::Trajectory, Some(file.clone()));
        reader.motion_was_named();
        return Ok(reader);
    }
    let is_known = reader.sequence().motion.is_known();
    let found = match wanted.source {
        MotionSource::Radar => from_doppler(&reader).map(|motion| (motion, MotionSource::Radar)),
        MotionSource::Lidar => from_lidar(&reader).map(|motion| (motion, MotionSource::Lidar)),
        MotionSource::Trajectory => Err("motion.source = \"trajectory\" without a file of poses".into()),
        MotionSource::Recorded if is_known => Ok((reader.sequence().motion.clone(), MotionSource::Recorded)),
        MotionSource::Recorded => seen(&reader),
    };
    let (motion, source) = found.map_err(|error| {
        let reason = format!("the vehicle's motion: {error}; a trajectory would do as well (--trajectory)");
        unsuitable(path, reader.sequence(), reason)
    })?;
    let from = match source {
        MotionSource::Radar => "the radars' range rates",
        _ => "the LiDAR's scans",
    };
    if wanted.source == source {
        reader.motion_was_named();
    } else if source != MotionSource::Recorded {
        reader.warn(format!("neither odometry nor poses: the vehicle's motion is taken from {from}"));
    }
    reader.set_motion(scaled(&motion, wanted), source, None);
    Ok(reader)
}

/// The motion as the sensors see it: by range rates, or, where these say nothing, by a LiDAR.
fn seen(source: &dyn Source) -> Result<(EgoMotion, MotionSource), SourceError> {
    let by_doppler = match from_doppler(source) {
        Ok(motion) => return Ok((motion, MotionSource::Radar)),
        Err(missing) => missing,
    };
    from_lidar(source)
        .map(|motion| (motion, MotionSource::Lidar))
        .map_err(|missing| format!("{by_doppler}; {missing}").into())
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
