//! What a ROS recording holds, topic by topic: counts, rates, and how the sensors' times lie to the recorder's.

use super::guess::{self, Guess};
use super::messages::Messages;
use super::survey;
use super::topics::TopicKind;
use super::unread::Unread;
use crate::error::DataError;
use ralf_ros::container::{Topic, recognises};
use ralf_ros::message::{CameraInfo, Message};
use serde::Serialize;
use std::path::Path;

/// Whether this is a ROS recording.
pub fn is_ros(path: &Path) -> bool {
    recognises(path)
}

/// What a recording holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RosInspection {
    /// In the order of their names.
    pub topics: Vec<TopicInspection>,
    /// What could not be read, a sentence each.
    pub losses: Vec<String>,
}

/// What a topic holds.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TopicInspection {
    /// Its name.
    pub topic: String,
    /// Its type.
    pub type_name: String,
    /// How its messages are written.
    pub encoding: String,
    /// How many there are.
    pub count: usize,
    /// How often it delivers, by the median time between two of them, Hz: times of the headers where they are known,
    /// else of the recorder.
    pub rate_hz: Option<f64>,
    /// How far the middle half of these times lies apart, ms.
    pub jitter_ms: Option<f64>,
    /// By how much the recorder's time is later than the header's: median, ms.
    pub delay_ms: Option<f64>,
    /// The frame of the first message.
    pub frame: Option<String>,
}

/// Looks at every message of a recording, and makes a first guess of its table `topics`.
pub fn inspect(path: &Path) -> Result<(RosInspection, Guess), DataError> {
    let messages = Messages::open(path)?;
    let topics = messages.container().topics();
    let mut seen: Vec<Seen> = topics.iter().map(Seen::new).collect();
    let mut losses: Vec<String> = messages.container().losses().iter().map(ToString::to_string).collect();
    let mut unread = Unread::default();
    for message in messages.container().messages() {
        let seen = &mut seen[messages.topic_of(message)];
        seen.log_ns.push(message.log_ns);
        if !seen.has_header {
            continue;
        }
        match messages.read_header(message) {
            Ok(header) => {
                seen.stamps_ns.push(header.stamp_ns);
                seen.delays_ns.push(message.log_ns.saturating_sub(header.stamp_ns));
                seen.frame.get_or_insert(header.frame_id);
            }
            Err(error) => unread.add(messages.topic_of(message), &error),
        }
    }
    losses.extend(unread.sentences(&messages, |_| true));
    let topics = topics.iter().zip(seen).map(|(topic, seen)| seen.inspection(topic)).collect();
    Ok((RosInspection { topics, losses }, guess::of_messages(&messages)))
}

/// What was seen of a topic.
#[derive(Default)]
struct Seen {
    has_header: bool,
    log_ns: Vec<i64>,
    stamps_ns: Vec<i64>,
    delays_ns: Vec<i64>,
    frame: Option<String>,
}

impl Seen {
    fn new(topic: &Topic) -> Self {
        use TopicKind::{Camera, Imu, Odometry, Radar, Twist};
        let kinds = [Radar, Camera, Odometry, Twist, Imu];
        let known = kinds.into_iter().flat_map(survey::types).chain([&CameraInfo::DEFINITION]);
        let has_header = known.into_iter().any(|definition| definition.is(&topic.type_name));
        Self { has_header: has_header && topic.known_encoding().is_some(), ..Self::default() }
    }

    fn inspection(mut self, topic: &Topic) -> TopicInspection {
        let times = if self.stamps_ns.is_empty() { &mut self.log_ns } else { &mut self.stamps_ns };
        times.sort_unstable();
        let mut steps: Vec<i64> = times.windows(2).map(|pair| pair[1].saturating_sub(pair[0])).collect();
        let quartiles = [0.25, 0.5, 0.75].map(|share| quantile(&mut steps, share));
        let [Some(low), step, Some(high)] = quartiles else { return self.plain(topic) };
        TopicInspection {
            rate_hz: step.filter(|step| *step > 0.0).map(|step| 1e9 / step),
            jitter_ms: Some((high - low) * 1e-6),
            ..self.plain(topic)
        }
    }

    /// Without what needs two messages.
    fn plain(mut self, topic: &Topic) -> TopicInspection {
        TopicInspection {
            topic: topic.name.clone(),
            type_name: topic.type_name.clone(),
            encoding: topic.encoding.clone(),
            count: topic.count,
            rate_hz: None,
            jitter_ms: None,
            delay_ms: quantile(&mut self.delays_ns, 0.5).map(|delay| delay * 1e-6),
            frame: self.frame.take(),
        }
    }
}

/// The value below which this share of them lies; of few ones the nearest.
fn quantile(values: &mut [i64], share: f64) -> Option<f64> {
    let last = values.len().checked_sub(1)?;
    let place = (share * last as f64).round() as usize;
    Some(*values.select_nth_unstable(place).1 as f64)
}
