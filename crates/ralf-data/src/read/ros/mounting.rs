//! How sensors are mounted: from the tree of frames, which has to say the same for the whole recording.

use super::messages::Messages;
use super::survey::Survey;
use super::topics::{TopicConfig, TopicKind, Topics};
use crate::error::DataError;
use ralf::space::Transform;
use ralf_ros::tf::{SAME_PLACE, is_same_place};

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
    let refused = |expected: String, found: String| {
        Err(DataError::content(messages.path(), format!("frame `{frame}`"), expected, found))
    };
    let chain = match survey.frames.chain(vehicle, frame) {
        Ok(chain) => chain,
        Err(error) => {
            let expected =
                format!("a transform from `{vehicle}` in the topics of the kinds tf and tf_static");
            let lost = survey.lost_frames(messages).into_iter().map(|sentence| format!("; {sentence}"));
            return refused(expected, error.to_string() + &lost.collect::<String>());
        }
    };
    survey.frames.check(messages, &chain)?;
    // Outside of what is told nobody says that it moved.
    let mounted = chain.held_at(span[0]);
    let mut places = chain.told(span).into_iter().chain(span).map(|t_ns| (t_ns, chain.held_at(t_ns)));
    let Some((t_ns, place)) = places.find(|(_, place)| !is_same_place(&mounted, place)) else {
        return Ok(mounted);
    };
    let [metres, radians] = SAME_PLACE;
    let expected = format!(
        "a sensor that doesn't move on `{vehicle}`, by {} mm or {:.1} deg at most",
        metres * 1e3,
        radians.to_degrees()
    );
    let (before, after) = (told(&mounted), told(&place));
    refused(expected, format!("{before} at {} ns, and {after} at {t_ns} ns", span[0]))
}

/// A place as people read it.
fn told(place: &Transform) -> String {
    // No zero has a sign.
    let rounded = |value: f64, steps: f64| (value * steps).round() / steps + 0.0;
    let [x, y, z] = place.translation.vector.map(|metres| rounded(metres, 1e3)).into();
    let (roll, pitch, yaw) = place.rotation.euler_angles();
    let [yaw, pitch, roll] = [yaw, pitch, roll].map(|angle| rounded(angle.to_degrees(), 1e2));
    format!("x {x:.3}, y {y:.3}, z {z:.3} m, yaw {yaw:.2}, pitch {pitch:.2}, roll {roll:.2} deg")
}

/// The frame of a sensor: as the settings say, or else that of its messages.
pub(super) fn sensor_frame<'a>(topic: &'a TopicConfig, of_messages: &'a str) -> &'a str {
    topic.frame.as_deref().unwrap_or(of_messages)
}
