//! Wheel odometry: what the wheels say, with their errors.

use super::path::Path;
use super::random::{Purpose, Random};
use ralf::space::OdometrySample;

/// Between samples, ns.
const PERIOD_NS: i64 = 20_000_000;
/// The wheels' radius is known to this, relative.
const SCALE_SIGMA: f64 = 0.004;
/// Standard deviation of a single speed, m/s.
const SPEED_SIGMA: f64 = 0.01;
/// Standard deviations of the gyro's offset and of a single turn rate, rad/s.
const YAW_RATE_SIGMAS: (f64, f64) = (0.0015, 0.003);

/// Samples from the start on, for so many seconds.
pub(super) fn samples(path: &Path, start_ns: i64, seconds: f64, seed: u64) -> Vec<OdometrySample> {
    let mut random = Random::new(seed, Purpose::Odometry, 0, 0);
    let scale = 1.0 + random.normal(SCALE_SIGMA);
    let offset = random.normal(YAW_RATE_SIGMAS.0);
    let count = (seconds * 1e9 / PERIOD_NS as f64).ceil() as i64 + 1;
    let mut sample = |i: i64| {
        // A sample holds until the next: that is what it should say.
        let state = path.state((i * PERIOD_NS + PERIOD_NS / 2) as f64 * 1e-9);
        OdometrySample {
            t_ns: start_ns + i * PERIOD_NS,
            velocity: (state.speed * scale + random.normal(SPEED_SIGMA)).max(0.0),
            yaw_rate: state.yaw_rate + offset + random.normal(YAW_RATE_SIGMAS.1),
        }
    };
    (0..count).map(&mut sample).collect()
}
