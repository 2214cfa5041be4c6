//! Where the lorry was and how its cab moved, by the tables' own times: no row tells which scene it is of.

use super::TELLING;
use crate::disk::files;
use crate::error::DataError;
use crate::read::rotation::relative_to_first;
use crate::read::scene_tables::{EgoPoseRow, SceneRecord, for_each_row, nanoseconds};
use ralf::space::{OdometrySample, PoseSample};
use serde::Deserialize;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The cab's motion; that of the chassis is in the table [`TELLING`].
const CABIN: &str = "ego_motion_cabin.json";
/// A scene's motion begins so long before its first measurement and goes on so long after its last, ns: LiDAR points
/// are measured around the times of their scans.
const MARGIN_NS: i64 = 500_000_000;
/// No lorry is faster, m/s.
const FASTEST: f64 = 100.0;
/// No two poses of it at one time are farther apart, m.
const APART: f64 = 1.0;

/// A row of either table of motion.
#[derive(Deserialize)]
struct MotionRow {
    #[serde(rename = "timestamp", deserialize_with = "nanoseconds")]
    t_ns: i64,
    /// Ahead, m/s.
    vx: f64,
    /// rad/s, positive to the left.
    yaw_rate: f64,
}

/// Speed and yaw rate of each scene.
pub(super) struct Motion {
    /// By the scene's name; in time order, one per time.
    pub(super) odometry: HashMap<String, Vec<OdometrySample>>,
    /// The table that they are from.
    pub(super) table: Option<PathBuf>,
}

impl Motion {
    /// Puts the poses into the scenes, and finds their speeds and yaw rates.
    pub(super) fn read(version: &Path, scenes: &mut [SceneRecord]) -> Result<Self, DataError> {
        let spans = Spans::new(scenes);
        for_each_row(&version.join("ego_pose.json"), |row: EgoPoseRow| {
            let pose = row.sample()?;
            spans.around(row.t_ns).for_each(|scene| scenes[scene].poses.push(pose));
            Ok(())
        })?;
        for scene in scenes.iter_mut() {
            scene.poses.sort_by_key(|pose| pose.t_ns);
            relative_to_first(&mut scene.poses);
        }
        spans.refuse_mixed(&version.join("ego_pose.json"), scenes)?;
        let mut samples: Vec<Vec<OdometrySample>> = vec![Vec::new(); scenes.len()];
        let table = table(version)?;
        if let Some(table) = &table {
            for_each_row(table, |row: MotionRow| {
                let MotionRow { t_ns, vx, yaw_rate } = row;
                let sample = OdometrySample { t_ns, velocity: vx, yaw_rate };
                spans.around(t_ns).for_each(|scene| samples[scene].push(sample));
                Ok(())
            })?;
        }
        for samples in &mut samples {
            samples.sort_by_key(|sample| sample.t_ns);
            samples.dedup_by_key(|sample| sample.t_ns);
        }
        let names = scenes.iter().map(|scene| scene.name.clone());
        Ok(Self { odometry: names.zip(samples).collect(), table })
    }
}

/// The cab's table, else that of the chassis.
fn table(version: &Path) -> Result<Option<PathBuf>, DataError> {
    for name in [CABIN, TELLING] {
        let table = version.join(name);
        if files::exists(&table)? {
            return Ok(Some(table));
        }
    }
    Ok(None)
}

/// How far it is from a pose to the next, m, where one vehicle can't have gone.
fn leap(poses: &[PoseSample]) -> Option<f64> {
    let steps = poses.windows(2).map(|pair| {
        let [from, to] = [&pair[0], &pair[1]].map(|pose| pose.odom_from_vehicle.translation.vector);
        ((to - from).norm(), (pair[1].t_ns - pair[0].t_ns) as f64 * 1e-9)
    });
    let mut far = steps.filter(|(metres, seconds)| *metres > FASTEST * seconds + APART);
    far.next().map(|(metres, _)| metres)
}

/// When scenes were, by their begins.
struct Spans {
    /// Begin, end and scene.
    spans: Vec<(i64, i64, usize)>,
    longest: i64,
}

impl Spans {
    fn new(scenes: &[SceneRecord]) -> Self {
        let span = |(scene, record): (usize, &SceneRecord)| {
            let [begin, end] = record.span()?;
            Some((begin.saturating_sub(MARGIN_NS), end.saturating_add(MARGIN_NS), scene))
        };
        let mut spans: Vec<_> = scenes.iter().enumerate().filter_map(span).collect();
        spans.sort_unstable();
        let longest =
            spans.iter().map(|(begin, end, _)| end.saturating_sub(*begin)).max().unwrap_or_default();
        Self { spans, longest }
    }

    /// Refuses two scenes that were at the same time if their poses are not of one drive: no row tells which scene it
    /// is of, and each scene has taken those of the other.
    fn refuse_mixed(&self, file: &Path, scenes: &[SceneRecord]) -> Result<(), DataError> {
        let mut last: Option<&(i64, i64, usize)> = None;
        for span in &self.spans {
            if let Some(before) = last.filter(|before| span.0 <= before.1) {
                let both = [before, span].map(|(_, _, scene)| &scenes[*scene]);
                if let Some(metres) = both.iter().find_map(|scene| leap(&scene.poses)) {
                    let told = |(begin, end, scene): &(i64, i64, usize)| {
                        let [begin, end] = [begin.saturating_add(MARGIN_NS), end.saturating_sub(MARGIN_NS)];
                        format!("`{}` from {begin} to {end} ns", scenes[*scene].name)
                    };
                    let found = format!("{} and {}, and poses {metres:.0} m apart", told(before), told(span));
                    let expected = "scenes more than a second apart, or poses of one drive";
                    return Err(DataError::content(file, "timestamp", expected, found));
                }
            }
            last = last.filter(|before| before.1 > span.1).or(Some(span));
        }
        Ok(())
    }

    /// The scenes that a time lies in.
    fn around(&self, t_ns: i64) -> impl Iterator<Item = usize> {
        let after = self.spans.partition_point(|(begin, _, _)| *begin <= t_ns);
        let earliest = t_ns.saturating_sub(self.longest);
        let near = self.spans[..after].iter().rev().take_while(move |(begin, _, _)| *begin >= earliest);
        near.filter(move |(_, end, _)| t_ns <= *end).map(|(_, _, scene)| *scene)
    }
}
