//! What a recording holds, how regularly, and what is missing: from its times, and by reading its scans once.

mod clocks;
mod held;
mod path;
mod readable;

use crate::read::SequenceReader;
use crate::read::corrections::MotionSource;
pub use held::held_motion;
use path::Path;
pub use readable::Unreadable;

use ralf::config::{Config, nanoseconds};
use ralf::sensors::{Camera, Sequence};
use ralf::space::{EgoMotion, sync};
use serde::Serialize;

/// A time between two measurements that is this many times the usual one is a gap.
const GAP: i64 = 3;

/// What one sequence holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inspection {
    /// The sequence's name.
    pub name: String,
    /// Its title, for people.
    pub title: String,
    /// From the first radar scan to the last, s.
    pub seconds: f64,
    /// Length of the vehicle's path between these, m, as far as its motion is known.
    pub path_m: f64,
    /// How long the motion isn't known between these, for odometry and poses pause or lie within a shorter time, s.
    pub motion_unknown_s: f64,
    /// Samples of wheel odometry.
    pub odometry_samples: usize,
    /// 6-DoF poses; where there are some, they are used.
    pub poses: usize,
    /// Radars, LiDARs, cameras.
    pub sensors: Vec<SensorInspection>,
    /// What the labeler will miss, a sentence each.
    pub missing: Vec<String>,
    /// Scans that can't be read; empty as long as none was tried.
    pub unreadable: Vec<Unreadable>,
}

/// What one sensor delivers.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SensorInspection {
    /// `radar`, `lidar` or `camera`.
    pub kind: &'static str,
    /// Its name.
    pub name: String,
    /// Scans or images.
    pub count: usize,
    /// How often it delivers, by the median time between two of them, Hz.
    pub rate_hz: Option<f64>,
    /// How far the middle half of these times lies apart, ms.
    pub jitter_ms: Option<f64>,
    /// Times without any that are at least three times the usual.
    pub gaps: Vec<Gap>,
    /// Time to the nearest LiDAR scan: median, ms. Of radars and cameras.
    pub lidar_offset_ms: Option<f64>,
    /// Scans or images with a LiDAR scan within the tolerance.
    pub with_lidar: usize,
}

/// A time without measurements.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Gap {
    /// Number of the measurement before.
    pub after: usize,
    /// Its length, ms.
    pub ms: f64,
}

impl Inspection {
    /// Looks at a sequence; tolerances are those of the settings.
    pub fn new(reader: &dyn SequenceReader, config: &Config) -> Self {
        let sequence = reader.sequence();
        let all_scans = sequence.times.radars.iter().flatten();
        let span = all_scans.clone().min().zip(all_scans.max());
        let sensors = sensors(sequence, config);
        let (first, last) = span.map_or((0, 0), |(first, last)| (*first, *last));
        let path = Path::new(&sequence.motion, [first, last]);
        Self {
            name: sequence.name.clone(),
            title: sequence.title.clone(),
            seconds: last.abs_diff(first) as f64 * 1e-9,
            path_m: path.metres,
            motion_unknown_s: path.unknown_s,
            odometry_samples: told(reader).odometry().len(),
            poses: told(reader).poses().len(),
            missing: [
                missing(reader, &sensors, config),
                path.missing(),
                held_motion(sequence).into_iter().collect(),
                clocks::strange(sequence),
            ]
            .concat(),
            sensors,
            unreadable: Vec::new(),
        }
    }

    /// Reads every radar and LiDAR scan once, side by side in so many threads, and names those that can't be read.
    /// `progress` is told of each that is done.
    pub fn try_scans(&mut self, reader: &dyn SequenceReader, jobs: usize, progress: &(dyn Fn() + Sync)) {
        self.unreadable = readable::unreadable_scans(reader, jobs, progress);
    }
}

fn sensors(sequence: &Sequence, config: &Config) -> Vec<SensorInspection> {
    let times = &sequence.times;
    let look = |kind, name: &String, own: &Vec<i64>| sensor(kind, name, own, &times.lidars, config);
    let radars =
        sequence.rig.radars.iter().zip(&times.radars).map(|(radar, own)| look("radar", &radar.name, own));
    let lidars =
        sequence.rig.lidars.iter().zip(&times.lidars).map(|(lidar, own)| look("lidar", &lidar.name, own));
    let cameras = sequence
        .rig
        .cameras
        .iter()
        .zip(&times.cameras)
        .map(|(camera, own)| look("camera", &camera.name, own));
    radars.chain(lidars).chain(cameras).collect()
}

fn sensor(
    kind: &'static str,
    name: &str,
    times: &[i64],
    lidars: &[Vec<i64>],
    config: &Config,
) -> SensorInspection {
    let steps: Vec<i64> = times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
    let usual = quantile(&steps, 0.5);
    let is_gap = |step: i64| usual.is_some_and(|usual| step > usual.max(1).saturating_mul(GAP));
    let gaps = steps.iter().enumerate().filter(|(_, step)| is_gap(**step));
    let others = lidars.iter().filter(|_| kind != "lidar");
    let offset = |t: &i64| others.clone().filter_map(|lidar| offset_to_nearest(lidar, *t)).min();
    let offsets: Vec<i64> = times.iter().filter_map(offset).collect();
    let tolerance = nanoseconds(config.sync.lidar_tolerance_ms);
    SensorInspection {
        kind,
        name: name.to_owned(),
        count: times.len(),
        rate_hz: usual.filter(|usual| *usual > 0).map(|usual| 1e9 / usual as f64),
        jitter_ms: quantile(&steps, 0.75).zip(quantile(&steps, 0.25)).map(|(high, low)| ms(high - low)),
        gaps: gaps.map(|(after, step)| Gap { after, ms: ms(*step) }).collect(),
        lidar_offset_ms: quantile(&offsets, 0.5).map(ms),
        with_lidar: offsets.iter().filter(|offset| **offset <= tolerance).count(),
    }
}

fn missing(reader: &dyn SequenceReader, sensors: &[SensorInspection], config: &Config) -> Vec<String> {
    let mut missing = Vec::new();
    let mut say = |applies: bool, text: String| {
        if applies {
            missing.push(text);
        }
    };
    let sequence = reader.sequence();
    let (rig, times) = (&sequence.rig, &sequence.times);
    say(rig.lidars.is_empty(), "no LiDAR: no LiDAR matching, and no scale for depth images".into());
    say(rig.cameras.is_empty(), "no camera: nothing looks into the LiDAR's blind spot".into());
    for (camera, Camera { name, .. }) in rig.cameras.iter().enumerate() {
        say(
            !times.cameras[camera].is_empty() && !reader.has_depth(camera),
            format!(
                "{name}: no depth images, so nothing is matched with it: `ralf label --depth-model` or \
                 `ralf depth` makes them (where ralf is built with the feature `depth`)"
            ),
        );
    }
    if let Some(text) = motion(reader) {
        say(true, text.into());
    }
    for SensorInspection { name, count, with_lidar, .. } in
        sensors.iter().filter(|sensor| sensor.kind == "radar")
    {
        let without = count - with_lidar;
        let tolerance = config.sync.lidar_tolerance_ms;
        say(
            without > 0 && !rig.lidars.is_empty(),
            format!("{name}: {without} of {count} scans have no LiDAR scan within {tolerance} ms"),
        );
    }
    let names = rig.lidars.iter().map(|lidar| &lidar.name).zip(&times.lidars);
    let names = names.chain(rig.cameras.iter().map(|camera| &camera.name).zip(&times.cameras));
    for (name, own) in names.chain(rig.radars.iter().map(|radar| &radar.name).zip(&times.radars)) {
        say(own.is_empty(), format!("{name}: nothing recorded"));
    }
    missing
}

/// Where the motion comes from, if not from poses.
fn motion(reader: &dyn SequenceReader) -> Option<&'static str> {
    let motion = &reader.sequence().motion;
    match reader.motion_source() {
        MotionSource::Radar => Some("the motion is taken from the radars' range rates"),
        MotionSource::Lidar => Some("the motion is taken from a LiDAR's scans"),
        _ if !motion.poses().is_empty() => None,
        _ if motion.odometry().is_empty() => Some("neither 6-DoF poses nor odometry: the motion isn't known"),
        _ => Some("no 6-DoF poses: the motion is integrated from wheel odometry"),
    }
}

/// The motion that was recorded, or a trajectory tells, and not the one that the sensors were asked for.
fn told(reader: &dyn SequenceReader) -> &EgoMotion {
    match (reader.motion_source(), reader.inner()) {
        (MotionSource::Radar | MotionSource::Lidar, Some(inner)) => told(inner),
        _ => &reader.sequence().motion,
    }
}

fn offset_to_nearest(times: &[i64], t_ns: i64) -> Option<i64> {
    let nearest = sync::nearest(times, t_ns, i64::MAX)?;
    i64::try_from(times[nearest].abs_diff(t_ns)).ok()
}

/// The value below which this share of them lies, the nearest of few; `None` of none.
fn quantile(values: &[i64], share: f64) -> Option<i64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted.get(((sorted.len() as f64 - 1.0).max(0.0) * share).round() as usize).copied()
}

fn ms(ns: i64) -> f64 {
    ns as f64 * 1e-6
}
