//! What moves on roads and beside them.

use super::builder::Builder;
use crate::kind::Kind;

/// A road along x.
pub(super) struct Road {
    /// Where it begins and ends for what moves, m.
    pub(super) reach: [f64; 2],
    /// Centre lines of the lanes, m; those at y below 0 lead to +x.
    pub(super) lanes: Vec<f64>,
    /// m/s, usually.
    pub(super) speed: f64,
    /// How many usually move on a kilometre of it.
    pub(super) cars: f64,
    /// Which share of them are lorries.
    pub(super) trucks: f64,
}

/// Free of others at the start: about the own vehicle, m.
const FREE: f64 = 14.0;

/// How often somebody on foot has company (chosen).
const TOGETHER: f64 = 0.3;

/// Cars and lorries in the lanes, behind one another.
pub(super) fn on_road(builder: &mut Builder<'_>, road: &Road) {
    let [own_x, own_y, _] = builder.plan.drive.start;
    let own_speed = builder.plan.drive.speed;
    let mut taken: Vec<[f64; 2]> = Vec::new();
    for _ in 0..builder.traffic(per_kilometre(road.cars, road.reach)) {
        let lane = road.lanes[(builder.random.uniform() * road.lanes.len() as f64) as usize];
        let x = builder.between(road.reach[0], road.reach[1]);
        let own_lane = (lane - own_y).abs() < 2.0;
        let too_near = (x - own_x).abs() < FREE && own_lane;
        if too_near || taken.iter().any(|[u, v]| (u - x).abs() < FREE && (v - lane).abs() < 1.0) {
            continue;
        }
        taken.push([x, lane]);
        let kind = if builder.chance(road.trucks) { Kind::Truck } else { Kind::Car };
        let slower = if kind == Kind::Truck { 0.75 } else { 1.0 };
        let mut speed = road.speed * slower * builder.between(0.6, 1.15);
        // Nobody drives through the own vehicle.
        if own_lane {
            speed = if x > own_x { speed.max(own_speed) } else { speed.min(own_speed.max(0.0)) };
        }
        let wander = builder.normal(0.15);
        builder.send(kind, [x, lane + wander], if lane < 0.0 { 0.0 } else { 180.0 }, speed, 0.0);
    }
}

/// How many there are on a stretch of so many on a kilometre.
fn per_kilometre(usual: f64, [from, to]: [f64; 2]) -> f64 {
    usual * (to - from) / 1000.0
}

/// People on foot along x, or across it: so many on a kilometre.
pub(super) fn on_foot(builder: &mut Builder<'_>, usual: f64, [from, to]: [f64; 2], y: f64) {
    for _ in 0..builder.people(per_kilometre(usual, [from, to])) {
        let side = if builder.chance(0.5) { 1.0 } else { -1.0 };
        let at = [builder.between(from, to), side * y + builder.normal(0.5)];
        let across = builder.chance(0.2);
        let yaw = if across {
            -90.0 * side
        } else if builder.chance(0.5) {
            0.0
        } else {
            180.0
        };
        let yaw = yaw + builder.normal(8.0);
        // Some stand; others walk or run (0.7 to 3 m/s).
        let speed = if builder.chance(0.2) { 0.0 } else { builder.between(0.7, 1.7) };
        let speed = if builder.chance(0.08) { speed * 2.0 } else { speed };
        builder.send(Kind::Pedestrian, at, yaw, speed, 0.0);
        if builder.chance(TOGETHER) {
            let beside = [at[0] + builder.normal(0.4), at[1] + builder.normal(0.6)];
            builder.send(Kind::Pedestrian, beside, yaw, speed, 0.0);
        }
    }
}

/// Cyclists along x: so many on a kilometre.
pub(super) fn on_bicycles(builder: &mut Builder<'_>, usual: f64, [from, to]: [f64; 2], y: f64) {
    for _ in 0..builder.people(per_kilometre(usual, [from, to])) {
        let along = builder.chance(0.5);
        let at = [builder.between(from, to), if along { -y } else { y }];
        let yaw = if along { 0.0 } else { 180.0 } + builder.normal(2.0);
        let speed = builder.between(2.5, 8.0);
        builder.send(Kind::Cyclist, at, yaw, speed, 0.0);
    }
}
