//! A sequence as a source: measurements typed.

use super::labels::label;
use super::tables::{COLUMNS, Detections, Points, RADARS, detections, points};
use crate::error::DataError;
use crate::read::last_read::LastRead;
use crate::read::models::{GHOST_LIDAR, GHOST_RADAR};
use crate::read::recording::{measurement, no_measurement};
use crate::read::rotation::turned;
use crate::read::row_scans::{Scan, torn_scans};
use crate::read::{SequenceReader, TruthLabels};
use ralf::label::Cause;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, LidarScan, RadarScan, Rig, Sequence, Source, SourceError, Timelines,
};
use ralf::space::{EgoMotion, OdometrySample, Transform, placed};
use std::f64::consts::FRAC_PI_6;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where the radars are in the car's frame, m and rad.
const MOUNTINGS: [([f64; 3], f64); 2] =
    [([3.739, 0.658, 0.0305], FRAC_PI_6), ([3.739, -0.658, 0.0305], -FRAC_PI_6)];
/// Where the LiDAR is.
const LIDAR: [f64; 3] = [3.739, -0.194, 0.2806];

/// The tables of the files that were asked for last.
pub(super) struct Tables {
    detections: LastRead<Detections>,
    points: LastRead<Points>,
}

impl Tables {
    pub(super) fn new() -> Self {
        Self { detections: LastRead::new(detections, 2), points: LastRead::new(points, 2) }
    }
}

/// A sequence of a vehicle that stands.
pub(super) struct Standing {
    sequence: Sequence,
    file: PathBuf,
    tables: Arc<Tables>,
    /// The places in [`RADARS`] of the radars that saw anything, and their scans.
    radars: Vec<(usize, Vec<Scan>)>,
    lidar: Vec<Scan>,
    warnings: Vec<String>,
}

impl Standing {
    /// Reads the file once, and keeps which rows are which scan.
    pub(super) fn new(file: PathBuf, tables: Arc<Tables>) -> Result<Self, DataError> {
        let lidar = tables.points.of(&file)?.scans.clone();
        let detections = tables.detections.of(&file)?;
        let radars = detections.scans.iter().cloned().enumerate();
        let radars: Vec<(usize, Vec<Scan>)> = radars.filter(|(_, scans)| !scans.is_empty()).collect();
        let warnings = torn_scans(detections.torn).into_iter().collect();
        let sequence = sequence(&file, &radars, &lidar)?;
        Ok(Self { sequence, file, tables, radars, lidar, warnings })
    }

    /// A radar's scan, and the table that its rows are in.
    fn scan(&self, radar: usize, scan: usize) -> Result<(&Scan, Arc<Detections>), DataError> {
        let scans = self.radars.get(radar).map_or(&[][..], |(_, scans)| scans);
        let no_such = DataError::NoMeasurement { kind: "radar", sensor: radar, index: scan };
        Ok((scans.get(scan).ok_or(no_such)?, self.tables.detections.of(&self.file)?))
    }

    /// A scan's values of a column.
    fn of<T: Clone>(&self, scan: &Scan, column: &[T]) -> Result<Vec<T>, DataError> {
        let expected = "as many rows as when the file was opened";
        scan.of(column).ok_or_else(|| DataError::content(&self.file, "rows", expected, "fewer"))
    }
}

fn sequence(file: &Path, radars: &[(usize, Vec<Scan>)], lidar: &[Scan]) -> Result<Sequence, DataError> {
    let fields = COLUMNS.map(|(_, field)| field);
    let mounted = |place: usize| {
        let (place_of, yaw) = MOUNTINGS[place];
        GHOST_RADAR.mounted(RADARS[place], &fields, turned(place_of, yaw))
    };
    let rig = Rig {
        radars: radars.iter().map(|(place, _)| mounted(*place)).collect(),
        lidars: vec![GHOST_LIDAR.mounted("lidar", lidar_mounting())],
        cameras: Vec::new(),
    };
    let times = |scans: &[Scan]| scans.iter().map(|scan| scan.t_ns).collect::<Vec<i64>>();
    let times = Timelines {
        radars: radars.iter().map(|(_, scans)| times(scans)).collect(),
        lidars: vec![times(lidar)],
        cameras: Vec::new(),
    };
    let Some(begin) = times.radars.iter().chain(&times.lidars).flatten().copied().min() else {
        return Err(DataError::content(file, "radar, lidar", "rows", "none"));
    };
    let standing = OdometrySample { t_ns: begin, velocity: 0.0, yaw_rate: 0.0 };
    Ok(Sequence {
        name: name(file),
        title: format!("Radar Ghost, {}", text(file.parent().and_then(Path::file_name))),
        rig,
        times,
        motion: EgoMotion::new(vec![standing], Vec::new()).unwrap_or_else(EgoMotion::unknown),
        depth_output: DepthOutput::default(),
    })
}

/// A sequence is named after its file.
pub(super) fn name(file: &Path) -> String {
    text(file.file_stem())
}

fn text(part: Option<&OsStr>) -> String {
    part.unwrap_or_default().to_string_lossy().into_owned()
}

fn lidar_mounting() -> Transform {
    let [x, y, z] = LIDAR;
    Transform::translation(x, y, z)
}

impl Source for Standing {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let (scan, table) = self.scan(radar, scan)?;
        let columns = table.columns.iter().map(|column| self.of(scan, column)).collect::<Result<_, _>>()?;
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], scan.t_ns, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let scan = measurement("lidar", std::slice::from_ref(&self.lidar), lidar, scan)?;
        let lidar_from_car = lidar_mounting().inverse();
        let seen = |point: [f32; 3]| {
            let place = placed(&lidar_from_car, &point);
            [place.x as f32, place.y as f32, place.z as f32]
        };
        let table = self.tables.points.of(&self.file)?;
        let points: Vec<[f32; 3]> = self.of(scan, &table.points)?.into_iter().map(seen).collect();
        let intensity = vec![0.0; points.len()];
        Ok(LidarScan { t_ns: scan.t_ns, points, times: None, intensity, classes: None })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        no_measurement("camera", camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        no_measurement("camera", camera, image)
    }
}

impl SequenceReader for Standing {
    fn inputs(&self) -> Vec<PathBuf> {
        vec![self.file.clone()]
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn truth(&self, radar: usize, scan: usize) -> Result<Option<TruthLabels>, SourceError> {
        let (scan, table) = self.scan(radar, scan)?;
        let truths = table.truth.as_ref().map_err(|found| {
            let expected = "0, -1, -2 or four digits, class, main, type and order";
            DataError::content(&self.file, "radar, label_id", expected, found)
        })?;
        let (truths, instances) = (self.of(scan, truths)?, self.of(scan, &table.instances)?);
        let labels = truths.iter().zip(instances).map(|((id, _), instance)| label(*id, instance)).collect();
        Ok(Some(TruthLabels { labels, causes: truths.iter().map(|(_, cause)| *cause as u8).collect() }))
    }

    fn causes(&self) -> &'static [Cause] {
        &Cause::ALL
    }
}
