//! Where a sequence was measured: what is seen from one place is the same things again and again.

use crate::sample::LidarLook;
use ralf::space::EgoMotion;

/// After so much way what surrounds the vehicle is something else, m.
pub(super) const PLACE: f64 = 10.0;
/// What is the mounting's is seen from so many places, and what is a place's own is not.
pub(super) const PLACES: usize = 3;

/// Scans in time order, one list per stretch of [`PLACE`] metres on the way.
pub(super) fn by_place<'a>(
    looks: impl Iterator<Item = &'a LidarLook>,
    motion: &EgoMotion,
) -> Vec<Vec<&'a LidarLook>> {
    let mut places: Vec<Vec<&LidarLook>> = Vec::new();
    let (mut way, mut begun) = (0.0, 0.0);
    let mut before: Option<i64> = None;
    for look in looks {
        way += before.map_or(0.0, |t_ns| motion.between(t_ns, look.t_ns).translation.vector.norm());
        before = Some(look.t_ns);
        match places.last_mut() {
            Some(place) if way - begun < PLACE => place.push(look),
            _ => {
                begun = way;
                places.push(vec![look]);
            }
        }
    }
    places
}
