//! What a ROS recording can't hold and settings can: which topic is which sensor, and how well each sensor measures.

use super::names::{self, Names};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::layout::degrees;
use crate::read::models::GENERIC;
use crate::read::ros::{TopicConfig, TopicKind, Topics, derives_doppler};
use ralf::config::SensorOverride;
use ralf::sensors::{Elevation, Lidar, Radar};
use ralf::space::EgoMotion;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// A settings file with these tables alone.
#[derive(Serialize)]
struct Settings {
    topics: Topics,
    sensors: BTreeMap<String, SensorOverride>,
}

/// The text of the settings by which a recording of this sequence is read back. `file` is for messages.
pub(super) fn settings(file: &Path, reader: &dyn SequenceReader) -> Result<String, DataError> {
    let sequence = reader.sequence();
    let unlike = |found| DataError::content(file, "sensors", "names that differ in ROS, too", found);
    let names = Names::of(&sequence.rig).map_err(unlike)?;
    let mut settings = Settings { topics: Topics::new(), sensors: BTreeMap::new() };
    for ((radar, name), times) in sequence.rig.radars.iter().zip(&names.radars).zip(&sequence.times.radars) {
        let elevation = Some(radar.elevation == Elevation::Measured);
        let frame = frame(name, times);
        // A range rate that the recording lacks would be one more column.
        let derive_doppler = derives_doppler(&radar.fields).then_some(false);
        let topic = cloud(name, TopicKind::Radar);
        settings.add(&radar.name, TopicConfig { elevation, derive_doppler, frame, ..topic });
        settings.sensors.insert(radar.name.clone(), of_radar(radar));
    }
    for ((lidar, name), times) in sequence.rig.lidars.iter().zip(&names.lidars).zip(&sequence.times.lidars) {
        let frame = frame(name, times);
        settings.add(&lidar.name, TopicConfig { frame, ..cloud(name, TopicKind::Lidar) });
        settings.sensors.insert(lidar.name.clone(), of_lidar(lidar));
    }
    for (camera, name) in sequence.rig.cameras.iter().zip(&names.cameras) {
        let info = Some(names::camera_info(name));
        settings.add(
            &camera.name,
            TopicConfig { info, ..TopicConfig::new(&names::image(name), TopicKind::Camera) },
        );
    }
    settings.add_motion(&sequence.motion);
    let text = toml::to_string(&settings);
    text.map_err(|error| DataError::content(file, "settings", "values that TOML can hold", error.to_string()))
}

impl Settings {
    fn add(&mut self, name: &str, topic: TopicConfig) {
        self.topics.insert(name.to_owned(), topic);
    }

    /// Where sensors are, and how the vehicle moved. These names are free, so that one that a sensor has gets longer.
    fn add_motion(&mut self, motion: &EgoMotion) {
        let (has_poses, has_odometry) = (!motion.poses().is_empty(), !motion.odometry().is_empty());
        let mut add = |name: &str, topic| {
            let mut name = name.to_owned();
            while self.topics.contains_key(&name) {
                name.push('_');
            }
            self.topics.insert(name, topic);
        };
        // No message of a motion that isn't there tells the vehicle's frame.
        let vehicle_frame = (!has_poses && !has_odometry).then(|| names::VEHICLE.to_owned());
        let mounted = TopicConfig::new(names::TF_STATIC, TopicKind::TfStatic);
        add("tf_static", TopicConfig { vehicle_frame, ..mounted });
        if has_poses {
            add("odom", TopicConfig::new(names::ODOMETRY, TopicKind::Odometry));
        }
        if has_odometry {
            add("twist", TopicConfig::new(names::TWIST, TopicKind::Twist));
        }
    }
}

/// The frame of a sensor none of whose messages tells it, for it measured nothing.
fn frame(name: &str, times: &[i64]) -> Option<String> {
    times.is_empty().then(|| name.to_owned())
}

fn cloud(name: &str, kind: TopicKind) -> TopicConfig {
    let topic = TopicConfig::new(&names::cloud(name, names::POINTS), kind);
    TopicConfig { model: Some(GENERIC.to_owned()), ..topic }
}

fn of_radar(radar: &Radar) -> SensorOverride {
    let reliability = radar.reliability.table().iter().map(|(azimuth, value)| [degrees(*azimuth), *value]);
    SensorOverride {
        sigma_range_m: Some(radar.sigma_range),
        sigma_azimuth_deg: Some(degrees(radar.sigma_azimuth)),
        sigma_elevation_deg: Some(degrees(radar.sigma_elevation)),
        fov_azimuth_deg: Some(degrees(radar.fov_azimuth)),
        fov_elevation_deg: Some(degrees(radar.fov_elevation)),
        reliability: Some(reliability.collect()),
        ..SensorOverride::default()
    }
}

fn of_lidar(lidar: &Lidar) -> SensorOverride {
    SensorOverride {
        sigma_range_m: Some(lidar.sigma_range),
        lowest_beam_deg: Some(degrees(lidar.lowest_beam)),
        max_range_m: lidar.max_range,
        ..SensorOverride::default()
    }
}
