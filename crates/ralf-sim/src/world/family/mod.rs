//! Families of worlds: what can differ between recordings that were made by different people with different sensors.
//!
//! A family is a set of ranges; a seed draws the numbers of one world from it. Families differ in physics and in
//! sensors, so that a labeler which was trained on all but one of them meets something new in the one left out.

mod mounts;
mod ranges;
mod table;
mod usual;

pub use ranges::Family;
pub(super) use ranges::{
    CalibrationRanges, MotionRanges, Mount, MountedLidar, PlaceKind, RadarRanges, mount,
};
pub use table::FAMILIES;

impl Family {
    /// By its number, or by its name.
    pub fn find(text: &str) -> Option<&'static Self> {
        let by_number = text.parse::<usize>().ok().and_then(|number| FAMILIES.get(number));
        by_number.or_else(|| FAMILIES.iter().find(|family| family.name == text))
    }
}
