//! How sensors are mounted, and how the vehicle moved.

use crate::disk::parquet_table::ParquetTable;
use crate::error::DataError;
use crate::read::nvidia::tables::nanoseconds;
use crate::read::rotation::mounting;
use ralf::space::{EgoMotion, PoseSample, Transform, transform_from_parts};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Names of the columns of a pose: a quaternion with its scalar last, and a place, m.
const POSE: [&str; 7] = ["qx", "qy", "qz", "qw", "x", "y", "z"];

/// Mountings by clip and sensor, of each table that was read: those of many clips are in one, and it is read once.
#[derive(Default)]
pub(super) struct Extrinsics(RefCell<BTreeMap<PathBuf, Mountings>>);

type Mountings = BTreeMap<[String; 2], Transform>;

impl Extrinsics {
    /// The mounting of a clip's sensor in the first of these tables that has it, and that table.
    pub(super) fn find<'a>(
        &self,
        clip: &str,
        sensor: &str,
        tables: &'a [PathBuf],
    ) -> Result<Option<(Transform, &'a Path)>, DataError> {
        let key = [clip.to_owned(), sensor.to_owned()];
        let mut known = self.0.borrow_mut();
        for table in tables {
            if !known.contains_key(table) {
                known.insert(table.clone(), mountings(table, clip)?);
            }
            if let Some(mounting) = known.get(table).and_then(|mountings| mountings.get(&key)) {
                return Ok(Some((*mounting, table)));
            }
        }
        Ok(None)
    }
}

/// The most sensors of all clips of a table.
const MOST_MOUNTINGS: usize = 1 << 17;
/// The most poses of a clip.
const MOST_POSES: usize = 1 << 20;

/// All mountings of a table; those of one that names no clips are of `clip`. Rows that name the same have to say the
/// same: nobody could tell which is true.
fn mountings(file: &Path, clip: &str) -> Result<Mountings, DataError> {
    let table = ParquetTable::open(file, MOST_MOUNTINGS)?;
    let poses = poses(file, &table)?;
    let sensors = table.texts("sensor_name")?;
    let clips = if table.has("clip_id") { table.texts("clip_id")? } else { vec![clip.into(); sensors.len()] };
    let named = clips.into_iter().zip(sensors).map(|(clip, sensor)| [clip.to_string(), sensor.to_string()]);
    let mut found = Mountings::new();
    for (row, (key, pose)) in named.zip(poses).enumerate() {
        let place = format!("row {row}");
        let pose = mounting(file, &place, pose)?;
        let told = format!("another one of {} than in a row before", key[1]);
        if found.insert(key, pose).is_some_and(|before| before != pose) {
            return Err(DataError::content(file, place, "one mounting of each sensor of a clip", told));
        }
    }
    Ok(found)
}

/// The poses of a table's rows.
fn poses(file: &Path, table: &ParquetTable) -> Result<Vec<Transform>, DataError> {
    let columns = POSE.iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let pose = |row: usize| {
        let [qx, qy, qz, qw, x, y, z] = std::array::from_fn(|column| columns[column][row]);
        transform_from_parts([x, y, z], [qx, qy, qz, qw]).ok_or_else(|| {
            let expected = "finite numbers, and a quaternion of length 1";
            let found = format!("{:?}", [qx, qy, qz, qw, x, y, z]);
            DataError::content(file, format!("{}, row {row}", POSE.join(" ")), expected, found)
        })
    };
    (0..columns[0].len()).map(pose).collect()
}

/// The vehicle's poses in the frame that it has at the clip's begin.
pub(super) fn motion(file: &Path) -> Result<EgoMotion, DataError> {
    let table = ParquetTable::open(file, MOST_POSES)?;
    let times = table.microseconds("timestamp")?;
    let mut samples: Vec<PoseSample> = Vec::with_capacity(times.len());
    for (row, (time, odom_from_vehicle)) in times.into_iter().zip(poses(file, &table)?).enumerate() {
        let t_ns = nanoseconds(file, row, time)?;
        if samples.last().is_some_and(|before| before.t_ns >= t_ns) {
            let place = format!("timestamp, row {row}");
            return Err(DataError::content(file, place, "times that ascend, us", time.to_string()));
        }
        samples.push(PoseSample { t_ns, odom_from_vehicle });
    }
    EgoMotion::new(Vec::new(), samples).ok_or_else(|| DataError::content(file, "rows", "poses", "none"))
}
