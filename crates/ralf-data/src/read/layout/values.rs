//! Values as `sequence.toml` has them: checked with the table they stand in, and written with the fewest decimals that
//! are read back as the same.

use crate::error::{DataError, expected_and_found};
use nalgebra::UnitQuaternion;
use ralf::sensors::FARTHEST;
use ralf::space::{Transform, transform_from_parts};
use std::path::Path;

/// A table of the file, to be named in errors.
pub(crate) struct Place<'a> {
    pub(super) file: &'a Path,
    pub(super) table: &'static str,
    pub(super) name: &'a str,
}

impl Place<'_> {
    /// Key `key` of this table holds something else than it should.
    pub(crate) fn error(&self, key: &str, expected: &str, found: impl ToString) -> DataError {
        let Self { file, table, name } = self;
        DataError::content(file, format!("[[{table}]] {name}: {key}"), expected, found.to_string())
    }

    /// The same, from a sentence that says what was expected and found.
    pub(super) fn refused(&self, key: &str, reason: &str) -> DataError {
        let (expected, found) = expected_and_found(reason);
        self.error(key, expected, found)
    }

    /// `values`, unless one of them is no finite number.
    pub(crate) fn finite<'v>(&self, key: &str, values: &'v [f64]) -> Result<&'v [f64], DataError> {
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => Err(self.error(key, "finite numbers", value)),
            None => Ok(values),
        }
    }

    /// The sensor's pose in the vehicle frame.
    pub(crate) fn pose(
        &self,
        translation: [f64; 3],
        quaternion_xyzw: [f64; 4],
    ) -> Result<Transform, DataError> {
        self.finite("translation", &translation)?;
        if let Some(far) = translation.iter().find(|value| value.abs() > FARTHEST) {
            return Err(self.error("translation", &format!("at most {FARTHEST} m from the vehicle"), far));
        }
        transform_from_parts(translation, quaternion_xyzw)
            .ok_or_else(|| self.error("quaternion_xyzw", "a length of 1", format!("{quaternion_xyzw:?}")))
    }
}

/// Translation and quaternion of a pose.
pub(crate) fn pose_toml(pose: &Transform) -> ([f64; 3], [f64; 4]) {
    (pose.translation.vector.into(), quaternion_xyzw(&pose.rotation))
}

/// The quaternion with the fewest decimals that is read as this rotation.
pub(crate) fn quaternion_xyzw(rotation: &UnitQuaternion<f64>) -> [f64; 4] {
    let exact = [rotation.i, rotation.j, rotation.k, rotation.w];
    let same = |parts: &[f64; 4]| {
        transform_from_parts([0.0; 3], *parts).is_some_and(|transform| transform.rotation == *rotation)
    };
    let few = (0..=17).map(|decimals| exact.map(|value| rounded(value, decimals)));
    // Reading makes its length 1 and rounds once more. Where that misses, a neighbour hits, or one of another length.
    let neighbours = (1..3_usize.pow(4)).map(|which| neighbour(exact, which));
    let lengths = (-2048..=2048).map(|step| exact.map(|value| value * (1.0 + f64::from(step) * 1e-12)));
    few.chain([exact]).chain(neighbours).chain(lengths).find(same).unwrap_or(exact)
}

/// One of the 81 quaternions whose parts are the next numbers up or down, or the same.
fn neighbour(exact: [f64; 4], which: usize) -> [f64; 4] {
    let steps = [f64::next_up, f64::next_down, |value: f64| value];
    std::array::from_fn(|part| steps[which / 3_usize.pow(part as u32) % 3](exact[part]))
}

/// The degrees with the fewest decimals that are read as this angle.
pub(crate) fn degrees(radians: f64) -> f64 {
    let exact = radians.to_degrees();
    let few = (0..=17).map(|decimals| rounded(exact, decimals));
    // Where rounding there and back misses, a neighbour of the exact value may hit.
    let candidates = few.chain([exact.next_up(), exact.next_down()]);
    candidates.into_iter().find(|degrees| degrees.to_radians() == radians).unwrap_or(exact)
}

/// The nearest number of so many decimals.
fn rounded(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$}").parse().unwrap_or(value)
}
