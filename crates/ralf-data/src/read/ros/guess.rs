//! A first guess of which topic is which sensor, from types, names and first messages.

use super::cloud::{self, Columns};
use super::messages::Messages;
use super::range_rate;
use super::same_radar;
use super::topics::{TopicConfig, TopicKind, Topics};
use super::{LABELLED, survey, vehicle};
use crate::error::DataError;
use crate::read::models::{GENERIC, LIDARS, RADARS, named_in};
use crate::tree::GROUND_TRUTH;
use ralf::sensors::Elevation;
use ralf_ros::container::Topic;
use ralf_ros::message::{CameraInfo, Definition, Message, PointCloud2, RadarScan};
use serde::Serialize;
use std::path::Path;

/// A guess, and what is to be said of it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Guess {
    /// By name.
    pub topics: Topics,
    /// What it rests on where nothing tells it, and topics of types that are known and not used, a sentence each.
    pub remarks: Vec<String>,
}

/// Fields that only radars have beside [range rates](range_rate::OF_RADARS), in whatever capitals.
const RADAR_FIELDS: [&str; 5] = ["doppler", "doppler_compensated", "rcs", "snr", "vx_comp"];

/// Parts of a topic's name that say what is published and not by whom.
const PLAIN_NAMES: [&str; 14] = [
    "points",
    "points_raw",
    "point_cloud",
    "pointcloud",
    "cloud",
    "scan",
    "detections",
    "targets",
    "image",
    "image_raw",
    "image_color",
    "image_rect",
    "image_rect_color",
    "compressed",
];

/// So many scans with detections of a topic are looked at.
const FIRST_SCANS: usize = 10;

/// A guess of the table `topics` of a recording.
pub fn guess(path: &Path) -> Result<Guess, DataError> {
    Ok(of_messages(&Messages::open(path)?))
}

pub(super) fn of_messages(messages: &Messages) -> Guess {
    let mut guess = Guess { topics: Topics::new(), remarks: Vec::new() };
    let mut of_world = Vec::new();
    let topics = messages.container().topics();
    let usable = |topic: &Topic| topic.count > 0 && topic.known_encoding().is_some();
    // One of two spellings of a type is enough to name a topic.
    let is_again = |place: usize| {
        let before = &topics[..place];
        before.iter().any(|known| {
            usable(known) && known.name == topics[place].name && is_same_kind(known, &topics[place])
        })
    };
    for (place, topic) in
        topics.iter().enumerate().filter(|(place, topic)| usable(topic) && !is_again(*place))
    {
        if topic.name.ends_with(LABELLED) {
            guess.remarks.push(format!("{} is not used: it holds what `ralf label` found", topic.name));
        } else if PointCloud2::DEFINITION.is(&topic.type_name) || RadarScan::DEFINITION.is(&topic.type_name) {
            of_world.extend(guess.add_cloud(messages, topic, place));
        } else if survey::types(TopicKind::Camera).iter().any(|known| known.is(&topic.type_name)) {
            guess.add_camera(topics, topic);
        } else if survey::types(TopicKind::Tf)[0].is(&topic.type_name) {
            let is_static = topic.name.ends_with("static");
            guess.add(TopicConfig::new(
                &topic.name,
                if is_static { TopicKind::TfStatic } else { TopicKind::Tf },
            ));
        }
    }
    guess.add_motion(topics);
    // Only now it is known which topics tell of the vehicle and its frames.
    for (entry, frame) in of_world {
        guess.add_of_world(messages, entry, &frame);
    }
    guess.remarks.extend(vehicle::add(&mut guess.topics, messages));
    guess.remarks.extend(same_radar::remarks(&guess.topics, messages));
    guess
}

/// Whether two topics can be the same sensor's, or are both frames.
fn is_same_kind(one: &Topic, other: &Topic) -> bool {
    let kinds = [TopicKind::Radar, TopicKind::Camera, TopicKind::Tf].map(survey::types);
    let fits = |topic: &Topic, types: &[&Definition]| types.iter().any(|known| known.is(&topic.type_name));
    kinds.into_iter().any(|types| fits(one, types) && fits(other, types))
}

impl Guess {
    /// A radar or a LiDAR. A LiDAR whose frame is called as the world's is handed back with that frame.
    fn add_cloud(
        &mut self,
        messages: &Messages,
        topic: &Topic,
        place: usize,
    ) -> Option<(TopicConfig, String)> {
        let of_topic =
            messages.container().messages().iter().filter(|message| messages.topic_of(message) == place);
        // What can't be read is told by whoever reads all of it.
        let mut headers = of_topic.filter_map(|message| messages.read_header(message).ok());
        let frame = headers.next().map(|header| header.frame_id).unwrap_or_default();
        let entry = cloud_entry(messages, topic, place, &frame);
        if let Some(field) = &entry.doppler {
            let taken = "is taken for the range rate, m/s and positive when receding";
            self.remarks.push(format!("{}: the field `{field}` {taken}", topic.name));
        }
        if entry.kind == TopicKind::Lidar && vehicle::is_world(&frame) {
            return Some((entry, frame));
        }
        self.add(entry);
        None
    }

    /// A LiDAR of a rig that stands still in the world; no map, whose frame nothing fixes to the vehicle.
    fn add_of_world(&mut self, messages: &Messages, entry: TopicConfig, frame: &str) {
        if vehicle::is_fixed(frame, &self.topics, messages) {
            return self.add(entry);
        }
        let why = format!("its points lie in the frame `{frame}`, which is no part of a vehicle");
        self.remarks.push(format!("{} is not used: {why}", entry.topic));
    }

    /// Under the topic's short name, or where that is taken the whole one, or that with a number. No sensor is called
    /// as the folder that labels of people lie in.
    fn add(&mut self, entry: TopicConfig) {
        let long = entry.topic.trim_matches('/').replace('/', "_");
        let numbered = (2..).map(|number| format!("{long}_{number}"));
        let mut names = [name(&entry.topic), long.clone()].into_iter().chain(numbered);
        let is_folder = |name: &str| entry.kind.is_sensor() && name.eq_ignore_ascii_case(GROUND_TRUTH);
        let is_taken = |name: &String| self.topics.contains_key(name) || is_folder(name);
        if let Some(free) = names.find(|name| !is_taken(name)) {
            self.topics.insert(free, entry);
        }
    }

    /// One topic of a camera: the first of its names, in which rectified images come before raw ones.
    fn add_camera(&mut self, topics: &[Topic], topic: &Topic) {
        let refuse =
            |guess: &mut Self, why: &str| guess.remarks.push(format!("{} is not used: {why}", topic.name));
        let info = namespaces(&topic.name).map(|space| format!("{space}/camera_info")).find(|info| {
            topics.iter().any(|known| known.name == *info && CameraInfo::DEFINITION.is(&known.type_name))
        });
        let Some(info) = info else { return refuse(self, "no camera_info beside it") };
        if is_called(topic, "depth") {
            return refuse(self, "it looks like depth");
        }
        let rectified = is_called(topic, "rect");
        let entry = TopicConfig {
            info: Some(info),
            rectified: rectified.then_some(true),
            ..TopicConfig::new(&topic.name, TopicKind::Camera)
        };
        match self.topics.values_mut().find(|known| known.info == entry.info) {
            Some(known) if rectified && known.rectified.is_none() => {
                let raw = std::mem::replace(known, entry);
                self.remarks
                    .push(format!("{} is not used: the same camera's rectified images are", raw.topic));
            }
            Some(known) => {
                let why = format!("{} is of the same camera", known.topic);
                refuse(self, &why);
            }
            None => self.add(entry),
        }
    }

    /// The odometry with the most messages, or else a twist. An IMU tells no velocity.
    fn add_motion(&mut self, topics: &[Topic]) {
        // One without messages is a vehicle's that stands still.
        let most = |kind: TopicKind| {
            let fits = |topic: &&Topic| survey::types(kind)[0].is(&topic.type_name);
            // Among equally many the first one.
            topics.iter().filter(fits).rev().max_by_key(|topic| topic.count)
        };
        let chosen = [TopicKind::Odometry, TopicKind::Twist]
            .into_iter()
            .find_map(|kind| most(kind).map(|topic| TopicConfig::new(&topic.name, kind)));
        for kind in [TopicKind::Odometry, TopicKind::Twist, TopicKind::Imu] {
            let others = topics.iter().filter(|topic| survey::types(kind)[0].is(&topic.type_name));
            for topic in
                others.filter(|topic| chosen.as_ref().is_none_or(|chosen| chosen.topic != topic.name))
            {
                let why = match &chosen {
                    Some(chosen) => format!("{} tells the motion", chosen.topic),
                    None => "it tells no velocity".to_owned(),
                };
                self.remarks.push(format!("{} is not used: {why}", topic.name));
            }
        }
        if let Some(chosen) = chosen {
            self.add(chosen);
        }
    }
}

/// A radar, if it is one by type, name or fields; else a LiDAR. Where no scan can be read, a LiDAR if it is called one.
fn cloud_entry(messages: &Messages, topic: &Topic, place: usize, frame: &str) -> TopicConfig {
    let of_topic =
        messages.container().messages().iter().filter(|message| messages.topic_of(message) == place);
    let names = [topic.name.as_str(), frame];
    let with_model = |kind, model: &str| TopicConfig {
        model: Some(model.to_owned()),
        ..TopicConfig::new(&topic.name, kind)
    };
    let scans = of_topic
        .filter_map(|message| cloud::radar_columns(messages, message, Elevation::None, None, |_| true).ok());
    let is_called_radar = is_called(topic, "radar") || named_in(&names, &RADARS) != GENERIC;
    let is_lidar = |fields: &[String]| {
        let has = |name: &&str| fields.iter().any(|known| known.eq_ignore_ascii_case(name));
        !is_called_radar && has(&"x") && !RADAR_FIELDS.iter().chain(&range_rate::OF_RADARS).any(has)
    };
    let Some(Scans { fields, heights }) = Scans::of(scans, is_lidar) else {
        return with_model(TopicKind::Lidar, named_in(&names, &LIDARS));
    };
    let is_called_lidar = is_called(topic, "lidar") || named_in(&names, &LIDARS) != GENERIC;
    if fields.is_empty() && is_called_lidar {
        return with_model(TopicKind::Lidar, named_in(&names, &LIDARS));
    }
    let has_third = fields.is_empty() || third(&fields).is_some();
    // One that measures no elevation has none to tell, or the same for all detections. One height tells nothing.
    let elevation = match heights.as_slice() {
        [] | [_] if has_third => None,
        heights => Some(heights.iter().any(|height| *height != heights[0])),
    };
    let doppler = range_rate::find(&fields).map(str::to_owned);
    TopicConfig { elevation, doppler, ..with_model(TopicKind::Radar, named_in(&names, &RADARS)) }
}

/// What the first scans of a radar with detections tell.
#[derive(Default)]
struct Scans {
    /// Those of the scans with detections, or else of the empty ones; none where no scan names any.
    fields: Vec<String>,
    /// The third coordinate of all detections.
    heights: Vec<f32>,
}

impl Scans {
    /// Looks at scans; `None` where they are a LiDAR's by their fields.
    fn of(scans: impl Iterator<Item = Columns>, is_lidar: impl Fn(&[String]) -> bool) -> Option<Self> {
        let (mut found, mut looked_at) = (Self::default(), 0);
        for Columns { names, values, rows } in scans {
            if rows > 0 && is_lidar(&names) {
                return None;
            }
            if rows > 0 || found.fields.is_empty() {
                let third = third(&names).and_then(|third| values.get(third));
                found.heights.extend(third.into_iter().flatten());
                found.fields = names;
            }
            looked_at += usize::from(rows > 0);
            if looked_at == FIRST_SCANS {
                break;
            }
        }
        Some(found).filter(|found| !is_lidar(&found.fields))
    }
}

/// Whether a topic's name has this part, however it is written.
fn is_called(topic: &Topic, part: &str) -> bool {
    topic.name.to_ascii_lowercase().contains(part)
}

/// The place of the third coordinate.
fn third(fields: &[String]) -> Option<usize> {
    fields.iter().position(|name| ["z", "elevation"].contains(&name.as_str()))
}

/// The names above a topic's, from the nearest: `/a/b` and `/a` of `/a/b/c`.
fn namespaces(topic: &str) -> impl Iterator<Item = &str> {
    std::iter::successors(topic.rsplit_once('/').map(|(above, _)| above), |name| {
        name.rsplit_once('/').map(|(above, _)| above)
    })
    .filter(|name| !name.is_empty())
}

/// What a sensor is called after its topic: `radar_front` of `/radar_front/points`.
fn name(topic: &str) -> String {
    let mut parts: Vec<&str> = topic.split('/').filter(|part| !part.is_empty()).collect();
    let is_plain = |part: &str| {
        let part = part.to_ascii_lowercase();
        PLAIN_NAMES.contains(&part.as_str()) || part.starts_with("image_")
    };
    while parts.len() > 1 && parts.last().is_some_and(|part| is_plain(part)) {
        parts.pop();
    }
    parts.join("_")
}

/// The table as it stands in a settings file, with what is to be said of the guess as comments.
pub fn topics_toml(guess: &Guess) -> Result<String, DataError> {
    // A struct, for a table would sort its keys.
    #[derive(Serialize)]
    struct Settings<'a> {
        topics: &'a Topics,
    }
    let text = toml::to_string(&Settings { topics: &guess.topics }).map_err(|error| {
        DataError::content(Path::new("topics"), "names", "what TOML can hold", error.to_string())
    })?;
    let remarks: String = guess.remarks.iter().map(|sentence| format!("# {sentence}\n")).collect();
    let head = "# Which topic is which sensor: a first guess. Say what the sensors are: `model` gives their \
                uncertainties\n\
                # and fields of view, and the tables `sensors` replace them one by one.\n";
    Ok(format!("{head}{remarks}\n{text}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sensors_are_named_after_their_topics() {
        for (topic, expected) in [
            ("/radar_front/points", "radar_front"),
            ("/cam/front/image_rect_color/compressed", "cam_front"),
            ("/RADAR_FRONT/Points", "RADAR_FRONT"),
            ("/odom", "odom"),
            ("/points", "points"),
        ] {
            assert_eq!(name(topic), expected, "{topic}");
        }
        assert_eq!(namespaces("/a/b/c").collect::<Vec<_>>(), ["/a/b", "/a"]);
    }
}
