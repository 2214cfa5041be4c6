//! What range rates say of the vehicle's motion, of the radars' mountings and of their clocks.

mod clock;
mod compare;
mod vehicle;

pub use crate::velocity_fit::{VelocityFit, fit};
pub(crate) use clock::{ClockFigures, clock};
pub(crate) use compare::{CREEPING, DopplerFigures, MOVING, STANDING, compare, creeping, predicted};
pub use vehicle::from_doppler;
pub(crate) use vehicle::{Turning, turning};

use crate::sample::RadarLook;

/// A scan's velocity and when it was measured.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Timed {
    pub(crate) t_ns: i64,
    pub(crate) fit: VelocityFit,
}

/// The velocities of a radar's scans.
pub(crate) fn fits(looks: &[RadarLook]) -> Vec<Timed> {
    looks.iter().filter_map(|look| Some(Timed { t_ns: look.t_ns, fit: look.fit? })).collect()
}
