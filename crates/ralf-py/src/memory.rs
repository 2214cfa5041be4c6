//! A sequence of arrays, without files.

use crate::arrays::{numbers, rows};
use crate::errors::{data, other};
use crate::labelling::{from_json, threads};
use crate::table::Table;
use crate::watch::watched;
use pyo3::prelude::*;
use ralf::sensors::{Elevation, Lidar, LidarScan, MemorySource, Radar, Reliability, Sequence, Source};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform, transform_from_parts};
use ralf_data::many::{Job, model_of};
use ralf_data::result::{RadarScanKey, Table as ResultTable};
use ralf_data::run::LabelRun;
use ralf_data::{Recording, write_sequence};
use serde::Deserialize;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Where a sensor sits, or the vehicle is: metres, and a quaternion in the order x, y, z, w.
#[derive(Deserialize)]
struct Pose {
    translation: [f64; 3],
    rotation: [f64; 4],
}

impl Pose {
    fn transform(&self) -> PyResult<Transform> {
        let found = || {
            format!(
                "expected finite numbers and a rotation, found {:?}, {:?}",
                self.translation, self.rotation
            )
        };
        transform_from_parts(self.translation, self.rotation).ok_or_else(|| other(found()))
    }
}

/// A radar, as the Python package tells of it; angles in degrees.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RadarTold {
    name: String,
    fields: Vec<String>,
    mounting: Pose,
    elevation: bool,
    fov_azimuth_deg: f64,
    fov_elevation_deg: f64,
    sigma_range_m: f64,
    sigma_azimuth_deg: f64,
    sigma_elevation_deg: f64,
}

/// A LiDAR, as the Python package tells of it; angles in degrees.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LidarTold {
    name: String,
    mounting: Pose,
    sigma_range_m: f64,
    lowest_beam_deg: f64,
    max_range_m: Option<f64>,
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

/// A sequence in memory: sensors (JSON) with all their measurements.
#[pyclass(frozen, module = "ralf._ralf")]
pub(crate) struct MemorySequence {
    source: MemorySource,
}

#[pymethods]
impl MemorySequence {
    #[new]
    fn new(
        name: &str,
        motion: &str,
        radars: Vec<(String, RadarScans<'_>)>,
        lidars: Vec<(String, LidarScans<'_>)>,
    ) -> PyResult<Self> {
        let mut source = MemorySource::new(name, motion_of(from_json(motion)?)?);
        for (radar, scans) in radars {
            let radar = radar_of(from_json(&radar)?)?;
            let scans = scans.iter().map(|(t_ns, fields)| {
                let columns = fields.iter().map(numbers::<f32>).collect::<PyResult<_>>()?;
                Ok((*t_ns, columns))
            });
            source = source.with_radar(radar, scans.collect::<PyResult<_>>()?).map_err(other)?;
        }
        for (lidar, scans) in lidars {
            let lidar = lidar_of(from_json(&lidar)?)?;
            let scans = scans.into_iter().map(lidar_scan).collect::<PyResult<_>>()?;
            source = source.with_lidar(lidar, scans).map_err(other)?;
        }
        Ok(Self { source })
    }

    /// Labels all scans, with the settings, evidence and model of a job (JSON) whose paths are not looked at.
    #[pyo3(signature = (job, jobs=None, progress=None))]
    fn label(
        &self,
        py: Python<'_>,
        job: &str,
        jobs: Option<NonZeroUsize>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Table> {
        let job: Job = from_json(job)?;
        let sequence = Box::new(self.source.clone());
        let recording =
            Recording { path: PathBuf::from("memory"), format: "memory", sequences: vec![sequence] };
        let tables = watched(py, progress.as_ref(), |watch| {
            let model = model_of(job.settings.method.method, job.model.as_deref())?;
            let run = LabelRun {
                recording: &recording,
                settings: &job.settings,
                out: Path::new(""),
                jobs: threads(jobs).get(),
                checks: &[],
                evidence: job.evidence,
                model: model.as_ref(),
            };
            run.tables(watch)
        })?;
        py.detach(|| together(tables.into_iter().flatten().collect()))
    }

    /// Writes the sequence in the project's own layout, for every command.
    fn write(&self, py: Python<'_>, dataset: PathBuf) -> PyResult<()> {
        py.detach(|| write_sequence(&self.source, &dataset, &|_| ())).map_err(data)
    }

    /// How many scans the radars have, all together.
    fn __len__(&self) -> usize {
        let Sequence { times, .. } = self.source.sequence();
        times.radars.iter().map(Vec::len).sum()
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

fn radar_of(told: RadarTold) -> PyResult<Radar> {
    Ok(Radar {
        vehicle_from_radar: told.mounting.transform()?,
        name: told.name,
        fields: told.fields,
        elevation: if told.elevation { Elevation::Measured } else { Elevation::None },
        fov_azimuth: told.fov_azimuth_deg.to_radians(),
        fov_elevation: told.fov_elevation_deg.to_radians(),
        sigma_range: told.sigma_range_m,
        sigma_azimuth: told.sigma_azimuth_deg.to_radians(),
        sigma_elevation: told.sigma_elevation_deg.to_radians(),
        reliability: Reliability::default(),
    })
}

fn lidar_of(told: LidarTold) -> PyResult<Lidar> {
    Ok(Lidar {
        vehicle_from_lidar: told.mounting.transform()?,
        name: told.name,
        sigma_range: told.sigma_range_m,
        lowest_beam: told.lowest_beam_deg.to_radians(),
        max_range: told.max_range_m,
    })
}

fn lidar_scan(
    (t_ns, points, intensity, times): (i64, Bound<'_, PyAny>, Bound<'_, PyAny>, Option<Bound<'_, PyAny>>),
) -> PyResult<LidarScan> {
    let times = times.as_ref().map(numbers::<f32>).transpose()?;
    Ok(LidarScan { t_ns, points: rows(&points)?, times, intensity: numbers(&intensity)?, classes: None })
}
