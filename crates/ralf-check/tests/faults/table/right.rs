//! Whether a remedy is near the right one.

use ralf_check::Remedy;

pub(super) fn near(value: f64, expected: f64, within: f64) -> bool {
    (value - expected).abs() <= within
}

pub(super) fn yaw_of(remedy: &Remedy) -> Option<f64> {
    match remedy {
        Remedy::Sensor(change) => Some(change.turn_deg[2]),
        _ => None,
    }
}

pub(super) fn clock_of(remedy: &Remedy) -> Option<f64> {
    match remedy {
        Remedy::Sensor(change) => Some(change.clock_ms),
        _ => None,
    }
}
