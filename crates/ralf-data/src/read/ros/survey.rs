//! One look at every message that matters, in the order of the file: times, motion, frames, calibrations.

use super::camera;
use super::frames::Frames;
use super::messages::Messages;
use super::topics::{Stamps, TopicConfig, TopicKind, Topics};
use super::track::{Track, has_unstamped};
use super::unread::Unread;
use crate::error::DataError;
use ralf_ros::container::MessageRef;
use ralf_ros::message::{
    CameraInfo, CompressedImage, Definition, Image, Imu, Message, Odometry, PointCloud2, Pose, RadarScan,
    TfMessage, Twist, TwistStamped,
};
use ralf_ros::tf::Kind;
use std::collections::BTreeMap;

/// What a recording holds of the topics that were asked for.
#[derive(Default)]
pub(super) struct Survey {
    /// Radars, LiDARs and cameras, by name.
    pub(super) sensors: BTreeMap<String, Track>,
    /// Odometry, twists and IMUs, by name.
    pub(super) motion: BTreeMap<String, MotionTrack>,
    pub(super) frames: Frames,
    /// The calibration of each camera, by the place of its topic.
    pub(super) infos: BTreeMap<usize, (MessageRef, CameraInfo)>,
    /// Messages that can't be read. Those of sensors stand in their tracks, too.
    pub(super) unread: Unread,
    /// What is said of messages that were sent before their driver knew the time, a sentence each.
    unstamped: Vec<String>,
}

/// What a topic tells of the vehicle's motion.
#[derive(Default)]
pub(super) struct MotionTrack {
    /// The frame of the poses.
    pub(super) fixed_frame: String,
    /// The frame whose poses and twists these are.
    pub(super) frame: String,
    /// In time order, one per time.
    pub(super) samples: Vec<MotionSample>,
}

/// One message of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct MotionSample {
    pub(super) t_ns: i64,
    pub(super) pose: Pose,
    pub(super) twist: Twist,
}

/// What a message is needed for.
#[derive(Clone, Copy)]
enum Role<'a> {
    Sensor(&'a str, &'a TopicConfig),
    Motion(&'a str, &'a TopicConfig),
    Frames(Kind),
    Calibration,
}

/// Why a message tells nothing.
enum Trouble {
    /// It can't be read: what is lost is told, and the others are good.
    Unreadable(DataError),
    /// It contradicts those before it: the recording is refused.
    Contradiction(DataError),
}

impl From<DataError> for Trouble {
    fn from(error: DataError) -> Self {
        Self::Unreadable(error)
    }
}

/// The types that a topic of this kind may have.
pub(super) fn types(kind: TopicKind) -> &'static [&'static Definition] {
    match kind {
        TopicKind::Radar => &[PointCloud2::DEFINITION, RadarScan::DEFINITION],
        TopicKind::Lidar => &[PointCloud2::DEFINITION],
        TopicKind::Camera => &[CompressedImage::DEFINITION, Image::DEFINITION],
        TopicKind::Odometry => &[Odometry::DEFINITION],
        TopicKind::Twist => &[TwistStamped::DEFINITION, Odometry::DEFINITION],
        TopicKind::Imu => &[Imu::DEFINITION],
        TopicKind::Tf | TopicKind::TfStatic => &[TfMessage::DEFINITION],
    }
}

/// The places of a camera's calibration among the topics.
pub(super) fn info_topics(
    messages: &Messages,
    name: &str,
    topic: &TopicConfig,
) -> Result<Vec<usize>, DataError> {
    let info = topic.info.as_deref().unwrap_or_default();
    messages.resolve(&format!("topics.{name}.info"), info, &[CameraInfo::DEFINITION])
}

/// Looks at all messages of these topics.
pub(super) fn survey(messages: &Messages, topics: &Topics) -> Result<Survey, DataError> {
    let roles = roles(messages, topics)?;
    let mut survey = Survey::default();
    for message in messages.container().messages() {
        let roles = &roles[messages.topic_of(message)];
        if roles.is_empty() {
            continue;
        }
        let found = match messages.container().read(message) {
            Ok(bytes) => roles.iter().try_for_each(|role| survey.look(messages, message, &bytes, *role)),
            Err(error) => Err(Trouble::Unreadable(error.into())),
        };
        match found {
            Ok(()) => {}
            Err(Trouble::Contradiction(error) | Trouble::Unreadable(error @ DataError::Io { .. })) => {
                return Err(error);
            }
            Err(Trouble::Unreadable(error)) => survey.miss(messages, message, roles, &error),
        }
    }
    survey.check_complete(messages, topics)?;
    survey.sort(messages, topics)?;
    Ok(survey)
}

fn roles<'a>(messages: &Messages, topics: &'a Topics) -> Result<Vec<Vec<Role<'a>>>, DataError> {
    let mut roles: Vec<Vec<Role<'_>>> = vec![Vec::new(); messages.container().topics().len()];
    for (name, topic) in topics {
        if messages.is_silent(&topic.topic) {
            continue;
        }
        let role = match topic.kind {
            TopicKind::Radar | TopicKind::Lidar | TopicKind::Camera => Role::Sensor(name, topic),
            TopicKind::Odometry | TopicKind::Twist | TopicKind::Imu => Role::Motion(name, topic),
            TopicKind::Tf => Role::Frames(Kind::Moving),
            TopicKind::TfStatic => Role::Frames(Kind::Static),
        };
        for place in messages.resolve(&format!("topics.{name}"), &topic.topic, types(topic.kind))? {
            roles[place].push(role);
        }
        if topic.kind == TopicKind::Camera {
            for info in info_topics(messages, name, topic)? {
                if roles[info].is_empty() {
                    roles[info].push(Role::Calibration);
                }
            }
        }
    }
    Ok(roles)
}

impl Survey {
    /// When the first measurement of any sensor was made, ns.
    pub(super) fn first_time(&self) -> i64 {
        let spans = self.sensors.values().filter_map(Track::span);
        spans.map(|[first, _]| first).min().unwrap_or_default()
    }

    /// Whether a topic tells of the motion.
    pub(super) fn tells(&self, name: &str) -> bool {
        self.motion.contains_key(name)
    }

    /// What is said of the tree of frames: messages that can't be read, transforms that are not used.
    pub(super) fn lost_frames(&self, messages: &Messages) -> Vec<String> {
        let topics = messages.container().topics();
        let unread =
            self.unread.sentences(messages, |topic| TfMessage::DEFINITION.is(&topics[topic].type_name));
        unread.into_iter().chain(self.frames.left_out(messages)).collect()
    }

    /// What is said of messages without a time; of those that can't be read, but those of sensors, which are named one
    /// by one; and of the transforms that are not used.
    pub(super) fn losses(&self, messages: &Messages, topics: &Topics) -> Vec<String> {
        let is_sensor = |name: &str| {
            topics.iter().any(|(sensor, topic)| topic.topic == name && self.sensors.contains_key(sensor))
        };
        let topics = messages.container().topics();
        let unread = self.unread.sentences(messages, |topic| !is_sensor(&topics[topic].name));
        let unstamped = self.unstamped.iter().cloned();
        unstamped.chain(unread).chain(self.frames.left_out(messages)).collect()
    }

    /// Takes what a message says.
    fn look(
        &mut self,
        messages: &Messages,
        message: &MessageRef,
        bytes: &[u8],
        role: Role<'_>,
    ) -> Result<(), Trouble> {
        match role {
            Role::Sensor(name, topic) => {
                let header = messages.header(message, bytes)?;
                let track = self.sensors.entry(name.to_owned()).or_default();
                same_frame(messages, message, &mut track.frame, &header.frame_id)?;
                track.readable.push((time(topic, header.stamp_ns, message), *message));
            }
            Role::Motion(name, topic) => {
                let found = motion(messages, message, bytes)?;
                let track = self.motion.entry(name.to_owned()).or_default();
                same_frame(messages, message, &mut track.fixed_frame, &found.fixed_frame)?;
                same_frame(messages, message, &mut track.frame, &found.frame)?;
                let samples = found.samples.into_iter();
                track.samples.extend(
                    samples.map(|sample| MotionSample { t_ns: time(topic, sample.t_ns, message), ..sample }),
                );
            }
            Role::Frames(kind) => {
                let found = messages.decoded(message, bytes, TfMessage::from_bytes)?;
                found.transforms.iter().for_each(|transform| self.frames.add(message, transform, kind));
            }
            Role::Calibration => self.calibrate(messages, message, bytes)?,
        }
        Ok(())
    }

    /// Notes a message that can't be read.
    fn miss(&mut self, messages: &Messages, message: &MessageRef, roles: &[Role<'_>], error: &DataError) {
        self.unread.add(messages.topic_of(message), error);
        for role in roles {
            if let Role::Sensor(name, _) = role {
                self.sensors.entry((*name).to_owned()).or_default().unreadable.push(*message);
            }
        }
    }

    /// Keeps the first calibration; one that changes is refused, for the rig has one.
    fn calibrate(&mut self, messages: &Messages, message: &MessageRef, bytes: &[u8]) -> Result<(), Trouble> {
        let info = messages.decoded(message, bytes, CameraInfo::from_bytes)?;
        let (_, known) =
            self.infos.entry(messages.topic_of(message)).or_insert_with(|| (*message, info.clone()));
        if camera::is_same(&info, known) {
            return Ok(());
        }
        let expected = "the calibration of the messages before";
        Err(Trouble::Contradiction(messages.error(message, "values", expected, "another one")))
    }

    /// Refuses a recording of which nothing is left of a topic that tells of the motion.
    fn check_complete(&self, messages: &Messages, topics: &Topics) -> Result<(), DataError> {
        let is_read = |name: &String, topic: &TopicConfig| {
            matches!(topic.kind, TopicKind::Tf | TopicKind::TfStatic)
                || messages.is_silent(&topic.topic)
                || self.sensors.contains_key(name)
                || self.tells(name)
        };
        let Some((_, topic)) = topics.iter().find(|(name, topic)| !is_read(name, topic)) else {
            return Ok(());
        };
        let all = messages.container().topics().iter().enumerate();
        let mut named = all.filter(|(_, known)| known.name == topic.topic);
        let reason = named.find_map(|(place, _)| self.unread.reason(place)).unwrap_or_default();
        let found = format!("none; the first: {reason}");
        Err(DataError::content(messages.path(), &topic.topic, "a message that can be read", found))
    }

    fn sort(&mut self, messages: &Messages, topics: &Topics) -> Result<(), DataError> {
        for (name, track) in &mut self.sensors {
            let (count, all) = (track.stamp_unstamped(), track.readable.len());
            let done = "they take the recorder's, less the usual delay";
            self.unstamped.extend(unstamped(&topics[name], count, all, done));
            track.readable.sort_by_key(|(t_ns, _)| *t_ns);
            check_stamps(messages, name, topics, track.readable.iter().map(|(t_ns, _)| *t_ns))?;
        }
        for (name, track) in &mut self.motion {
            if has_unstamped(track.samples.iter().map(|sample| sample.t_ns)) {
                let all = track.samples.len();
                track.samples.retain(|sample| sample.t_ns != 0);
                let count = all - track.samples.len();
                self.unstamped.extend(unstamped(&topics[name], count, all, "they are not used"));
            }
            track.samples.sort_by_key(|sample| sample.t_ns);
            check_stamps(messages, name, topics, track.samples.iter().map(|sample| sample.t_ns))?;
            track.samples.dedup_by_key(|sample| sample.t_ns);
        }
        Ok(())
    }
}

/// What is said of so many of a topic's messages that have no time, if there are any.
fn unstamped(topic: &TopicConfig, count: usize, all: usize, done: &str) -> Option<String> {
    (count > 0).then(|| {
        format!("{}: {count} of {all} messages have no time (header.stamp is 0): {done}", topic.topic)
    })
}

/// Refuses a topic whose driver doesn't tell the time.
fn check_stamps(
    messages: &Messages,
    name: &str,
    topics: &Topics,
    mut times: impl ExactSizeIterator<Item = i64>,
) -> Result<(), DataError> {
    if times.len() < 2 || times.any(|t_ns| t_ns != 0) {
        return Ok(());
    }
    let place = format!("{}, header.stamp", topics[name].topic);
    let expected = format!("times (`topics.{name}.stamps = \"log\"` takes those of the recorder)");
    Err(DataError::content(messages.path(), place, expected, "0 in every message"))
}

fn time(topic: &TopicConfig, stamp_ns: i64, message: &MessageRef) -> i64 {
    if topic.stamps == Some(Stamps::Log) { message.log_ns } else { stamp_ns }
}

/// Refuses a topic whose messages are of several frames.
fn same_frame(
    messages: &Messages,
    message: &MessageRef,
    known: &mut String,
    found: &str,
) -> Result<(), Trouble> {
    if known.is_empty() {
        found.clone_into(known);
    }
    // Frames of ROS 1 may be called with a slash, and are the same ones.
    if known.trim_start_matches('/') == found.trim_start_matches('/') {
        return Ok(());
    }
    let expected = format!("`{known}` as in the messages before");
    Err(Trouble::Contradiction(messages.error(message, "frame", expected, format!("`{found}`"))))
}

/// What a message tells of the motion, as a track of one sample.
pub(super) fn motion(
    messages: &Messages,
    message: &MessageRef,
    bytes: &[u8],
) -> Result<MotionTrack, DataError> {
    let type_name = &messages.topic(message).type_name;
    let (header, frame, pose, twist) = if Odometry::DEFINITION.is(type_name) {
        let found = messages.decoded(message, bytes, Odometry::from_bytes)?;
        (found.header, found.child_frame_id, found.pose, found.twist)
    } else if TwistStamped::DEFINITION.is(type_name) {
        let found = messages.decoded(message, bytes, TwistStamped::from_bytes)?;
        let frame = found.header.frame_id.clone();
        (found.header, frame, Pose::default(), found.twist)
    } else {
        let found = messages.decoded(message, bytes, Imu::from_bytes)?;
        let (frame, angular) = (found.header.frame_id.clone(), found.angular_velocity);
        (found.header, frame, Pose::default(), Twist { angular, ..Twist::default() })
    };
    let sample = MotionSample { t_ns: header.stamp_ns, pose, twist };
    Ok(MotionTrack { fixed_frame: header.frame_id, frame, samples: vec![sample] })
}
