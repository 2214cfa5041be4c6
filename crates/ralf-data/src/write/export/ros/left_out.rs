//! What a sequence has and a ROS recording has no place for: told, for nothing is left out in silence.

use crate::frames::{ScanIndex, all_scans};
use crate::read::SequenceReader;
use crate::read::ros::RosOrigin;
use crate::words::listed;
use ralf::sensors::{Intrinsics, Sequence};

/// So many topics are named.
const SHOWN: usize = 5;

/// All of it, a name each, for people. What a LiDAR's scans carry is judged by its first.
pub(super) fn left_out(reader: &dyn SequenceReader) -> Vec<String> {
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
    let named = all.into_iter().filter(|(_, is_there)| *is_there).map(|(name, _)| name.to_owned());
    named.chain(RosOrigin::of(reader).and_then(other_topics)).collect()
}

/// The topics of a ROS recording that no sensor of the sequence was read from, where there are some.
fn other_topics(origin: &RosOrigin) -> Option<String> {
    let others: Vec<&str> = origin.other_topics().iter().map(String::as_str).collect();
    (!others.is_empty()).then(|| format!("topics that no sensor of it is ({})", listed(&others, SHOWN)))
}

/// What a copy lacks of the recording, byte for byte though its messages are.
pub(super) fn left_out_of_copy(reader: &dyn SequenceReader) -> Vec<String> {
    let attached = RosOrigin::of(reader).map_or(0, |origin| origin.container().attached());
    let told = (attached > 0).then(|| "attachments and metadata of MCAP files".to_owned());
    told.into_iter().collect()
}
