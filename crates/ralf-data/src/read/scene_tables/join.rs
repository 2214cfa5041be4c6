//! Tables joined to scenes: which sensors each has, what they measured when, and where the vehicle was.

use super::raw::{
    CalibratedSensorRow, EgoPoseRow, Modality, SampleDataRow, SampleRow, SceneRow, SensorRow, Token,
    for_each_row,
};
use crate::error::DataError;
use ralf::sensors::check_mounting;
use ralf::space::{PoseSample, Transform, transform_from_parts};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::{Component, Path};

/// A scene, as the tables know it.
pub(crate) struct SceneRecord {
    pub(crate) name: String,
    pub(crate) title: String,
    /// Sorted by [`Calibration::rank`].
    pub(crate) channels: Vec<Channel>,
    /// In time order, one per time.
    pub(crate) poses: Vec<PoseSample>,
}

/// A sensor of a scene.
pub(crate) struct Channel {
    pub(crate) calibration: Calibration,
    /// Width and height in px, of cameras.
    pub(crate) image_size: [usize; 2],
    /// In time order.
    pub(crate) measurements: Vec<Measurement>,
}

/// One file of one sensor.
#[derive(PartialEq)]
pub(crate) struct Measurement {
    /// Its row in `sample_data.json`.
    pub(crate) token: Token,
    pub(crate) t_ns: i64,
    /// Relative to the data set's folder.
    pub(crate) file: Box<str>,
}

/// A sensor as mounted.
#[derive(Clone, PartialEq)]
pub(crate) struct Calibration {
    pub(crate) name: String,
    pub(crate) modality: Modality,
    pub(crate) vehicle_from_sensor: Transform,
    pub(crate) intrinsic: Vec<[f64; 3]>,
}

/// Where a sensor looks, from the front to the back; the order within the rig.
const DIRECTIONS: [&str; 18] = [
    "FRONT",
    "FRONT_LEFT",
    "FRONT_RIGHT",
    "LEFT_FRONT",
    "RIGHT_FRONT",
    "TOP_FRONT",
    "LEFT",
    "RIGHT",
    "TOP_LEFT",
    "TOP_RIGHT",
    "LEFT_SIDE",
    "RIGHT_SIDE",
    "BACK",
    "BACK_LEFT",
    "BACK_RIGHT",
    "LEFT_BACK",
    "RIGHT_BACK",
    "REAR",
];

impl Calibration {
    /// Radars, LiDARs, cameras; each by direction, then by name.
    fn rank(&self) -> (Modality, usize, &str) {
        let direction = self.name.split_once('_').map_or("", |(_, direction)| direction);
        let known = DIRECTIONS.iter().position(|known| *known == direction);
        (self.modality, known.unwrap_or(DIRECTIONS.len()), &self.name)
    }
}

/// All scenes of a version folder, in the order of their table, still without poses.
pub(crate) struct Scenes {
    pub(crate) records: Vec<SceneRecord>,
    /// Which scene's measurements name a pose.
    scene_of_pose: HashMap<Token, usize>,
}

/// Reads the tables but the poses. A scene's title is told by `title`, from its description and its log's token.
pub(crate) fn read_scenes(
    version: &Path,
    title: impl Fn(&str, Token) -> Result<String, String>,
) -> Result<Scenes, DataError> {
    let (mut records, scene_of_sample) = read_samples(version, title)?;
    let calibrations = read_calibrations(version)?;
    let mut scene_of_pose: HashMap<Token, usize> = HashMap::new();
    for_each_row(&version.join("sample_data.json"), |row: SampleDataRow| {
        let scene = *lookup(&scene_of_sample, row.sample_token, "sample.json")?;
        let calibration = lookup(&calibrations, row.calibrated_sensor_token, "calibrated_sensor.json")?;
        scene_of_pose.insert(row.ego_pose_token, scene);
        records[scene].add(calibration, row)
    })?;
    for scene in &mut records {
        scene.sort();
    }
    check_tokens(&version.join("sample_data.json"), &records)?;
    Ok(Scenes { records, scene_of_pose })
}

/// Refuses a token that two measurements have: nobody could tell which of them is its.
fn check_tokens(file: &Path, scenes: &[SceneRecord]) -> Result<(), DataError> {
    let measurements =
        scenes.iter().flat_map(|scene| &scene.channels).flat_map(|channel| &channel.measurements);
    let mut tokens: Vec<&Token> = measurements.map(|measurement| &measurement.token).collect();
    tokens.sort_unstable();
    let twice = tokens.windows(2).find(|pair| pair[0] == pair[1]);
    twice.map_or(Ok(()), |pair| {
        let found = "several, with other values";
        Err(DataError::content(
            file,
            format!("token `{}`", pair[0]),
            "one row, or rows that are alike",
            found,
        ))
    })
}

impl Scenes {
    /// Puts the ego poses into the scenes whose measurements name them.
    pub(crate) fn take_named_poses(&mut self, version: &Path) -> Result<(), DataError> {
        let file = version.join("ego_pose.json");
        for_each_row(&file, |row: EgoPoseRow| {
            if let Some(scene) = self.scene_of_pose.remove(&row.token) {
                self.records[scene].poses.push(row.sample()?);
            }
            Ok(())
        })?;
        // The least of the missing ones, so that the message is the same every time.
        match self.scene_of_pose.keys().min() {
            None => Ok(()),
            Some(token) => Err(DataError::content(
                &file,
                "tokens",
                "every ego_pose_token of sample_data.json",
                format!("no `{token}`"),
            )),
        }
    }

    /// The scenes by their names, in the order of these.
    pub(crate) fn finish(mut self) -> Vec<(String, SceneRecord)> {
        for scene in &mut self.records {
            scene.poses.sort_by_key(|pose| pose.t_ns);
            scene.poses.dedup_by_key(|pose| pose.t_ns);
        }
        self.records.sort_by(|a, b| a.name.cmp(&b.name));
        self.records.into_iter().map(|scene| (scene.name.clone(), scene)).collect()
    }
}

impl EgoPoseRow {
    /// The pose, which must have a rotation.
    pub(crate) fn sample(&self) -> Result<PoseSample, String> {
        Ok(PoseSample { t_ns: self.t_ns, odom_from_vehicle: transform(self.translation, self.rotation)? })
    }
}

impl SceneRecord {
    /// From its first measurement to its last, ns; `None` where it has none.
    pub(crate) fn span(&self) -> Option<[i64; 2]> {
        let times = || self.channels.iter().flat_map(|channel| &channel.measurements).map(|m| m.t_ns);
        Some([times().min()?, times().max()?])
    }

    /// Refuses a scene of which no measurement tells where the vehicle was.
    pub(crate) fn check_poses(&self, version: &Path) -> Result<(), DataError> {
        if !self.poses.is_empty() {
            return Ok(());
        }
        let (file, place) = (version.join("sample_data.json"), format!("scene `{}`", self.name));
        Err(DataError::content(&file, place, "at least one measurement with its ego pose", "none"))
    }

    fn add(&mut self, calibration: &Calibration, row: SampleDataRow) -> Result<(), String> {
        check_file(&row)?;
        let channel = match self.channels.iter().position(|c| c.calibration.name == calibration.name) {
            Some(channel) => channel,
            None => {
                let (calibration, image_size) = (calibration.clone(), [row.width, row.height]);
                self.channels.push(Channel { calibration, image_size, measurements: Vec::new() });
                self.channels.len() - 1
            }
        };
        let channel = &mut self.channels[channel];
        let name = &calibration.name;
        if channel.calibration != *calibration {
            return Err(format!("a calibrated_sensor of {name} that changes inside {}", self.name));
        }
        if calibration.modality == Modality::Other {
            return Err(format!("a measurement of {name}, which is neither radar nor lidar nor camera"));
        }
        channel.measurements.push(Measurement { token: row.token, t_ns: row.t_ns, file: row.filename });
        Ok(())
    }

    fn sort(&mut self) {
        self.channels.sort_by(|a, b| a.calibration.rank().cmp(&b.calibration.rank()));
        for channel in &mut self.channels {
            channel.measurements.sort_by(|a, b| (a.t_ns, &a.file, a.token).cmp(&(b.t_ns, &b.file, b.token)));
            // A row that is there twice says the same again.
            channel.measurements.dedup();
        }
    }
}

/// The scenes, still empty, and which of them each sample belongs to.
fn read_samples(
    version: &Path,
    title: impl Fn(&str, Token) -> Result<String, String>,
) -> Result<(Vec<SceneRecord>, HashMap<Token, usize>), DataError> {
    let (mut scenes, mut scene_indices) = (Vec::new(), HashMap::new());
    for_each_row(&version.join("scene.json"), |row: SceneRow| {
        let title = title(&row.description, row.log_token)?;
        let said_before = |index: &usize| {
            let scene: &SceneRecord = &scenes[*index];
            scene.name == row.name && scene.title == title
        };
        let index = scene_indices.get(&row.token).copied().filter(said_before).unwrap_or(scenes.len());
        take(&mut scene_indices, row.token, index)?;
        if index == scenes.len() {
            check_name(&row.name, &scenes)?;
            scenes.push(SceneRecord { name: row.name, title, channels: Vec::new(), poses: Vec::new() });
        }
        Ok(())
    })?;
    let mut scene_of_sample = HashMap::new();
    for_each_row(&version.join("sample.json"), |row: SampleRow| {
        take(&mut scene_of_sample, row.token, *lookup(&scene_indices, row.scene_token, "scene.json")?)
    })?;
    Ok((scenes, scene_of_sample))
}

/// Refuses a measurement's file that lies elsewhere than below the data set's folder.
fn check_file(SampleDataRow { token, filename, .. }: &SampleDataRow) -> Result<(), String> {
    let is_below = |part: Component<'_>| matches!(part, Component::Normal(_) | Component::CurDir);
    match Path::new(&**filename).components().all(is_below) {
        true => Ok(()),
        false => {
            Err(format!("the filename {filename:?} of the token `{token}`, which leads out of the data set"))
        }
    }
}

/// A sequence is named after its scene: refuses what is no name of its own.
fn check_name(name: &str, scenes: &[SceneRecord]) -> Result<(), String> {
    if name.is_empty() || name.contains('/') {
        return Err(format!("a scene of the name {name:?}, which no folder can have"));
    }
    match scenes.iter().any(|scene| scene.name == name) {
        true => Err(format!("a second scene of the name {name:?}")),
        false => Ok(()),
    }
}

fn read_calibrations(version: &Path) -> Result<HashMap<Token, Calibration>, DataError> {
    let mut sensors = HashMap::new();
    for_each_row(&version.join("sensor.json"), |row: SensorRow| {
        take(&mut sensors, row.token, (row.channel, row.modality))
    })?;
    let mut calibrations = HashMap::new();
    for_each_row(&version.join("calibrated_sensor.json"), |row: CalibratedSensorRow| {
        let (name, modality) = lookup(&sensors, row.sensor_token, "sensor.json")?.clone();
        let vehicle_from_sensor = transform(row.translation, row.rotation)?;
        check_mounting(&vehicle_from_sensor)
            .map_err(|_| format!("{name} at {:?} m, where no sensor is mounted", row.translation))?;
        let calibration =
            Calibration { name, modality, vehicle_from_sensor, intrinsic: row.camera_intrinsic };
        take(&mut calibrations, row.token, calibration)
    })?;
    Ok(calibrations)
}

/// Takes a token's row. Another one may say the same again, but nothing else: nobody could tell which is true.
fn take<T: PartialEq>(table: &mut HashMap<Token, T>, token: Token, row: T) -> Result<(), String> {
    match table.entry(token) {
        Entry::Occupied(known) if *known.get() != row => {
            Err(format!("a second row of the token `{token}`, with other values"))
        }
        known => {
            known.or_insert(row);
            Ok(())
        }
    }
}

/// The row of a token; `name` is the table that should have it.
pub(crate) fn lookup<'a, T>(table: &'a HashMap<Token, T>, token: Token, name: &str) -> Result<&'a T, String> {
    table.get(&token).ok_or_else(|| format!("the token `{token}`, which {name} lacks"))
}

fn transform(translation: [f64; 3], [w, x, y, z]: [f64; 4]) -> Result<Transform, String> {
    transform_from_parts(translation, [x, y, z, w])
        .ok_or_else(|| format!("the rotation [{w}, {x}, {y}, {z}], which is no unit quaternion w x y z"))
}
