//! The vehicle's motion, from odometry, twists and IMUs.

use super::messages::Messages;
use super::mounting::{mounting, sensor_frame};
use super::survey::{MotionSample, MotionTrack, Survey};
use super::topics::{TopicConfig, TopicKind, Topics};
use crate::error::DataError;
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform, Vector, transform_from_parts};

/// A vehicle whose poses lie this far from the first has moved, m: those of a parked one wander less.
const MOVED: f64 = 2.0;
/// A frame that slips sideways by more than so much of its way, and m/s, isn't where the vehicle's axes meet its rear
/// wheels: there nothing but a skid does.
const SIDEWAYS: [f64; 2] = [0.02, 0.1];
/// It does so in more than one of so many messages.
const SEVERAL: usize = 20;
/// Messages without a pose are passed over where those before and after them that have one lie at most this far apart,
/// ns: a straight line tells too little of a longer way.
const BRIDGED_NS: i64 = 1_000_000_000;

/// A topic of the motion: its settings, what it holds, and `vehicle_from_child` of its frame.
struct Part<'a> {
    track: &'a MotionTrack,
    vehicle_from_child: Transform,
    topic: &'a TopicConfig,
}

/// Poses from the odometry; velocity and yaw rate from it or from a twist; the yaw rate from an IMU where there is one.
pub(super) fn motion(
    messages: &Messages,
    topics: &Topics,
    survey: &Survey,
    vehicle: &str,
    warnings: &mut Vec<String>,
) -> Result<EgoMotion, DataError> {
    let odometry = part(messages, topics, survey, vehicle, TopicKind::Odometry)?;
    let twist = part(messages, topics, survey, vehicle, TopicKind::Twist)?;
    let imu = part(messages, topics, survey, vehicle, TopicKind::Imu)?;
    let poses = odometry.as_ref().map_or_else(|| Ok(Vec::new()), |part| part.poses(messages, warnings))?;
    let moving = twist.or(odometry);
    let mut wheels = moving.as_ref().map_or_else(Vec::new, |part| part.velocities(&poses, warnings));
    let idle = topics.iter().filter(|(name, topic)| topic.kind == TopicKind::Imu && !survey.tells(name));
    warnings.extend(idle.map(|(_, topic)| format!("{}: no messages", topic.topic)));
    if let Some(imu) = imu {
        let rates = imu.numbers(warnings);
        // An IMU that tells no number takes the place of nothing.
        for sample in wheels.iter_mut().filter(|_| !rates.is_empty()) {
            sample.yaw_rate = yaw_rate(&rates, sample.t_ns);
        }
    }
    if let (None, true, Some(topic)) = (moving, poses.is_empty(), silent(topics)) {
        warnings.push(format!("{}: no messages: the vehicle is taken to stand still", topic.topic));
        wheels.push(OdometrySample { t_ns: survey.first_time(), velocity: 0.0, yaw_rate: 0.0 });
    }
    // Where no topic tells it, another trajectory or the radars have to.
    Ok(EgoMotion::new(wheels, poses).unwrap_or_else(EgoMotion::unknown))
}

/// The topic that would tell how the vehicle moves; asked where none has.
fn silent(topics: &Topics) -> Option<&TopicConfig> {
    topics.values().find(|topic| matches!(topic.kind, TopicKind::Odometry | TopicKind::Twist))
}

fn part<'a>(
    messages: &Messages,
    topics: &'a Topics,
    survey: &'a Survey,
    vehicle: &str,
    kind: TopicKind,
) -> Result<Option<Part<'a>>, DataError> {
    let mut of_kind = topics.iter().filter(|(_, topic)| topic.kind == kind);
    let Some((name, topic)) = of_kind.next() else { return Ok(None) };
    if let Some((second, _)) = of_kind.next() {
        let found = format!("`{name}` and `{second}`");
        return Err(DataError::content(
            messages.path(),
            "topics",
            format!("one topic of the kind {kind:?}"),
            found,
        ));
    }
    let Some(track) = survey.motion.get(name) else { return Ok(None) };
    let span = track.samples.first().zip(track.samples.last()).map_or([0; 2], |(a, b)| [a.t_ns, b.t_ns]);
    let frame = sensor_frame(topic, &track.frame);
    // Odometry whose messages name no frame is the vehicle's, whose frame the settings name then.
    let frame = if frame.is_empty() { vehicle } else { frame };
    let vehicle_from_child = mounting(messages, survey, vehicle, frame, span)?;
    Ok(Some(Part { track, vehicle_from_child, topic }))
}

impl Part<'_> {
    /// The poses; a warning counts the messages that have none, as of programs that have just begun. Refused where a
    /// part of the drive has none.
    fn poses(&self, messages: &Messages, warnings: &mut Vec<String>) -> Result<Vec<PoseSample>, DataError> {
        let child_from_vehicle = self.vehicle_from_child.inverse();
        let pose = |sample: &MotionSample| {
            let odom_from_vehicle = fixed_from_child(sample)? * child_from_vehicle;
            Some(PoseSample { t_ns: sample.t_ns, odom_from_vehicle })
        };
        let samples = &self.track.samples;
        let poses: Vec<PoseSample> = samples.iter().filter_map(pose).collect();
        let (topic, all, lost) = (&self.topic.topic, samples.len(), samples.len() - poses.len());
        if let Some(first) = first_missing(samples) {
            let place = format!("{topic} at {} ns", first.t_ns);
            let seconds = BRIDGED_NS / 1_000_000_000;
            let expected = format!(
                "a finite position and a unit quaternion, from the first of them to the last at least every \
                 {seconds} s (the kind twist takes the velocities alone)"
            );
            return Err(DataError::content(messages.path(), place, expected, format!("{:?}", first.pose)));
        }
        if lost > 0 {
            warnings.push(format!(
                "{topic}: {lost} of {all} messages have no pose (a finite position and a unit quaternion), and are \
                 not used"
            ));
        }
        Ok(poses)
    }

    /// The samples that are used: of an odometry those with a pose.
    fn samples(&self) -> impl Iterator<Item = &MotionSample> {
        let has_poses = self.topic.kind == TopicKind::Odometry;
        self.track.samples.iter().filter(move |sample| !has_poses || fixed_from_child(sample).is_some())
    }

    /// The twists that tell a velocity. Programs that estimate poses alone leave theirs at zero or NaN: where the poses
    /// move and no velocity does, there are none, so that the poses tell it.
    fn velocities(&self, poses: &[PoseSample], warnings: &mut Vec<String>) -> Vec<OdometrySample> {
        let mut told = self.numbers(warnings);
        let name = &self.topic.topic;
        let is_zero = |sample: &MotionSample| sample.twist.linear.iter().all(|v| *v == 0.0 || !v.is_finite());
        let metres = farthest(poses);
        if !told.is_empty() && metres >= MOVED && self.samples().all(is_zero) {
            warnings.push(format!(
                "{name}: all its velocities are 0 while the poses move by {metres:.0} m: they are not used, and the \
                 poses tell how fast the vehicle is"
            ));
            told.clear();
        }
        self.leave_slipping_to_poses(poses, told, warnings)
    }

    /// Velocities are told along the vehicle's x alone. Where the vehicle's origin goes sideways in turns, its poses
    /// tell it whole; without poses it is said what is missing.
    fn leave_slipping_to_poses(
        &self,
        poses: &[PoseSample],
        mut told: Vec<OdometrySample>,
        warnings: &mut Vec<String>,
    ) -> Vec<OdometrySample> {
        let [share, least] = SIDEWAYS;
        let slips = |velocity: &&Vector| velocity.y.abs() > (share * velocity.x.abs()).max(least);
        let velocities: Vec<Vector> = self.samples().map(|sample| self.velocity(sample)).collect();
        if told.is_empty() || SEVERAL * velocities.iter().filter(slips).count() <= velocities.len() {
            return told;
        }
        let most = velocities.iter().map(|velocity| velocity.y.abs()).fold(0.0, f64::max);
        let name = &self.topic.topic;
        let found = format!("{name}: the vehicle's frame goes sideways, by up to {most:.1} m/s");
        if poses.len() > 1 {
            warnings.push(format!(
                "{found}: its velocities are not used, and the poses tell how fast the vehicle is"
            ));
            told.clear();
        } else {
            warnings.push(format!(
                "{found}, which is not used: a frame above the rear axle (`vehicle_frame`) does not"
            ));
        }
        told
    }

    /// The velocity of the vehicle's origin, in the vehicle's axes, whatever frame was measured in.
    fn velocity(&self, sample: &MotionSample) -> Vector {
        let Transform { rotation, translation } = &self.vehicle_from_child;
        let turn = rotation * Vector::from(sample.twist.angular);
        // A rigid body: the child's origin, at the lever's end, moves as the vehicle's does, and by `turn x lever`.
        rotation * Vector::from(sample.twist.linear) - turn.cross(&translation.vector)
    }

    /// The twists that are numbers; a warning counts the others.
    fn numbers(&self, warnings: &mut Vec<String>) -> Vec<OdometrySample> {
        let mut told = self.twists();
        let (name, all) = (&self.topic.topic, told.len());
        told.retain(|sample| sample.velocity.is_finite() && sample.yaw_rate.is_finite());
        if told.len() < all {
            let lost = all - told.len();
            warnings.push(format!("{name}: {lost} of {all} twists are no numbers, and not used"));
        }
        told
    }

    /// Along the vehicle's x and about its z: at the vehicle's origin, whatever frame was measured in.
    fn twists(&self) -> Vec<OdometrySample> {
        let twist = |sample: &MotionSample| {
            let turn = self.vehicle_from_child.rotation * Vector::from(sample.twist.angular);
            OdometrySample { t_ns: sample.t_ns, velocity: self.velocity(sample).x, yaw_rate: turn.z }
        };
        self.samples().map(twist).collect()
    }
}

/// The pose of a message, if it has one.
fn fixed_from_child(sample: &MotionSample) -> Option<Transform> {
    transform_from_parts(sample.pose.position, sample.pose.orientation)
}

/// The first message without a pose that can't be passed over, in time order: of all where none has one, or of those
/// between two poses that lie far apart.
fn first_missing(samples: &[MotionSample]) -> Option<&MotionSample> {
    let (mut before, mut missing) = (None, None);
    for sample in samples {
        if fixed_from_child(sample).is_none() {
            missing = missing.or(Some(sample));
            continue;
        }
        let is_far = |t_ns: i64| sample.t_ns.saturating_sub(t_ns) > BRIDGED_NS;
        if missing.is_some() && before.is_some_and(is_far) {
            return missing;
        }
        (before, missing) = (Some(sample.t_ns), None);
    }
    missing.filter(|_| before.is_none())
}

/// How far from the first the farthest pose lies, m.
fn farthest(poses: &[PoseSample]) -> f64 {
    let place = |pose: &PoseSample| pose.odom_from_vehicle.translation.vector;
    let first = poses.first().map(place).unwrap_or_default();
    poses.iter().map(|pose| (place(pose) - first).norm()).fold(0.0, f64::max)
}

/// Linear between two samples, held outside of them.
fn yaw_rate(rates: &[OdometrySample], t_ns: i64) -> f64 {
    let after = rates.partition_point(|sample| sample.t_ns <= t_ns);
    match (after.checked_sub(1).map(|before| rates[before]), rates.get(after)) {
        (Some(a), Some(b)) => {
            let share = (t_ns - a.t_ns) as f64 / (b.t_ns - a.t_ns) as f64;
            a.yaw_rate + (b.yaw_rate - a.yaw_rate) * share
        }
        (Some(only), None) => only.yaw_rate,
        (None, Some(only)) => only.yaw_rate,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_ros::message::{Pose, Twist};

    #[test]
    fn twists_are_moved_to_the_vehicle() {
        // An antenna 2 m ahead and turned to the left by a right angle; the vehicle turns left by 0.5 rad/s at 10 m/s.
        // The antenna's origin moves by (10, 0.5 * 2) in the vehicle's axes, which are (1, -10) in its own.
        let quarter = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, std::f64::consts::FRAC_PI_2);
        let vehicle_from_child = Transform::from_parts(nalgebra::Translation3::new(2.0, 0.0, 0.0), quarter);
        let twist = Twist { linear: [1.0, -10.0, 0.0], angular: [0.0, 0.0, 0.5] };
        let sample = MotionSample { t_ns: 7, pose: Pose::default(), twist };
        let track = MotionTrack { samples: vec![sample], ..MotionTrack::default() };
        let topic = TopicConfig::new("/twist", TopicKind::Twist);
        let twists = Part { track: &track, vehicle_from_child, topic: &topic }.twists();
        assert!(
            (twists[0].velocity - 10.0).abs() < 1e-12 && (twists[0].yaw_rate - 0.5).abs() < 1e-12,
            "{twists:?}"
        );
    }

    #[test]
    fn yaw_rates_are_interpolated_and_held() {
        let rate = |t_ns, yaw_rate| OdometrySample { t_ns, velocity: 0.0, yaw_rate };
        let rates = [rate(0, 1.0), rate(10, 3.0)];
        assert_eq!([-5, 0, 5, 10, 99].map(|t_ns| yaw_rate(&rates, t_ns)), [1.0, 1.0, 2.0, 3.0, 3.0]);
    }
}
