//! A first guess of the vehicle's frame, where neither odometry nor a twist names it: by the tree of frames.

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

/// Names the vehicle's frame with the tree of frames, if nothing else of these topics does, and says so.
pub(super) fn add(topics: &mut Topics, messages: &Messages) -> Option<String> {
    if is_named(topics, messages) {
        return None;
    }
    let all = Frames::of(messages, topics);
    let frame = all.vehicle()?;
    let is_tree = |kind| move |topic: &&mut TopicConfig| topic.kind == kind;
    let entry = match topics.values().any(|topic| topic.kind == TopicKind::TfStatic) {
        true => topics.values_mut().find(is_tree(TopicKind::TfStatic)),
        false => topics.values_mut().find(is_tree(TopicKind::Tf)),
    };
    entry?.vehicle_frame = Some(frame.clone());
    Some(format!(
        "neither odometry nor a twist names the vehicle's frame: by the tree of frames `{frame}` is taken for it"
    ))
}

/// Whether messages of the odometry or the twist name the vehicle's frame.
fn is_named(topics: &Topics, messages: &Messages) -> bool {
    let is_motion = |topic: &&TopicConfig| matches!(topic.kind, TopicKind::Odometry | TopicKind::Twist);
    let Some(motion) = topics.values().find(is_motion) else { return false };
    let frame = |message: &MessageRef| {
        let bytes = messages.container().read(message).ok()?;
        survey::motion(messages, message, &bytes).ok().map(|found| found.frame)
    };
    let first = of_topic(messages, motion).find_map(frame);
    first.is_some_and(|frame| !frame.is_empty())
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
        let [parent, child] = [parent, child].map(|name| name.trim_start_matches('/').to_owned());
        self.all.extend([parent.clone(), child.clone()]);
        if is_static {
            self.parents.insert(parent);
            self.children.insert(child);
        }
    }

    /// The one that is called as vehicles are, or else the only one that all others hang on for good.
    fn vehicle(&self) -> Option<String> {
        if let Some(named) = VEHICLES.into_iter().find(|name| self.all.contains(*name)) {
            return Some(named.to_owned());
        }
        let is_world = |frame: &&String| WORLDS.contains(&frame.as_str());
        let mut roots = self.parents.difference(&self.children).filter(|root| !is_world(root));
        let root = roots.next()?;
        roots.next().is_none().then(|| root.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn vehicle(edges: &[(&str, &str, bool)]) -> Option<String> {
        let mut frames = Frames::default();
        edges.iter().for_each(|(parent, child, is_static)| frames.add(parent, child, *is_static));
        frames.vehicle()
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
