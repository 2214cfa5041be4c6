//! What a sequence has and a ROS recording has no place for: told, for nothing is left out in silence.

use crate::frames::{ScanIndex, all_scans};
use crate::read::SequenceReader;
use ralf::sensors::{Intrinsics, Sequence};

/// All of it, a name each, for people. What a LiDAR's scans carry is judged by its first.
pub(super) fn left_out(reader: &dyn SequenceReader) -> Vec<&'static str> {
    let Sequence { rig, times, .. } = reader.sequence();
    let radar_scans = all_scans(times);
    let first_scans: Vec<_> =
        (0..rig.lidars.len()).filter_map(|lidar| reader.lidar_scan(lidar, 0).ok()).collect();
    let is_true = |at: &ScanIndex| {
        reader.truth_file(at.radar, at.scan).is_some()
            || matches!(reader.truth(at.radar, at.scan), Ok(Some(_)))
    };
    let has_cause = |at: &ScanIndex| reader.cause_file(at.radar, at.scan).is_some();
    let has_causes = !reader.causes().is_empty() || reader.cause_names_file().is_some();
    let cameras = &rig.cameras;
    let all = [
        ("corrected labels", radar_scans.iter().any(is_true)),
        ("their causes", has_causes || radar_scans.iter().any(has_cause)),
        ("labels of LiDAR points", first_scans.iter().any(|scan| scan.classes.is_some())),
        ("times of LiDAR points", first_scans.iter().any(|scan| scan.times.is_some())),
        ("depth images", (0..cameras.len()).any(|camera| reader.has_depth(camera))),
        ("segmentations", reader.has_segmentation()),
        ("straight views", cameras.iter().any(|camera| !camera.views.is_empty())),
        ("Scaramuzza lenses", cameras.iter().any(|c| matches!(c.intrinsics, Intrinsics::Scaramuzza { .. }))),
    ];
    all.into_iter().filter_map(|(name, is_there)| is_there.then_some(name)).collect()
}
