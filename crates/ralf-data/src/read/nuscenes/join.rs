//! Tables joined to scenes: which sensors each has, what they measured when, and where the vehicle was.

use super::raw::{
    CalibratedSensorRow, EgoPoseRow, LogRow, Modality, SampleDataRow, SampleRow, SceneRow, SensorRow, Token,
    for_each_row,
};
use crate::error::DataError;
use ralf::space::{PoseSample, Transform, transform_from_parts};
use std::collections::HashMap;
use std::path::Path;

/// The tables that are read.
pub(super) const TABLES: [&str; 7] = [
    "calibrated_sensor.json",
    "ego_pose.json",
    "log.json",
    "sample.json",
    "sample_data.json",
    "scene.json",
    "sensor.json",
];

/// A scene, as the tables know it.
pub(super) struct SceneRecord {
    pub(super) name: String,
    pub(super) title: String,
    /// Sorted by [`Calibration::rank`].
    pub(super) channels: Vec<Channel>,
    /// In time order, one per time; never empty.
    pub(super) poses: Vec<PoseSample>,
}

/// A sensor of a scene.
pub(super) struct Channel {
    pub(super) calibration: Calibration,
    /// Width and height in px, of cameras.
    pub(super) image_size: [usize; 2],
    /// In time order.
    pub(super) measurements: Vec<Measurement>,
}

/// One file of one sensor.
pub(super) struct Measurement {
    /// Its row in `sample_data.json`.
    pub(super) token: Token,
    pub(super) t_ns: i64,
    /// Relative to the data set's folder.
    pub(super) file: Box<str>,
}

/// A sensor as mounted.
#[derive(Clone, PartialEq)]
pub(super) struct Calibration {
    pub(super) name: String,
    pub(super) modality: Modality,
    pub(super) vehicle_from_sensor: Transform,
    pub(super) intrinsic: Vec<[f64; 3]>,
}

/// Where a sensor looks, from the front to the back; the order within the rig.
const DIRECTIONS: [&str; 6] = ["FRONT", "FRONT_LEFT", "FRONT_RIGHT", "BACK", "BACK_LEFT", "BACK_RIGHT"];

impl Calibration {
    /// Radars, LiDARs, cameras; each by direction, then by name.
    fn rank(&self) -> (Modality, usize, &str) {
        let direction = self.name.split_once('_').map_or("", |(_, direction)| direction);
        let known = DIRECTIONS.iter().position(|known| *known == direction);
        (self.modality, known.unwrap_or(DIRECTIONS.len()), &self.name)
    }
}

/// Reads all tables. Scenes come in the order of their names.
pub(super) fn read_scenes(version: &Path) -> Result<Vec<SceneRecord>, DataError> {
    let (mut scenes, scene_of_sample) = read_samples(version)?;
    let calibrations = read_calibrations(version)?;
    let file = version.join("sample_data.json");
    let mut scene_of_pose: HashMap<Token, usize> = HashMap::new();
    for_each_row(&file, |row: SampleDataRow| {
        let scene = *lookup(&scene_of_sample, row.sample_token, "sample.json")?;
        let calibration = lookup(&calibrations, row.calibrated_sensor_token, "calibrated_sensor.json")?;
        scene_of_pose.insert(row.ego_pose_token, scene);
        scenes[scene].add(calibration, row)
    })?;
    read_poses(version, scene_of_pose, &mut scenes)?;
    for scene in &mut scenes {
        scene.sort();
        if scene.poses.is_empty() {
            let place = format!("scene `{}`", scene.name);
            return Err(DataError::content(
                &file,
                place,
                "at least one measurement with its ego pose",
                "none",
            ));
        }
    }
    scenes.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(scenes)
}

impl SceneRecord {
    fn add(&mut self, calibration: &Calibration, row: SampleDataRow) -> Result<(), String> {
        let channel = match self.channels.iter().position(|c| c.calibration.name == calibration.name) {
            Some(channel) => channel,
            None => {
                let (calibration, image_size) = (calibration.clone(), [row.width, row.height]);
                self.channels.push(Channel { calibration, image_size, measurements: Vec::new() });
                self.channels.len() - 1
            }
        };
        let channel = &mut self.channels[channel];
        if channel.calibration != *calibration {
            return Err(format!(
                "a calibrated_sensor of {} that changes inside {}",
                calibration.name, self.name
            ));
        }
        channel.measurements.push(Measurement { token: row.token, t_ns: row.t_ns, file: row.filename });
        Ok(())
    }

    fn sort(&mut self) {
        self.channels.sort_by(|a, b| a.calibration.rank().cmp(&b.calibration.rank()));
        for channel in &mut self.channels {
            channel.measurements.sort_by(|a, b| (a.t_ns, &a.file).cmp(&(b.t_ns, &b.file)));
        }
        self.poses.sort_by_key(|pose| pose.t_ns);
        self.poses.dedup_by_key(|pose| pose.t_ns);
    }
}

/// The scenes, still empty, and which of them each sample belongs to.
fn read_samples(version: &Path) -> Result<(Vec<SceneRecord>, HashMap<Token, usize>), DataError> {
    let mut logs = HashMap::new();
    for_each_row(&version.join("log.json"), |row: LogRow| {
        logs.insert(row.token, format!("{}, {}", row.location, row.date_captured));
        Ok(())
    })?;
    let (mut scenes, mut scene_indices) = (Vec::new(), HashMap::new());
    for_each_row(&version.join("scene.json"), |row: SceneRow| {
        let title = format!("{} ({})", row.description, lookup(&logs, row.log_token, "log.json")?);
        scene_indices.insert(row.token, scenes.len());
        scenes.push(SceneRecord { name: row.name, title, channels: Vec::new(), poses: Vec::new() });
        Ok(())
    })?;
    let mut scene_of_sample = HashMap::new();
    for_each_row(&version.join("sample.json"), |row: SampleRow| {
        scene_of_sample.insert(row.token, *lookup(&scene_indices, row.scene_token, "scene.json")?);
        Ok(())
    })?;
    Ok((scenes, scene_of_sample))
}

fn read_calibrations(version: &Path) -> Result<HashMap<Token, Calibration>, DataError> {
    let mut sensors = HashMap::new();
    for_each_row(&version.join("sensor.json"), |row: SensorRow| {
        sensors.insert(row.token, (row.channel, row.modality));
        Ok(())
    })?;
    let mut calibrations = HashMap::new();
    for_each_row(&version.join("calibrated_sensor.json"), |row: CalibratedSensorRow| {
        let (name, modality) = lookup(&sensors, row.sensor_token, "sensor.json")?.clone();
        let vehicle_from_sensor = transform(row.translation, row.rotation)?;
        let calibration =
            Calibration { name, modality, vehicle_from_sensor, intrinsic: row.camera_intrinsic };
        calibrations.insert(row.token, calibration);
        Ok(())
    })?;
    Ok(calibrations)
}

/// Puts the ego poses into the scenes that refer to them.
fn read_poses(
    version: &Path,
    mut scene_of_pose: HashMap<Token, usize>,
    scenes: &mut [SceneRecord],
) -> Result<(), DataError> {
    let file = version.join("ego_pose.json");
    for_each_row(&file, |row: EgoPoseRow| {
        if let Some(scene) = scene_of_pose.remove(&row.token) {
            let odom_from_vehicle = transform(row.translation, row.rotation)?;
            scenes[scene].poses.push(PoseSample { t_ns: row.t_ns, odom_from_vehicle });
        }
        Ok(())
    })?;
    // The least of the missing ones, so that the message is the same every time.
    match scene_of_pose.into_keys().min() {
        None => Ok(()),
        Some(token) => Err(DataError::content(
            &file,
            "tokens",
            "every ego_pose_token of sample_data.json",
            format!("no `{token}`"),
        )),
    }
}

fn lookup<'a, T>(table: &'a HashMap<Token, T>, token: Token, name: &str) -> Result<&'a T, String> {
    table.get(&token).ok_or_else(|| format!("the token `{token}`, which {name} lacks"))
}

fn transform(translation: [f64; 3], [w, x, y, z]: [f64; 4]) -> Result<Transform, String> {
    transform_from_parts(translation, [x, y, z, w])
        .ok_or_else(|| format!("the rotation [{w}, {x}, {y}, {z}], which is no unit quaternion w x y z"))
}
