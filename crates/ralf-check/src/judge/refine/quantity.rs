//! The quantities of a correction.

use crate::change::SensorChange;

/// One quantity: yaw, place forward, place to the left, clock.
pub(super) struct Quantity {
    /// One of its unit: degree, m, ms.
    pub(super) unit: SensorChange,
    /// How far off one expects it, before anything is measured.
    pub(super) prior: f64,
    /// First and last step of a search.
    pub(super) steps: [f64; 2],
    /// What labels notice.
    pub(super) smallest: f64,
    /// What no amount of measurements takes away: bushes that a LiDAR sees elsewhere than a radar does, azimuths that
    /// are off by the same everywhere, odometry that holds its samples.
    pub(super) systematic: f64,
}

const NOTHING: SensorChange =
    SensorChange { turn_deg: [0.0; 3], shift_m: [0.0; 3], clock_ms: 0.0, mirrored: false };

/// A place along an axis of the vehicle.
const fn place(shift_m: [f64; 3]) -> Quantity {
    Quantity {
        unit: SensorChange { shift_m, ..NOTHING },
        prior: 0.3,
        steps: [0.1, 0.005],
        smallest: 0.05,
        systematic: 0.05,
    }
}

/// In the order of [`Values`].
pub(super) const QUANTITIES: [Quantity; 4] = [
    Quantity {
        unit: SensorChange { turn_deg: [0.0, 0.0, 1.0], ..NOTHING },
        prior: 5.0,
        steps: [1.0, 0.02],
        smallest: 0.3,
        systematic: 0.1,
    },
    place([1.0, 0.0, 0.0]),
    place([0.0, 1.0, 0.0]),
    Quantity {
        unit: SensorChange { clock_ms: 1.0, ..NOTHING },
        prior: 200.0,
        steps: [40.0, 1.0],
        smallest: 15.0,
        systematic: 15.0,
    },
];

/// A value of each quantity, in its prior standard deviations, so that they can be compared.
pub(super) type Values = nalgebra::Vector4<f64>;

/// The quantities that a change holds.
pub(super) fn values(change: &SensorChange) -> Values {
    Values::from_fn(|i, _| QUANTITIES[i].unit.value_in(change) / QUANTITIES[i].prior)
}

/// A change with these values instead of its own.
pub(super) fn with_values(change: &SensorChange, values: &Values) -> SensorChange {
    let [roll, pitch, _] = change.turn_deg;
    let mut changed = SensorChange {
        turn_deg: [roll, pitch, 0.0],
        shift_m: [0.0, 0.0, change.shift_m[2]],
        clock_ms: 0.0,
        mirrored: change.mirrored,
    };
    for (quantity, value) in QUANTITIES.iter().zip(values.iter()) {
        changed = changed.and(&quantity.unit.times(value * quantity.prior));
    }
    changed
}
