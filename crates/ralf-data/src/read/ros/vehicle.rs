//! A first guess of the vehicle's frame, by the tree of frames: where neither odometry nor a twist names it, and where
//! they tell of a part of the vehicle, such as an IMU.

use super::messages::Messages;
use super::survey;
use super::topics::{TopicConfig, TopicKind, Topics};
use ralf_ros::container::MessageRef;
use ralf_ros::message::TfMessage;
use std::collections::BTreeSet;

/// What vehicles call their frame (REP 105 and 120): the one on the ground first.
const VEHICLES: [&str; 2] = ["base_footprint", "base_link"];
/// Frames that no vehicle is.
const WORLDS: [&str; 5] = ["earth", "map", "odom", "utm", "world"];
/// So many messages of frames that move are looked at: they come again and again.
const FIRST: usize = 100;

/// Names the vehicle's frame with the tree of frames, where the motion's own messages don't name it, and says so.
pub(super) fn add(topics: &mut Topics, messages: &Messages) -> Option<String> {
    let all = Frames::of(messages, topics);
    let of_motion = frame_of_motion(topics, messages);
    let frame = match &of_motion {
        Some(part) => all.vehicle_of(part)?,
        None => all.vehicle()?,
    };
    let is_tree = |kind| move |topic: &&mut TopicConfig| topic.kind == kind;
    let entry = match topics.values().any(|topic| topic.kind == TopicKind::TfStatic) {
        true => topics.values_mut().find(is_tree(TopicKind::TfStatic)),
        false => topics.values_mut().find(is_tree(TopicKind::Tf)),
    };
    entry?.vehicle_frame = Some(frame.clone());
    Some(match of_motion {
        Some(part) => format!(
            "the motion is told of `{part}`, which is fixed to `{frame}`: `{frame}` is taken for the vehicle's frame"
        ),
        None => format!(
            "neither odometry nor a twist names the vehicle's frame: by the tree of frames `{frame}` is taken for it"
        ),
    })
}

/// Whether static transforms fix a frame to one that is called as vehicles are, or to the one whose motion is told.
pub(super) fn is_fixed(frame: &str, topics: &Topics, messages: &Messages) -> bool {
    let of_motion = frame_of_motion(topics, messages).filter(|part| !is_world(part));
    let vehicles = VEHICLES.into_iter().chain(of_motion.as_deref().map(plain));
    let all = Frames::of(messages, topics);
    let reached = all.fixed_to(plain(frame));
    vehicles.into_iter().any(|vehicle| reached.contains(vehicle))
}

/// The frame that messages of the odometry or the twist name.
fn frame_of_motion(topics: &Topics, messages: &Messages) -> Option<String> {
    let is_motion = |topic: &&TopicConfig| matches!(topic.kind, TopicKind::Odometry | TopicKind::Twist);
    let motion = topics.values().find(is_motion)?;
    let frame = |message: &MessageRef| {
        let bytes = messages.container().read(message).ok()?;
        survey::motion(messages, message, &bytes).ok().map(|found| found.frame)
    };
    of_topic(messages, motion).find_map(frame).filter(|frame| !frame.is_empty())
}

fn of_topic<'a>(messages: &'a Messages, topic: &'a TopicConfig) -> impl Iterator<Item = &'a MessageRef> {
    messages.container().messages().iter().filter(|message| messages.topic(message).name == topic.topic)
}

/// The frames of a recording, by how they hang on each other.
#[derive(Default)]
struct Frames {
    all: BTreeSet<String>,
    /// Those that something hangs on for good.
    parents: BTreeSet<String>,
    /// Those that hang on another one for good.
    children: BTreeSet<String>,
    /// Which two are fixed to each other.
    fixed: Vec<[String; 2]>,
}

impl Frames {
    fn of(messages: &Messages, topics: &Topics) -> Self {
        let mut frames = Self::default();
        for topic in topics.values() {
            let (is_static, most) = match topic.kind {
                TopicKind::TfStatic => (true, usize::MAX),
                TopicKind::Tf => (false, FIRST),
                _ => continue,
            };
            for message in of_topic(messages, topic).take(most) {
                let found = messages.decode::<TfMessage>(message).unwrap_or_default();
                for transform in found.transforms {
                    frames.add(&transform.header.frame_id, &transform.child_frame_id, is_static);
                }
            }
        }
        frames
    }

    fn add(&mut self, parent: &str, child: &str, is_static: bool) {
        let [parent, child] = [parent, child].map(|name| plain(name).to_owned());
        self.all.extend([parent.clone(), child.clone()]);
        if is_static {
            self.parents.insert(parent.clone());
            self.children.insert(child.clone());
            self.fixed.push([parent, child]);
        }
    }

    /// The one that is called as vehicles are and that this part is fixed to; none where the part is the vehicle.
    fn vehicle_of(&self, part: &str) -> Option<String> {
        let part = plain(part);
        if VEHICLES.contains(&part) {
            return None;
        }
        let reached = self.fixed_to(part);
        VEHICLES.into_iter().find(|name| reached.contains(name)).map(str::to_owned)
    }

    /// The frames that are fixed to this one, by way of any between, and itself.
    fn fixed_to<'a>(&'a self, part: &'a str) -> BTreeSet<&'a str> {
        let mut reached = BTreeSet::from([part]);
        let mut known = 0;
        while known < reached.len() {
            known = reached.len();
            for ends in &self.fixed {
                if ends.iter().any(|end| reached.contains(end.as_str())) {
                    reached.extend(ends.iter().map(String::as_str));
                }
            }
        }
        reached
    }

    /// The one that is called as vehicles are, or else the only one that all others hang on for good.
    fn vehicle(&self) -> Option<String> {
        if let Some(named) = VEHICLES.into_iter().find(|name| self.all.contains(*name)) {
            return Some(named.to_owned());
        }
        let mut roots = self.parents.difference(&self.children).filter(|root| !is_world(root));
        let root = roots.next()?;
        roots.next().is_none().then(|| root.clone())
    }
}

/// Whether a frame is one of those that no vehicle is.
pub(super) fn is_world(frame: &str) -> bool {
    WORLDS.contains(&plain(frame))
}

/// A frame's name without the slash that early ROS put before it.
fn plain(name: &str) -> &str {
    name.trim_start_matches('/')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frames(edges: &[(&str, &str, bool)]) -> Frames {
        let mut frames = Frames::default();
        edges.iter().for_each(|(parent, child, is_static)| frames.add(parent, child, *is_static));
        frames
    }

    fn vehicle(edges: &[(&str, &str, bool)]) -> Option<String> {
        frames(edges).vehicle()
    }

    #[test]
    fn what_a_part_is_fixed_to_is_the_vehicle() {
        let edges = [("mast", "imu", true), ("base_link", "mast", true), ("base_link", "radar", true)];
        let of = |part: &str| frames(&edges).vehicle_of(part);
        assert_eq!(of("/imu").as_deref(), Some("base_link"));
        assert_eq!(of("base_link"), None, "it is the vehicle");
        assert_eq!(of("wheel"), None, "nothing is known of it");
        let moving = [("base_link", "imu", false), ("base_link", "radar", true)];
        assert_eq!(frames(&moving).vehicle_of("imu"), None);
        let ground = [("base_footprint", "base_link", true), ("base_link", "imu", true)];
        assert_eq!(frames(&ground).vehicle_of("imu").as_deref(), Some("base_footprint"));
    }

    #[test]
    fn a_vehicle_is_known_by_its_name_or_by_what_hangs_on_it() {
        let named = |edges: &[_]| vehicle(edges).unwrap();
        assert_eq!(named(&[("/ego", "lidar", true), ("ego", "mast", true), ("mast", "radar", true)]), "ego");
        assert_eq!(
            named(&[("base_footprint", "base_link", true), ("base_link", "radar", true)]),
            "base_footprint"
        );
        assert_eq!(named(&[("body", "base_link", true), ("base_link", "radar", true)]), "base_link");
        assert_eq!(named(&[("map", "odom", true), ("odom", "car", false), ("car", "radar", true)]), "car");
        assert_eq!(named(&[("odom", "base_link", false), ("base_link", "radar", false)]), "base_link");
    }

    #[test]
    fn of_several_none_is_taken() {
        assert_eq!(vehicle(&[("left", "radar", true), ("right", "lidar", true)]), None);
        assert_eq!(vehicle(&[("odom", "car", false), ("car", "radar", false)]), None);
        assert_eq!(vehicle(&[]), None);
    }
}
