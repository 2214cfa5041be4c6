//! What a settings file may correct: the tables `corrections.NAME` and `motion`.

use nalgebra::{Translation3, UnitQuaternion};
use ralf::config::exact;
use ralf::sensors::Sequence;
use ralf::space::{Transform, Vector};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// `corrections.NAME`: what is added to what a recording says of the sensor of that name. `ralf check --write`
/// proposes it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorCorrection {
    /// About the sensor's own z axis, degrees, positive to the left.
    pub add_yaw_deg: f64,
    /// About its own y axis, degrees, positive puts its front down.
    pub add_pitch_deg: f64,
    /// About its own x axis, degrees.
    pub add_roll_deg: f64,
    /// Vehicle frame, m.
    #[serde(deserialize_with = "exact::array")]
    pub add_translation: [f64; 3],
    /// Added to its timestamps, ms.
    pub time_offset_ms: f64,
    /// How often it truly measures, ms, where a recorder stamps its latest measurement with a time of its own: every
    /// time goes back to the tick before it. 0 leaves times alone.
    pub period_ms: f64,
    /// One of these ticks, ms on the recording's clock.
    pub tick_ms: f64,
    /// Of its range rates (radar).
    pub doppler_factor: f64,
    /// Of its coordinates (radar, LiDAR).
    pub position_factor: f64,
    /// Exchanges left and right (radar, LiDAR): of places, angles, and velocities in two components (`vy`, `vy_comp`).
    pub mirror_y: bool,
}

impl Default for SensorCorrection {
    fn default() -> Self {
        Self {
            add_yaw_deg: 0.0,
            add_pitch_deg: 0.0,
            add_roll_deg: 0.0,
            add_translation: [0.0; 3],
            time_offset_ms: 0.0,
            period_ms: 0.0,
            tick_ms: 0.0,
            doppler_factor: 1.0,
            position_factor: 1.0,
            mirror_y: false,
        }
    }
}

// Kinds of sensors, as an error tells them.
const RADAR: &str = "a radar";
const LIDAR: &str = "a LiDAR";
const CAMERA: &str = "a camera";

/// What settings alter of a recording: whether its own messages, copied as they are, still say what is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub enum Altered {
    /// Nothing: they do.
    #[default]
    Nothing,
    /// How well sensors measure, of which no message tells.
    Models,
    /// Where sensors are, when or what they measured, or how the vehicle moved.
    Measurements,
}

/// Where the vehicle's motion comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MotionSource {
    /// From the recording's own odometry or poses.
    #[default]
    Recorded,
    /// From the radars' range rates.
    Radar,
    /// From the scans of a LiDAR.
    Lidar,
    /// From a trajectory's file.
    Trajectory,
}

/// `motion`: how the vehicle moved.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MotionSettings {
    /// `recorded`, `radar` or `lidar`; a trajectory wins over all.
    pub source: MotionSource,
    /// File of poses of the only sequence: TUM (`t x y z qx qy qz qw`) or KITTI (twelve numbers, row by row); or a
    /// folder with such a file for each sequence, of its name and with the ending `tum`, `txt` or `kitti`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory: Option<PathBuf>,
    /// `vehicle`, or the sensor whose poses they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory_frame: Option<String>,
    /// Sensor whose n-th measurement the n-th pose belongs to, for poses without times; KITTI has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trajectory_order: Option<String>,
    /// Factor of recorded speeds and of the translations of poses.
    pub speed_factor: f64,
    /// Factor of recorded yaw rates.
    pub yaw_rate_factor: f64,
    /// Added to the motion's timestamps, ms.
    pub time_offset_ms: f64,
}

impl Default for MotionSettings {
    fn default() -> Self {
        Self {
            source: MotionSource::Recorded,
            trajectory: None,
            trajectory_frame: None,
            trajectory_order: None,
            speed_factor: 1.0,
            yaw_rate_factor: 1.0,
            time_offset_ms: 0.0,
        }
    }
}

impl MotionSettings {
    /// These settings, with what a later correction of the motion that they made says.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        Self {
            speed_factor: self.speed_factor * later.speed_factor,
            yaw_rate_factor: self.yaw_rate_factor * later.yaw_rate_factor,
            time_offset_ms: self.time_offset_ms + later.time_offset_ms,
            ..self.clone()
        }
    }

    /// All numbers, by their keys.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = (&'static str, f64)> + use<> {
        [
            ("speed_factor", self.speed_factor),
            ("yaw_rate_factor", self.yaw_rate_factor),
            ("time_offset_ms", self.time_offset_ms),
        ]
        .into_iter()
    }
}

impl SensorCorrection {
    /// All numbers, by their keys.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = (&'static str, f64)> + use<> {
        let translation = self.add_translation.map(|value| ("add_translation", value));
        let others = [
            ("add_yaw_deg", self.add_yaw_deg),
            ("add_pitch_deg", self.add_pitch_deg),
            ("add_roll_deg", self.add_roll_deg),
            ("time_offset_ms", self.time_offset_ms),
            ("period_ms", self.period_ms),
            ("tick_ms", self.tick_ms),
            ("doppler_factor", self.doppler_factor),
            ("position_factor", self.position_factor),
        ];
        others.into_iter().chain(translation)
    }

    /// This correction, and a later one of what it made of the recording, as one. Turns are Euler angles of both in a
    /// row; what the later one says of ticks wins.
    #[must_use]
    pub fn then(&self, later: &Self) -> Self {
        let turn = |c: &Self| {
            let [roll, pitch, yaw] = [c.add_roll_deg, c.add_pitch_deg, c.add_yaw_deg].map(f64::to_radians);
            UnitQuaternion::from_euler_angles(roll, pitch, yaw)
        };
        let (roll, pitch, yaw) = (turn(self) * turn(later)).euler_angles();
        let is_held = self.period_ms > 0.0 && later.period_ms == 0.0;
        Self {
            add_yaw_deg: yaw.to_degrees(),
            add_pitch_deg: pitch.to_degrees(),
            add_roll_deg: roll.to_degrees(),
            add_translation: std::array::from_fn(|i| self.add_translation[i] + later.add_translation[i]),
            time_offset_ms: self.time_offset_ms + later.time_offset_ms,
            period_ms: if is_held { self.period_ms } else { later.period_ms },
            // Times that go back to a tick are moved with it.
            tick_ms: if is_held { self.tick_ms + later.time_offset_ms } else { later.tick_ms },
            doppler_factor: self.doppler_factor * later.doppler_factor,
            position_factor: self.position_factor * later.position_factor,
            mirror_y: self.mirror_y != later.mirror_y,
        }
    }

    /// Whether measured values become others: not only where a sensor is and when it measured.
    pub(crate) fn alters_values(&self) -> bool {
        self.doppler_factor != 1.0 || self.position_factor != 1.0 || self.mirror_y
    }

    /// Corrects the mounting and the times of the sensor of this name. The error says which names there are, or what is
    /// no correction of such a sensor.
    pub(crate) fn apply_to(&self, sequence: &mut Sequence, name: &str) -> Result<(), String> {
        let (rig, times) = (&mut sequence.rig, &mut sequence.times);
        let mut names = Vec::new();
        let radars =
            rig.radars.iter_mut().map(|r| (RADAR, &r.name, &mut r.vehicle_from_radar)).zip(&mut times.radars);
        let lidars =
            rig.lidars.iter_mut().map(|l| (LIDAR, &l.name, &mut l.vehicle_from_lidar)).zip(&mut times.lidars);
        let cameras = rig
            .cameras
            .iter_mut()
            .map(|c| (CAMERA, &c.name, &mut c.vehicle_from_camera))
            .zip(&mut times.cameras);
        for ((kind, own, mount), times) in radars.chain(lidars).chain(cameras) {
            if own == name {
                self.refuse_idle(kind)
                    .map_err(|(key, reason)| format!("corrections.{name}.{key}: {reason}"))?;
                *mount = self.mount(mount);
                times.iter_mut().for_each(|t| *t = self.time(*t));
                return Ok(());
            }
            names.push(own.clone());
        }
        Err(format!("corrections.{name}: expected one of its sensors {}", names.join(", ")))
    }

    /// Refuses what would change nothing of a sensor of this kind: the key, and what was expected.
    fn refuse_idle(&self, kind: &str) -> Result<(), (&'static str, String)> {
        let keys = [
            ("doppler_factor", self.doppler_factor != 1.0, &[RADAR][..]),
            ("position_factor", self.position_factor != 1.0, &[RADAR, LIDAR]),
            ("mirror_y", self.mirror_y, &[RADAR, LIDAR]),
        ];
        match keys.into_iter().find(|(_, given, kinds)| *given && !kinds.contains(&kind)) {
            Some((key, _, kinds)) => Err((key, format!("expected {}, found {kind}", kinds.join(" or ")))),
            None => Ok(()),
        }
    }

    fn mount(&self, recorded: &Transform) -> Transform {
        let [roll, pitch, yaw] =
            [self.add_roll_deg, self.add_pitch_deg, self.add_yaw_deg].map(f64::to_radians);
        let place = recorded.translation.vector + Vector::from(self.add_translation);
        let rotation = recorded.rotation * UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        Transform::from_parts(Translation3::from(place), rotation)
    }

    pub(crate) fn time(&self, t_ns: i64) -> i64 {
        let shifted = t_ns.saturating_add((self.time_offset_ms * 1e6) as i64);
        let (period, tick) = ((self.period_ms * 1e6) as i64, (self.tick_ms * 1e6) as i64);
        if period <= 0 {
            shifted
        } else {
            shifted.saturating_sub(shifted.saturating_sub(tick).rem_euclid(period))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_corrections_in_a_row_are_one() {
        let [first, later] =
            [[4.0, -2.0, 1.5], [90.0, 0.5, -3.0]].map(|[yaw, pitch, roll]| SensorCorrection {
                add_yaw_deg: yaw,
                add_pitch_deg: pitch,
                add_roll_deg: roll,
                add_translation: [yaw * 0.1, roll, 0.2],
                time_offset_ms: yaw * 2.0,
                doppler_factor: -0.5,
                mirror_y: roll > 0.0,
                ..SensorCorrection::default()
            });
        let recorded = Transform::from_parts(
            Translation3::new(3.0, 0.5, 0.4),
            UnitQuaternion::from_euler_angles(0.1, -0.2, 0.7),
        );
        let (both, in_turn) = (first.then(&later).mount(&recorded), later.mount(&first.mount(&recorded)));
        assert!((both.to_homogeneous() - in_turn.to_homogeneous()).abs().max() < 1e-12);
        let both = first.then(&later);
        assert_eq!((both.time_offset_ms, both.doppler_factor, both.mirror_y), (188.0, 0.25, true));
        let held = SensorCorrection { period_ms: 55.0, tick_ms: 7.0, ..first };
        let later = SensorCorrection { time_offset_ms: 20.0, ..SensorCorrection::default() };
        for t_ns in [0, 217_000_000, 300_000_000] {
            assert_eq!(held.then(&later).time(t_ns), later.time(held.time(t_ns)));
        }
    }

    #[test]
    fn a_time_goes_back_to_the_tick_before_it() {
        let ms = |correction: SensorCorrection, t: f64| correction.time((t * 1e6) as i64) as f64 * 1e-6;
        let held = SensorCorrection {
            time_offset_ms: -100.0,
            period_ms: 55.0,
            tick_ms: 7.0,
            ..SensorCorrection::default()
        };
        // Ticks are at 7, 62, 117, 172, ... and at -48.
        let times = [217.0, 216.9, 300.0, 272.0, 100.0, 106.9].map(|t| ms(held, t));
        assert_eq!(times, [117.0, 62.0, 172.0, 172.0, -48.0, -48.0]);
        assert_eq!(ms(SensorCorrection { period_ms: 0.0, ..held }, 217.0), 117.0);
        // Whole numbers of time, however long after the tick.
        let late = 4_833_189_570_000_i64;
        assert_eq!((held.time(late) - 7_000_000) % 55_000_000, 0);
        assert!((0..55_000_000).contains(&(late - 100_000_000 - held.time(late))));
        assert_eq!(held.time(i64::MIN), i64::MIN);
    }
}
