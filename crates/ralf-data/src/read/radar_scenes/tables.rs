//! The two tables of a file as they are needed.

use super::labels::Convention;
use crate::disk::hdf5::Hdf5File;
use crate::error::DataError;
use crate::read::instances::numbered;
use crate::read::point_times::nanoseconds;
use crate::read::rotation::turned;
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform};
use std::path::Path;

/// The radar columns that are kept, and what they are called here.
pub(super) const COLUMNS: [(&str, &str); 9] = [
    ("range_sc", "range"),
    ("azimuth_sc", "azimuth"),
    ("rcs", "rcs"),
    ("vr", "doppler"),
    ("vr_compensated", "doppler_compensated"),
    ("x_cc", "x_cc"),
    ("y_cc", "y_cc"),
    ("x_seq", "x_seq"),
    ("y_seq", "y_seq"),
];

/// Radars go on measuring for up to 173 ms after the last row of the odometry, so that the motion goes on for so many
/// poses beyond it.
const BEYOND: i64 = 6;
/// Between two of them, ns: on a bend's chord the vehicle is a centimetre beside it.
const STEP_NS: i64 = 50_000_000;

/// All detections of a sequence.
pub(super) struct Detections {
    /// In the order of [`COLUMNS`].
    pub(super) columns: Vec<Vec<f32>>,
    /// Which radar measured each.
    pub(super) sensors: Vec<i64>,
    /// SemanticKITTI ids; the error is the first number that the convention doesn't have.
    pub(super) classes: Result<Vec<u16>, String>,
    /// Whose labels these are.
    pub(super) convention: Convention,
    /// Which object each belongs to, 0 for none.
    pub(super) instances: Vec<u16>,
    /// How the vehicle moved.
    pub(super) motion: EgoMotion,
}

/// Reads both tables.
pub(super) fn detections(file: &Path) -> Result<Detections, DataError> {
    let opened = Hdf5File::open(file)?;
    let table = opened.table("radar_data")?;
    let columns = COLUMNS.iter().map(|(name, _)| table.floats(name)).collect::<Result<_, _>>()?;
    let sensors = table.integers("sensor_id")?;
    let ids = table.integers("label_id")?;
    let convention = Convention::of(&ids);
    let class = |(row, id): (usize, &i64)| convention.class(*id).ok_or_else(|| format!("{id} in row {row}"));
    let classes = ids.iter().enumerate().map(class).collect();
    let instances = numbered(table.texts("track_id")?);
    let motion = motion(file, &opened)?;
    Ok(Detections { columns, sensors, classes, convention, instances, motion })
}

fn motion(file: &Path, opened: &Hdf5File) -> Result<EgoMotion, DataError> {
    let table = opened.table("odometry")?;
    let times = table.integers("timestamp")?;
    let [x, y, yaw] = [table.numbers("x_seq")?, table.numbers("y_seq")?, table.numbers("yaw_seq")?];
    let [speed, yaw_rate] = [table.numbers("vx")?, table.numbers("yaw_rate")?];
    let (mut odometry, mut poses) = (Vec::new(), Vec::new());
    let mut first: Option<Transform> = None;
    for row in 0..table.rows() {
        let error = |name: &str, expected: &str, found: String| {
            Err(DataError::content(file, format!("odometry, {name}, row {row}"), expected, found))
        };
        let after = row.checked_sub(1).map(|before| times[before]);
        let ascends = after.is_none_or(|before| times[row] > before);
        let Some(t_ns) = nanoseconds(times[row]).filter(|_| ascends) else {
            return error("timestamp", "times that ascend, us", times[row].to_string());
        };
        let values = [x[row], y[row], yaw[row], speed[row], yaw_rate[row]];
        if values.iter().any(|value| !value.is_finite()) {
            return error("x_seq, y_seq, yaw_seq, vx, yaw_rate", "numbers", format!("{values:?}"));
        }
        let pose = turned([x[row], y[row], 0.0], yaw[row]);
        let odom_from_vehicle = first.get_or_insert(pose).inv_mul(&pose);
        odometry.push(OdometrySample { t_ns, velocity: speed[row], yaw_rate: yaw_rate[row] });
        poses.push(PoseSample { t_ns, odom_from_vehicle });
    }
    let poses = going_on(&odometry, poses);
    EgoMotion::new(odometry, poses).ok_or_else(|| DataError::content(file, "odometry", "rows", "none"))
}

/// The poses, and some on either side to where the outermost speed and yaw rate lead.
fn going_on(odometry: &[OdometrySample], poses: Vec<PoseSample>) -> Vec<PoseSample> {
    let (Some(first), Some(last)) = (poses.first(), poses.last()) else { return poses };
    let Some(wheels) = EgoMotion::new(odometry.to_vec(), Vec::new()) else { return poses };
    let beyond = |end: &PoseSample, by_ns: i64| {
        let t_ns = end.t_ns.saturating_add(by_ns);
        PoseSample { t_ns, odom_from_vehicle: end.odom_from_vehicle * wheels.between(end.t_ns, t_ns) }
    };
    let head = (1..=BEYOND).rev().map(|step| beyond(first, -step * STEP_NS));
    let tail = (1..=BEYOND).map(|step| beyond(last, step * STEP_NS));
    head.chain(poses.iter().copied()).chain(tail).collect()
}
