//! How the vehicle really moves.

use super::ground::Ground;
use super::scenario::{Drive, Leg};
use ralf::space::Transform;
use std::f64::consts::TAU;

/// Speed and curvature are constant for so long, s.
const STEP: f64 = 0.01;
/// The speed swings by this share about its mean, once in a period of so many seconds.
const SWING: (f64, f64) = (0.12, 7.0);

/// State of the vehicle: planar pose in the site's frame, speed (m/s) and turn rate (rad/s).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct State {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) heading: f64,
    pub(super) speed: f64,
    pub(super) yaw_rate: f64,
}

impl State {
    /// After `dt` along an arc.
    fn advanced(self, dt: f64) -> Self {
        let from = [self.x, self.y, self.heading];
        let [x, y, heading] = on_arc(from, self.speed * dt, self.yaw_rate * dt);
        Self { x, y, heading, ..self }
    }
}

/// x, y (m) and heading (rad) after a way (m) along an arc on which so much (rad) is turned.
pub(super) fn on_arc([x, y, heading]: [f64; 3], way: f64, turned: f64) -> [f64; 3] {
    let half_turn = turned / 2.0;
    let chord = way * if half_turn.abs() < 1e-9 { 1.0 } else { half_turn.sin() / half_turn };
    let (sin, cos) = (heading + half_turn).sin_cos();
    [x + chord * cos, y + chord * sin, heading + turned]
}

/// The states of a drive.
#[derive(Debug, Clone)]
pub(super) struct Path {
    states: Vec<State>,
}

impl Path {
    /// A drive of so many seconds.
    pub(super) fn new(drive: &Drive, seconds: f64) -> Self {
        let swinging = |t: f64| drive.speed_kmh / 3.6 * (1.0 + SWING.0 * (TAU * t / SWING.1).sin());
        Self::along(drive.start, &drive.leg, seconds, swinging)
    }

    /// From a start (x, y, heading in degrees) along legs for so many seconds; `speed` (m/s) at each of them, below 0
    /// where the vehicle reverses. Legs count the way whichever direction it is driven in.
    pub(super) fn along(start: [f64; 3], legs: &[Leg], seconds: f64, speed: impl Fn(f64) -> f64) -> Self {
        let [x, y, heading_deg] = start;
        let mut state = State { x, y, heading: heading_deg.to_radians(), speed: 0.0, yaw_rate: 0.0 };
        let mut travelled = 0.0;
        let steps = (seconds / STEP).ceil() as usize + 1;
        let states = (0..steps).map(|step| {
            state.speed = speed(step as f64 * STEP);
            let way = state.speed.abs() * STEP;
            state.yaw_rate = state.speed * curvature(legs, travelled, way);
            travelled += way;
            let now = state;
            state = state.advanced(STEP);
            now
        });
        Self { states: states.collect() }
    }

    /// At a time after the start, s.
    pub(super) fn state(&self, seconds: f64) -> State {
        let step = ((seconds / STEP + 1e-9).max(0.0) as usize).min(self.states.len() - 1);
        self.states[step].advanced(seconds - step as f64 * STEP)
    }

    /// The vehicle's pose in the site's frame.
    pub(super) fn site_from_vehicle(&self, ground: &Ground, seconds: f64) -> Transform {
        let State { x, y, heading, .. } = self.state(seconds);
        ground.pose([x, y, heading])
    }
}

/// 1/m, after so many metres, of the `way` that follows, m: the mean where legs end within it, so that none is lost.
fn curvature(legs: &[Leg], travelled: f64, way: f64) -> f64 {
    let of = |leg: &Leg| leg.turn_deg.to_radians() / leg.length;
    let (mut begin, mut turned) = (0.0, 0.0);
    for leg in legs {
        let end = begin + leg.length;
        if begin <= travelled && travelled + way <= end && travelled < end {
            return of(leg);
        }
        turned += of(leg) * ((travelled + way).min(end) - travelled.max(begin)).max(0.0);
        begin = end;
    }
    if way > 0.0 { turned / way } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Leg;

    #[test]
    fn a_turn_ends_where_its_circle_does() {
        let turn = Leg { length: 5.0 * std::f64::consts::PI, turn_deg: 90.0 };
        let drive = Drive { start: [1.0, 2.0, 90.0], speed_kmh: 9.0, leg: vec![turn] };
        let path = Path::new(&drive, 20.0);
        let at_the_end = (0..20_000).map(|i| path.state(f64::from(i) * 1e-3)).find(|state| state.y > 11.99);
        let end = at_the_end.unwrap();
        assert!((end.x + 9.0).abs() < 0.7 && (end.heading.to_degrees() - 180.0).abs() < 5.0, "{end:?}");
        assert!(path.states.iter().all(|state| state.speed < 10.1 / 3.6));
    }

    #[test]
    fn legs_shorter_than_a_step_turn_the_vehicle_too() {
        // 0.3 m a step, and a corner of 0.1 m between two of them.
        let leg = |length, turn_deg| Leg { length, turn_deg };
        let corner = [leg(1.0, 0.0), leg(0.1, 40.0), leg(2.0, 0.0), leg(0.05, -10.0), leg(50.0, 0.0)];
        for way in [1.0, -1.0] {
            let path = Path::along([0.0; 3], &corner, 1.0, |_| 30.0 * way);
            assert!((path.state(0.9).heading - way * 30_f64.to_radians()).abs() < 1e-9);
        }
    }
}
