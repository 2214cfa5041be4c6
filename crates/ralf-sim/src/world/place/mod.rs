//! Places, made up from a seed: what stands where, what moves, what the ground is covered with, and the drive through
//! it all.

mod builder;
mod country;
mod industrial;
mod motorway;
mod parking;
mod residential;
mod street;
mod traffic;
mod tunnel;

pub(super) use builder::Plan;

use super::family::{MotionRanges, PlaceKind};
use crate::random::Random;
use builder::Builder;

/// A place of a kind, and a drive through it.
pub(super) fn plan(kind: PlaceKind, motion: &MotionRanges, random: &mut Random) -> Plan {
    let mut builder = Builder::new(motion, random);
    match kind {
        PlaceKind::Street => street::street(&mut builder),
        PlaceKind::Crossing => street::crossing(&mut builder),
        PlaceKind::Residential => residential::residential(&mut builder),
        PlaceKind::CarPark => parking::car_park(&mut builder),
        PlaceKind::Industrial => industrial::yard(&mut builder),
        PlaceKind::Motorway => motorway::motorway(&mut builder),
        PlaceKind::Tunnel => tunnel::tunnel(&mut builder),
        PlaceKind::Country => country::country(&mut builder),
    }
    builder.plan
}
