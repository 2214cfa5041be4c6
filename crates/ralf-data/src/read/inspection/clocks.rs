//! Sensors whose clock isn't that of the others.

use ralf::sensors::Sequence;

/// A sensor whose times lie this far from the motion's has another clock, s: no recorder starts its parts so far apart.
const FAR_S: f64 = 60.0;

/// A sentence for each sensor that measured at another time than the vehicle's motion.
pub(super) fn strange(sequence: &Sequence) -> Vec<String> {
    let (rig, times) = (&sequence.rig, &sequence.times);
    let radars = rig.radars.iter().map(|radar| &radar.name).zip(&times.radars);
    let lidars = rig.lidars.iter().map(|lidar| &lidar.name).zip(&times.lidars);
    let cameras = rig.cameras.iter().map(|camera| &camera.name).zip(&times.cameras);
    let Some(moving) = span_of_motion(sequence) else { return Vec::new() };
    let mut strange = Vec::new();
    for (name, own) in radars.chain(lidars).chain(cameras) {
        let Some(span) = own.first().zip(own.last()).map(|(first, last)| [*first, *last]) else { continue };
        let seconds = apart(span, moving);
        if seconds > FAR_S {
            let side = if span[1] < moving[0] { "before" } else { "after" };
            strange.push(format!(
                "{name}: all its times lie {seconds:.0} s or more {side} those of the vehicle's motion: is it another \
                 clock?"
            ));
        }
    }
    strange
}

fn span_of_motion(sequence: &Sequence) -> Option<[i64; 2]> {
    let poses = sequence.motion.poses().iter().map(|pose| pose.t_ns);
    let times = poses.chain(sequence.motion.odometry().iter().map(|sample| sample.t_ns));
    Some([times.clone().min()?, times.max()?])
}

/// How far two spans lie apart, s; 0 where they touch.
fn apart(a: [i64; 2], b: [i64; 2]) -> f64 {
    let between = |end: i64, begin: i64| if begin > end { begin.abs_diff(end) } else { 0 };
    between(a[1], b[0]).max(between(b[1], a[0])) as f64 * 1e-9
}
