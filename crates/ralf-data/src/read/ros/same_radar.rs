//! Topics that may be one radar's: raw and filtered clouds, or the same detections in two types.

use super::messages::Messages;
use super::topics::{TopicKind, Topics};

/// So many first messages of a topic are looked at.
const FIRST: usize = 10;

/// What is said of radars that measure in the same frame at the same times: as two radars they confirm each other.
pub(super) fn remarks(topics: &Topics, messages: &Messages) -> Vec<String> {
    let radars = topics.values().filter(|topic| topic.kind == TopicKind::Radar);
    let mut known: Vec<(&str, Vec<(String, i64)>)> = Vec::new();
    let mut remarks = Vec::new();
    for topic in radars {
        let first = first(messages, &topic.topic);
        if let Some((other, _)) = known.iter().find(|(_, other)| !first.is_empty() && *other == first) {
            let advice = "if they are one radar's, leave one of them out";
            remarks.push(format!("{} has the frame and the times of {other}: {advice}", topic.topic));
        }
        known.push((&topic.topic, first));
    }
    remarks
}

/// Frame and time (ns) of the first messages that can be read.
fn first(messages: &Messages, topic: &str) -> Vec<(String, i64)> {
    let container = messages.container();
    let is_own: Vec<bool> = container.topics().iter().map(|known| known.name == topic).collect();
    let of_topic = container.messages().iter().filter(|message| is_own[container.topic_of(message)]);
    let headers = of_topic.filter_map(|message| messages.read_header(message).ok());
    let told = headers.map(|header| (header.frame_id, header.stamp_ns));
    told.filter(|(_, stamp_ns)| *stamp_ns != 0).take(FIRST).collect()
}
