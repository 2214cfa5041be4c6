//! Rotations and rigid transforms out of printed matrices and angles.

use crate::error::{DataError, expected_and_found};
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use ralf::sensors::check_mounting;
use ralf::space::{PoseSample, Transform};
use std::path::Path;

/// Matrices are printed with a few digits; what is farther from orthonormal than this is no rotation.
const ORTHONORMAL_WITHIN: f64 = 1e-3;

/// The rotation nearest to a matrix that is one up to its printed digits.
pub(crate) fn rotation(
    file: &Path,
    place: &str,
    matrix: Matrix3<f64>,
) -> Result<UnitQuaternion<f64>, DataError> {
    let off = (matrix.transpose() * matrix - Matrix3::identity()).abs().max();
    if off <= ORTHONORMAL_WITHIN && matrix.determinant() > 0.0 {
        return Ok(UnitQuaternion::from_rotation_matrix(&orthonormal(&matrix)));
    }
    Err(DataError::content(
        file,
        place,
        format!("a rotation, orthonormal within {ORTHONORMAL_WITHIN}"),
        format!("a matrix off by {off:.3e}, determinant {:.3}", matrix.determinant()),
    ))
}

/// A 4 x 4 matrix, row by row.
pub(crate) type Matrix = [[f64; 4]; 4];

/// The rigid transform that a matrix is, up to its printed digits.
pub(crate) fn rigid(file: &Path, place: &str, matrix: &Matrix) -> Result<Transform, DataError> {
    let [[a, b, c, x], [d, e, f, y], [g, h, i, z], last] = *matrix;
    if last != [0.0, 0.0, 0.0, 1.0] || ![x, y, z].iter().all(|value| value.is_finite()) {
        return Err(DataError::content(file, place, "a last row of 0 0 0 1", format!("{last:?}")));
    }
    let turn = rotation(file, place, Matrix3::new(a, b, c, d, e, f, g, h, i))?;
    Ok(Transform::from_parts(Translation3::new(x, y, z), turn))
}

/// A mounting that a file tells at a place; one that no sensor has is refused, as in the project's own layout.
pub(crate) fn mounting(
    file: &Path,
    place: &str,
    vehicle_from_sensor: Transform,
) -> Result<Transform, DataError> {
    check_mounting(&vehicle_from_sensor).map_err(|reason| {
        let (expected, found) = expected_and_found(&reason);
        DataError::content(file, place, expected, found)
    })?;
    Ok(vehicle_from_sensor)
}

/// A place, and what is there turned to the left by so many rad.
pub(crate) fn turned(translation: [f64; 3], yaw: f64) -> Transform {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), yaw);
    // Of length 1 to the last digit, as what is written and read again is.
    let turn = UnitQuaternion::new_normalize(turn.into_inner());
    Transform::from_parts(Translation3::from(translation), turn)
}

/// Poses in the frame that the vehicle has at the first.
pub(crate) fn relative_to_first(poses: &mut [PoseSample]) {
    let Some(first) = poses.first().map(|pose| pose.odom_from_vehicle) else { return };
    for pose in poses {
        pose.odom_from_vehicle = first.inv_mul(&pose.odom_from_vehicle);
    }
}

/// Columns of unit length at right angles. The first keeps its direction; the others move by less than was refused.
fn orthonormal(matrix: &Matrix3<f64>) -> Rotation3<f64> {
    let x: Vector3<f64> = matrix.column(0).normalize();
    let z = x.cross(&matrix.column(1)).normalize();
    Rotation3::from_basis_unchecked(&[x, z.cross(&x), z])
}
