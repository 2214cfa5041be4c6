//! How sensors are mounted: from the tree of frames, which has to say the same for the whole recording.

use super::messages::Messages;
use super::survey::Survey;
use super::topics::{TopicConfig, TopicKind, Topics};
use crate::error::DataError;
use ralf::space::Transform;

/// The vehicle's frame: as the settings say, or else that of the odometry, or else that of the twist.
pub(super) fn vehicle_frame(
    messages: &Messages,
    topics: &Topics,
    survey: &Survey,
) -> Result<String, DataError> {
    if let Some(frame) = topics.values().find_map(|topic| topic.vehicle_frame.clone()) {
        return Ok(frame);
    }
    let of_kind = |kind| {
        let name = topics.iter().find(|(_, topic)| topic.kind == kind).map(|(name, _)| name)?;
        Some(survey.motion.get(name)?.frame.clone())
    };
    let known = of_kind(TopicKind::Odometry).or_else(|| of_kind(TopicKind::Twist));
    known.filter(|frame| !frame.is_empty()).ok_or_else(|| {
        let expected = "`vehicle_frame` with one of the topics (`topics.tf_static.vehicle_frame = \"base_link\"`), or \
                        odometry or a twist whose messages name it";
        DataError::content(messages.path(), "topics", expected, "neither")
    })
}

/// `vehicle_from_sensor`, over a span of time (ns).
pub(super) fn mounting(
    messages: &Messages,
    survey: &Survey,
    vehicle: &str,
    frame: &str,
    span: [i64; 2],
) -> Result<Transform, DataError> {
    if frame.trim_start_matches('/') == vehicle.trim_start_matches('/') {
        return Ok(Transform::identity());
    }
    let at = |t_ns| {
        survey.frames.lookup(vehicle, frame, t_ns).map_err(|error| {
            let place = format!("frame `{frame}`");
            let expected =
                format!("a transform from `{vehicle}` in the topics of the kinds tf and tf_static");
            let unread = survey.unread_frames(messages).into_iter().map(|sentence| format!("; {sentence}"));
            DataError::content(
                messages.path(),
                place,
                expected,
                error.to_string() + &unread.collect::<String>(),
            )
        })
    };
    let [first, last] = [at(span[0])?, at(span[1])?];
    if first == last {
        return Ok(first);
    }
    let expected = format!("a sensor that doesn't move on `{vehicle}`");
    Err(DataError::content(
        messages.path(),
        format!("frame `{frame}`"),
        expected,
        format!("{first} and {last}"),
    ))
}

/// The frame of a sensor: as the settings say, or else that of its messages.
pub(super) fn sensor_frame<'a>(topic: &'a TopicConfig, of_messages: &'a str) -> &'a str {
    topic.frame.as_deref().unwrap_or(of_messages)
}
