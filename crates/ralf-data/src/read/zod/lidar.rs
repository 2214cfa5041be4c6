//! A revolution of the merged LiDARs.

use crate::disk::npy::records::Records;
use crate::error::DataError;
use crate::read::point_times::seconds_after;
use ralf::sensors::LidarScan;
use std::path::Path;

/// The box of the own roof and its rack in the LiDAR's frame, which ZOD's own tools leave out, m.
const OWN_VEHICLE: [[f32; 2]; 3] = [[-1.5, 1.5], [-3.0, 3.0], [-1.5, 0.5]];

/// The points of a file where they were measured, each with its time; those of the own vehicle are no returns.
pub(super) fn read(file: &Path, t_ns: i64) -> Result<LidarScan, DataError> {
    let records = Records::read(file)?;
    let axes = [records.column("x")?, records.column("y")?, records.column("z")?];
    let after = records.integers("timestamp")?;
    let intensity = records.column("intensity")?;
    let (mut points, mut times) = (Vec::with_capacity(after.len()), Vec::with_capacity(after.len()));
    for (n, us) in after.iter().enumerate() {
        let point = [axes[0][n], axes[1][n], axes[2][n]];
        let is_own = point.iter().zip(OWN_VEHICLE).all(|(v, [low, high])| (low..=high).contains(v));
        points.push(if is_own { [0.0; 3] } else { point });
        let time = seconds_after(t_ns.saturating_add(us.saturating_mul(1000)), t_ns).map_err(|expected| {
            DataError::content(
                file,
                format!("record {n}, `timestamp`"),
                expected,
                format!("{us} us after it"),
            )
        })?;
        times.push(time);
    }
    Ok(LidarScan { t_ns, points, times: Some(times), intensity, classes: None })
}
