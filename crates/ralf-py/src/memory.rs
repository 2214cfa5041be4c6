//! A sequence of arrays, without files.

use crate::arrays::{depth, image, numbers, rows};
use crate::errors::{data, other};
use crate::labelling::{ToldJob, from_json, threads, to_json};
use crate::table::Table;
use crate::watch::watched;
use pyo3::prelude::*;
use ralf::sensors::{LidarScan, MemorySource, TimedImage};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform, transform_from_parts};
use ralf_data::many::model_of;
use ralf_data::read::rig_from_json;
use ralf_data::result::{RadarScanKey, Table as ResultTable};
use ralf_data::run::{CameraRecord, CheckRecord, InMemory, SequenceRecord, UnreadableScan, check_all};
use ralf_data::{Recording, write_sequence};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Where the vehicle is: metres, and a quaternion in the order x, y, z, w.
#[derive(Deserialize)]
struct Pose {
    translation: [f64; 3],
    quaternion_xyzw: [f64; 4],
}

impl Pose {
    fn transform(&self) -> PyResult<Transform> {
        let Self { translation, quaternion_xyzw } = self;
        transform_from_parts(*translation, *quaternion_xyzw).ok_or_else(|| {
            other(format!(
                "expected finite numbers and a rotation, found {translation:?}, {quaternion_xyzw:?}"
            ))
        })
    }
}

/// The vehicle's motion, as the Python package tells of it.
#[derive(Deserialize)]
struct MotionTold {
    /// Time (ns), velocity (m/s), yaw rate (rad/s).
    odometry: Vec<(i64, f64, f64)>,
    /// Time (ns) and pose in a fixed frame.
    poses: Vec<(i64, Pose)>,
}

/// Scans of a radar: a time (ns), and an array per field.
type RadarScans<'py> = Vec<(i64, Vec<Bound<'py, PyAny>>)>;
/// Scans of a LiDAR: a time (ns), points, intensities, and times of the points where they are known.
type LidarScans<'py> = Vec<(i64, Bound<'py, PyAny>, Bound<'py, PyAny>, Option<Bound<'py, PyAny>>)>;
/// Images of a camera: a time (ns), pixels, and depth of each view where it is known.
type Images<'py> = Vec<(i64, Bound<'py, PyAny>, Option<Vec<Bound<'py, PyAny>>>)>;

/// A sequence in memory: sensors (JSON, with the keys of `sequence.toml`) with all their measurements, in their order.
#[pyclass(frozen, module = "ralf._ralf")]
pub(crate) struct MemorySequence {
    /// Of the one sequence; whoever labels or writes it takes it.
    recording: Mutex<Option<Recording>>,
}

/// What there is to know beside a table, with the keys of `run.json`.
#[derive(Serialize)]
struct Told<'a> {
    sequences: Vec<Without<'a>>,
    check: Vec<CheckRecord>,
    /// Sentences.
    warnings: Vec<String>,
}

/// What a sequence was labelled without.
#[derive(Serialize)]
struct Without<'a> {
    name: &'a str,
    unreadable: &'a [UnreadableScan],
    cameras: &'a [CameraRecord],
}

impl<'a> Without<'a> {
    fn of(record: &'a SequenceRecord) -> Self {
        let SequenceRecord { name, unreadable, cameras, .. } = record;
        Self { name, unreadable, cameras }
    }
}

impl MemorySequence {
    fn take(&self) -> PyResult<Recording> {
        let taken = self.recording.lock().unwrap_or_else(PoisonError::into_inner).take();
        taken.ok_or_else(|| {
            other("expected a sequence that was neither labelled nor written, found one that was")
        })
    }
}

#[pymethods]
impl MemorySequence {
    #[new]
    fn new(
        name: &str,
        sensors: &str,
        motion: &str,
        radars: Vec<RadarScans<'_>>,
        lidars: Vec<LidarScans<'_>>,
        cameras: Vec<Images<'_>>,
    ) -> PyResult<Self> {
        let (rig, depth_output) = rig_from_json(sensors).map_err(data)?;
        let source = MemorySource::new(name, motion_of(from_json(motion)?)?).map_err(other)?;
        let mut source = source.with_depth_output(depth_output);
        for (radar, scans) in rig.radars.into_iter().zip(radars) {
            let scans = scans.iter().map(radar_scan).collect::<PyResult<_>>()?;
            source = source.with_radar(radar, scans).map_err(other)?;
        }
        for (lidar, scans) in rig.lidars.into_iter().zip(lidars) {
            let scans = scans.into_iter().map(lidar_scan).collect::<PyResult<_>>()?;
            source = source.with_lidar(lidar, scans).map_err(other)?;
        }
        for (camera, images) in rig.cameras.into_iter().zip(cameras) {
            let images = images.into_iter().map(timed_image).collect::<PyResult<_>>()?;
            source = source.with_camera(camera, images).map_err(other)?;
        }
        let recording = Recording::new(Path::new("memory"), "memory", vec![Box::new(source)]);
        Ok(Self { recording: Mutex::new(Some(recording)) })
    }

    /// Labels all scans, as a job's settings correct them, with its evidence and model; its recording and output are
    /// not looked at. Returns their table, and what there is to know beside it; JSON.
    #[pyo3(signature = (job, jobs=None, progress=None))]
    fn label(
        &self,
        py: Python<'_>,
        job: ToldJob,
        jobs: Option<NonZeroUsize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Table, String)> {
        let (job, jobs, recording) = (job.resolve()?, threads(jobs), self.take()?);
        let (labelled, check, mut warnings) = watched(py, progress.as_ref(), |watch| {
            let recording = job.settings.correct(recording)?;
            let check = if job.check { check_all(&recording, jobs.get()) } else { Vec::new() };
            let model = model_of(job.settings.method.method, job.model.as_deref())?;
            let run = job.run(&recording, model.as_ref(), jobs);
            Ok((run.in_memory(watch)?, check, run.warnings()))
        })?;
        let doubtful = labelled.iter().flat_map(|InMemory { record, .. }| {
            record
                .doubtful_radars()
                .into_iter()
                .map(|(radar, words)| format!("{} {radar}: {words}", record.name))
        });
        warnings.extend(doubtful);
        let told = to_json(&Told {
            sequences: labelled.iter().map(|one| Without::of(&one.record)).collect(),
            check,
            warnings,
        })?;
        let table = py.detach(|| together(labelled.into_iter().flat_map(|one| one.scans).collect()))?;
        Ok((table, told))
    }

    /// Writes the sequence in the project's own layout, for every command.
    fn write(&self, py: Python<'_>, dataset: PathBuf) -> PyResult<()> {
        let recording = self.take()?;
        let mut sequences = recording.sequences.iter();
        py.detach(|| sequences.try_for_each(|one| write_sequence(one.as_ref(), &dataset, &|_| ())))
            .map_err(data)
    }
}

/// One table of all scans, in their order.
fn together(scans: Vec<(RadarScanKey, ResultTable)>) -> PyResult<Table> {
    let whole = ResultTable::of_scans(&scans).map_err(data)?;
    let columns = whole.schema().columns().to_vec();
    let spans = scans.into_iter().map(|(key, table)| (key, table.len())).collect();
    Table::of_groups(&columns, vec![(whole, spans)]).map_err(other)
}

fn motion_of(told: MotionTold) -> PyResult<EgoMotion> {
    let odometry = told.odometry.into_iter();
    let odometry = odometry.map(|(t_ns, velocity, yaw_rate)| OdometrySample { t_ns, velocity, yaw_rate });
    let pose = |(t_ns, pose): (i64, Pose)| Ok(PoseSample { t_ns, odom_from_vehicle: pose.transform()? });
    let poses = told.poses.into_iter().map(pose).collect::<PyResult<_>>()?;
    EgoMotion::new(odometry.collect(), poses)
        .ok_or_else(|| other("motion: expected odometry or poses, found neither"))
}

fn radar_scan((t_ns, fields): &(i64, Vec<Bound<'_, PyAny>>)) -> PyResult<(i64, Vec<Vec<f32>>)> {
    Ok((*t_ns, fields.iter().map(numbers).collect::<PyResult<_>>()?))
}

fn lidar_scan(
    (t_ns, points, intensity, times): (i64, Bound<'_, PyAny>, Bound<'_, PyAny>, Option<Bound<'_, PyAny>>),
) -> PyResult<LidarScan> {
    let times = times.as_ref().map(numbers::<f32>).transpose()?;
    Ok(LidarScan { t_ns, points: rows(&points)?, times, intensity: numbers(&intensity)?, classes: None })
}

fn timed_image(
    (t_ns, pixels, views): (i64, Bound<'_, PyAny>, Option<Vec<Bound<'_, PyAny>>>),
) -> PyResult<TimedImage> {
    let depth = views.map(|views| views.iter().map(depth).collect()).transpose()?;
    Ok(TimedImage { t_ns, image: image(&pixels)?, depth })
}
