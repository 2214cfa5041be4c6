//! Where a recording says that a sensor sits.

use super::random::Random;
use nalgebra::{Translation3, UnitQuaternion};
use ralf::space::{Transform, Vector};

/// A mounting that is off by at most so much, each way.
pub(super) fn off(mount: &Transform, angle_deg: f64, place: f64, random: &mut Random) -> Transform {
    let mut angle = || (random.between(-1.0, 1.0) * angle_deg).to_radians();
    let turn = UnitQuaternion::from_euler_angles(angle(), angle(), angle());
    let mut shift = || random.between(-1.0, 1.0) * place;
    let shift = Vector::new(shift(), shift(), shift());
    Transform::from_parts(Translation3::from(mount.translation.vector + shift), mount.rotation * turn)
}
