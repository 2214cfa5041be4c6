//! A sequence as a source: measurements typed.

use super::labels::Convention;
use super::raw::{Mounting, Scene, SceneFile, Sensors};
use super::tables::{COLUMNS, Detections};
use super::{SCENES, TABLES};
use crate::disk::label_file::Label;
use crate::disk::{files, json};
use crate::error::DataError;
use crate::read::last_read::LastRead;
use crate::read::models::RADARSCENES;
use crate::read::point_times::nanoseconds;
use crate::read::recording::{measurement, no_measurement};
use crate::read::rotation::{mounting, turned};
use crate::read::{SequenceReader, TruthLabels};
use ralf::label::UNLABELED;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, LidarScan, RadarScan, Rig, Sequence, Source, SourceError, Timelines,
};
use ralf::space::Transform;
use ralf_files::Kind;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Where the radars are by the data set's own program, where `sensors.json` isn't at hand.
const MOUNTINGS: [Mounting; 4] = [
    Mounting { id: 1, x: 3.663, y: -0.873, yaw: -1.484_185_52 },
    Mounting { id: 2, x: 3.86, y: -0.70, yaw: -0.436_185_662 },
    Mounting { id: 3, x: 3.86, y: 0.70, yaw: 0.436 },
    Mounting { id: 4, x: 3.663, y: 0.873, yaw: 1.484 },
];

/// A sequence's folder, opened.
pub(super) struct Drive {
    sequence: Sequence,
    file: PathBuf,
    /// `scenes.json`, and `sensors.json` where it is there.
    further: Vec<PathBuf>,
    tables: Arc<LastRead<Detections>>,
    /// The rows of each scan of each radar.
    radars: Vec<Vec<Range<usize>>>,
    warnings: Vec<String>,
}

impl Drive {
    /// Reads which rows are which scan, the mountings, and the vehicle's motion.
    pub(super) fn new(folder: &Path, tables: Arc<LastRead<Detections>>) -> Result<Self, DataError> {
        let (file, scene_file) = (folder.join(TABLES), folder.join(SCENES));
        let expected = "`scenes` by their times, each with sensor_id and radar_indices";
        let listed: SceneFile = json::read(&scene_file, Kind::Table, expected)?;
        let (mountings, sensor_file) = mountings(folder)?;
        let detections = tables.of(&file)?;
        let scans = scans(&scene_file, &listed.scenes, &detections.sensors)?;
        let (mut rig, mut times, mut radars) = (Rig::default(), Timelines::default(), Vec::new());
        for (id, scans) in scans {
            let mounting = mountings.iter().find(|mounting| mounting.id == id).ok_or_else(|| {
                let expected = "the id of a radar that has a mounting";
                DataError::content(&scene_file, "sensor_id", expected, id.to_string())
            })?;
            rig.radars.push(RADARSCENES.mounted(
                &format!("radar_{id}"),
                &COLUMNS.map(|(_, field)| field),
                vehicle_from_radar(mounting),
            ));
            times.radars.push(scans.iter().map(|(t_ns, _)| *t_ns).collect());
            radars.push(scans.into_iter().map(|(_, rows)| rows).collect());
        }
        let category = listed.category.map(|category| format!(", {category}")).unwrap_or_default();
        let whose =
            if detections.convention == Convention::ClutterDs { ", labels of clutter-ds" } else { "" };
        let sequence = Sequence {
            name: folder.file_name().unwrap_or_default().to_string_lossy().into_owned(),
            title: format!("RadarScenes{category}{whose}"),
            rig,
            times,
            motion: detections.motion.clone(),
            depth_output: DepthOutput::default(),
        };
        let warnings = warnings(folder, sensor_file.is_none())?;
        let further = [scene_file].into_iter().chain(sensor_file).collect();
        Ok(Self { sequence, file, further, tables, radars, warnings })
    }

    /// A scan's values of a column.
    fn of<T: Clone>(&self, rows: &Range<usize>, column: &[T]) -> Result<Vec<T>, DataError> {
        let expected = "as many rows as when the file was opened";
        let values = column.get(rows.clone()).map(<[T]>::to_vec);
        values.ok_or_else(|| DataError::content(&self.file, "radar_data", expected, "fewer"))
    }
}

/// The mountings, and the file that tells them; those of the data set's program where there is none.
fn mountings(folder: &Path) -> Result<(Vec<Mounting>, Option<PathBuf>), DataError> {
    let file = folder.with_file_name("sensors.json");
    if !files::exists(&file)? {
        return Ok((MOUNTINGS.to_vec(), None));
    }
    let sensors: Sensors = json::read(&file, Kind::Settings, "radars, each with id, x, y and yaw")?;
    for (name, at) in &sensors {
        mounting(&file, name, vehicle_from_radar(at))?;
    }
    refuse_contradictions(&file, &sensors)?;
    Ok((sensors.into_values().collect(), Some(file)))
}

fn vehicle_from_radar(mounting: &Mounting) -> Transform {
    turned([mounting.x, mounting.y, 0.0], mounting.yaw)
}

/// Refuses two radars of one id that are mounted in different ways: nobody could tell which is true.
fn refuse_contradictions(file: &Path, sensors: &Sensors) -> Result<(), DataError> {
    let mut known: BTreeMap<i64, (&str, &Mounting)> = BTreeMap::new();
    for (name, mounting) in sensors {
        let (other, before) = *known.entry(mounting.id).or_insert((name, mounting));
        if before != mounting {
            let found = format!("{}, which {other} has, too, with another mounting", mounting.id);
            return Err(DataError::content(file, format!("{name}, id"), "an id of its own", found));
        }
    }
    Ok(())
}

fn warnings(folder: &Path, without_mountings: bool) -> Result<Vec<String>, DataError> {
    let mut warnings = Vec::new();
    if without_mountings {
        warnings.push(
            "no sensors.json beside the sequence: mountings are those of the data set's program".to_owned(),
        );
    }
    if files::exists(&folder.join("camera"))? {
        warnings.push("the documentary camera has no calibration: left out".to_owned());
    }
    Ok(warnings)
}

/// Time, ns, and rows of the scans of each radar, by its number.
type Scans = BTreeMap<i64, Vec<(i64, Range<usize>)>>;

/// The scans in the order of time. Every row has to be of one scan.
fn scans(file: &Path, scenes: &BTreeMap<String, Scene>, sensors: &[i64]) -> Result<Scans, DataError> {
    let mut found = Scans::new();
    let mut ranges = Vec::with_capacity(scenes.len());
    for (time, Scene { sensor_id, radar_indices: [first, end] }) in scenes {
        let error = |expected: &str, found: String| {
            Err(DataError::content(file, format!("scene {time}"), expected, found))
        };
        let Some(t_ns) = time.parse().ok().and_then(nanoseconds) else {
            return error("a time in us as its name", format!("`{time}`"));
        };
        let Some(rows) = sensors.get(*first..*end) else {
            return error(
                &format!("rows of the {} of radar_data", sensors.len()),
                format!("{first} to {end}"),
            );
        };
        if let Some(other) = rows.iter().find(|other| *other != sensor_id) {
            return error(&format!("detections of radar {sensor_id}"), format!("some of radar {other}"));
        }
        ranges.push(*first..*end);
        found.entry(*sensor_id).or_default().push((t_ns, *first..*end));
    }
    check_complete(file, ranges, sensors.len())?;
    found.values_mut().for_each(|scans| scans.sort_by_key(|(t_ns, rows)| (*t_ns, rows.start)));
    Ok(found)
}

/// Refuses rows that no scene has, and rows that several have.
fn check_complete(file: &Path, mut ranges: Vec<Range<usize>>, rows: usize) -> Result<(), DataError> {
    ranges.sort_by_key(|rows| (rows.start, rows.end));
    let mut next = 0;
    for range in ranges.iter().chain([&(rows..rows)]) {
        if range.start != next {
            let found = format!("row {next}, then row {}", range.start);
            return Err(DataError::content(file, "radar_indices", "every row once", found));
        }
        next = range.end;
    }
    Ok(())
}

impl Source for Drive {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let rows = measurement("radar", &self.radars, radar, scan)?;
        let table = self.tables.of(&self.file)?;
        let columns = table.columns.iter().map(|column| self.of(rows, column)).collect::<Result<_, _>>()?;
        let t_ns = self.sequence.times.radars[radar][scan];
        Ok(RadarScan::new(&self.sequence.rig.radars[radar], t_ns, columns)?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        no_measurement("lidar", lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        no_measurement("camera", camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        no_measurement("camera", camera, image)
    }
}

impl SequenceReader for Drive {
    fn inputs(&self) -> Vec<PathBuf> {
        [&self.file].into_iter().chain(&self.further).cloned().collect()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn truth(&self, radar: usize, scan: usize) -> Result<Option<TruthLabels>, SourceError> {
        let rows = measurement("radar", &self.radars, radar, scan)?;
        let table = self.tables.of(&self.file)?;
        let classes = table.classes.as_ref().map_err(|found| {
            let expected = table.convention.expected();
            DataError::content(&self.file, "radar_data, label_id", expected, found)
        })?;
        let (classes, instances) = (self.of(rows, classes)?, self.of(rows, &table.instances)?);
        let label =
            |(id, instance): (u16, u16)| Label { id, instance: if id == UNLABELED { 0 } else { instance } };
        let labels = classes.into_iter().zip(instances).map(label).collect();
        // Nobody says why a detection is clutter.
        Ok(Some(TruthLabels { labels, causes: Vec::new() }))
    }
}
