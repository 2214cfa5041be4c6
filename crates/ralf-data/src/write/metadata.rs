//! What a sequence of the own layout holds beside its measurements: sensors, motion, times.

use crate::error::DataError;
use crate::read::layout::raw::{DepthToml, SequenceToml};
use crate::read::layout::{rig, tables};
use crate::result::{OutFolder, SequenceNames};
use crate::tree::{ODOMETRY, POSES, SENSORS, TIMES};
use ralf::sensors::Sequence;
use std::path::PathBuf;

/// Files with their content: `sequence.toml`, `odometry.csv`, `poses.csv`, and `timestamps.txt` of every sensor. The
/// first is checked as if it were read.
pub(super) fn texts(
    sequence: &Sequence,
    names: &SequenceNames,
    folder: &OutFolder,
) -> Result<Vec<(PathBuf, String)>, DataError> {
    let Sequence { title, rig, motion, times, depth_output, .. } = sequence;
    let (radar, lidar, camera) = rig::rig_toml(rig);
    let depth = DepthToml { output: *depth_output };
    let toml = SequenceToml { format: 1, name: title.clone(), radar, lidar, camera, depth };
    let file = folder.own_file(SENSORS);
    rig::rig(&file, &toml)?;
    let text = toml::to_string(&toml).map_err(|error| {
        DataError::content(&file, "content", "values that TOML can hold", error.to_string())
    })?;
    let mut texts = vec![(file, text)];
    if !motion.odometry().is_empty() {
        texts.push((folder.own_file(ODOMETRY), tables::odometry_text(motion.odometry())));
    }
    if !motion.poses().is_empty() {
        texts.push((folder.own_file(POSES), tables::poses_text(motion.poses())));
    }
    let SequenceNames { radars, lidars, cameras, .. } = names;
    let sensors = radars.iter().chain(lidars).chain(cameras);
    for (sensor, times) in sensors.zip(times.radars.iter().chain(&times.lidars).chain(&times.cameras)) {
        texts.push((folder.folder(sensor).own_file(TIMES), tables::timestamps_text(times)));
    }
    Ok(texts)
}
