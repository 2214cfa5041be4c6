//! Signs of range rates and of the motion.

use super::planting::times;
use super::{ALL_RADARS, FRONT, Fault, LEFT};
use ralf_check::Remedy;

pub(super) fn faults() -> Vec<Fault> {
    vec![
        fault!("Doppler sign, one radar", ["radar_left"], true, |p| times(p, Some(LEFT), &[3], -1.0), |r| {
            matches!(r, Remedy::Doppler(f) if *f == -1.0)
        }),
        fault!("Doppler sign, all radars", ALL_RADARS, true, |p| times(p, None, &[3], -1.0), |r| {
            matches!(r, Remedy::Doppler(f) if *f == -1.0)
        }),
        fault!("speed sign", ["motion"], true, |p| p.edit_odometry(|s| s.velocity = -s.velocity), |r| {
            matches!(r, Remedy::Speed(f) if *f == -1.0)
        }),
        fault!("speed always 0", ALL_RADARS, true, |p| p.edit_odometry(|s| s.velocity = 0.0)),
        fault!("yaw rate sign", ["motion"], false, |p| p.edit_odometry(|s| s.yaw_rate = -s.yaw_rate), |r| {
            matches!(r, Remedy::YawRate(f) if *f == -1.0)
        }),
        fault!("Doppler already compensated", ["radar_front"], true, |p| times(p, Some(FRONT), &[3], 0.02)),
    ]
}
