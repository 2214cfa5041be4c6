//! Which share of what was seen lies on what is seen half a second later: whether the vehicle moved as recorded.

use super::Tally;
use crate::change::SensorChange;
use crate::plan_field::PlanField;
use crate::sample::{LAG_NS, LidarLook, RadarLook, nearest};
use ralf::space::EgoMotion;
use ralf::space::{Point, Transform};

/// On: in plan, m.
const ON: f64 = 0.3;
/// Pairs are the wanted time apart within this share of it.
const LOOSE: f64 = 0.25;

/// The tally of a LiDAR's obstacles, under a motion.
pub(crate) fn motion_overlap(looks: &[&LidarLook], motion: &EgoMotion) -> Tally {
    changed_motion_overlap(looks, &Transform::identity(), &SensorChange::default(), motion)
}

/// The same of a LiDAR under a change of it. `mount` is the recorded one.
pub(crate) fn changed_motion_overlap(
    looks: &[&LidarLook],
    mount: &Transform,
    change: &SensorChange,
    motion: &EgoMotion,
) -> Tally {
    let (into_recorded, changed) = (mount.inverse(), change.mount(mount));
    let into_changed = changed.inverse();
    let mut tally = Tally::default();
    for (i, first) in looks.iter().enumerate() {
        let later = looks[i + 1..].iter().filter(|look| look.lidar == first.lidar);
        let Some(second) = later.min_by_key(|look| (look.t_ns - first.t_ns - LAG_NS).abs()) else { continue };
        if is_pair(first.t_ns, second.t_ns) {
            let moved = motion.between(second.t_ns, first.t_ns);
            // To where it truly is, along with the vehicle, and back into the frame in which obstacles were recorded.
            let place = |p: &Point| {
                let truly = changed * change.place(&(into_recorded * p));
                mount * change.place(&(into_changed * (moved * truly)))
            };
            tally.moments.push(on(&first.probes, &second.field, place));
        }
    }
    tally
}

/// The same of a radar's detections, for recordings without LiDAR.
pub(crate) fn radar_motion_overlap(looks: &[RadarLook], mount: &Transform, motion: &EgoMotion) -> Tally {
    let times: Vec<i64> = looks.iter().map(|look| look.t_ns).collect();
    let mut tally = Tally::default();
    for first in looks {
        let Some(second) = nearest(&times, first.t_ns + LAG_NS).map(|i| &looks[i]) else { continue };
        if is_pair(first.t_ns, second.t_ns) {
            let placed =
                |look: &RadarLook| -> Vec<Point> { look.positions.iter().map(|p| mount * p).collect() };
            let field = PlanField::new(placed(second).iter().map(|p| [p.x, p.y, 0.0]));
            let moved = motion.between(second.t_ns, first.t_ns);
            tally.moments.push(on(&placed(first), &field, |p| moved * p));
        }
    }
    tally
}

fn is_pair(first_ns: i64, second_ns: i64) -> bool {
    ((second_ns - first_ns - LAG_NS) as f64).abs() < LOOSE * LAG_NS as f64
}

fn on(points: &[Point], field: &PlanField, moved: impl Fn(&Point) -> Point) -> [f64; 2] {
    let mut found = [0.0; 2];
    for point in points {
        let p = moved(point);
        let distance = field.distance(p.x, p.y);
        // What a wrong motion throws out of sight is not on anything.
        found[1] += 1.0;
        found[0] += f64::from(distance.is_some_and(|distance| distance <= ON));
    }
    found
}
