//! What writes each format: the one list of writers.

use super::Writer;
use super::options::ExportFormat;
use super::ros::{Ros, RosFormat};
use super::{npz, nuscenes, parquet, pcd, semantic_kitti};
use crate::read::SequenceReader;
use crate::result::SequenceRecord;

/// The writer of a format, for these sequences.
pub(super) fn writer(
    format: ExportFormat,
    sequences: &[(&dyn SequenceReader, &SequenceRecord)],
) -> Box<dyn Writer> {
    match format {
        ExportFormat::Mcap => Box::new(Ros(RosFormat::Mcap)),
        ExportFormat::Rosbag1 => Box::new(Ros(RosFormat::Bag)),
        ExportFormat::SemanticKitti => Box::new(semantic_kitti::SemanticKitti::new(sequences)),
        ExportFormat::Pcd => Box::new(pcd::Pcd),
        ExportFormat::Npz => Box::new(npz::Npz),
        ExportFormat::Parquet => Box::new(parquet::Parquet),
        ExportFormat::NuScenes => Box::new(nuscenes::NuScenes::default()),
    }
}
