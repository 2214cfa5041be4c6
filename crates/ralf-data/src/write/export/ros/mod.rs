//! Recordings as ROS keeps them: an MCAP file (ROS 2) or a bag (ROS 1) for each sequence.
//!
//! | topic | type | when |
//! | --- | --- | --- |
//! | `/RADAR/points_labelled` | PointCloud2 | labels |
//! | `/RADAR/points`, `/LIDAR/points` | PointCloud2 | with the sensors' data |
//! | `/CAMERA/image_raw/compressed`, `/CAMERA/camera_info` | CompressedImage, CameraInfo | with the sensors' data |
//! | `/odom` | Odometry: the poses | with the sensors' data |
//! | `/twist` | TwistStamped: what the wheels measured | with the sensors' data |
//! | `/tf` | TFMessage | with the sensors' data |
//! | `/tf_static` | TFMessage | always |
//!
//! Of a sequence that is read from a recording of the same kind, all messages are copied byte for byte where all
//! sensors' data are asked for and settings correct nothing of what they say, and the labelled clouds are in the frames
//! of the original ones.
//!
//! Else a sensor's frame has the sensor's name, the vehicle's is `base_link`, and it moves in `odom`. A message is
//! recorded at the time of its measurement, so that they lie in order; where one is before 1970, which ROS doesn't
//! know, all are put off by some whole seconds.

mod cloud;
mod conversion;
pub(super) mod foxglove;
mod images;
mod left_out;
mod motion;
mod names;
mod originals;
mod recorder;
mod settings;

pub use conversion::{RosWritten, write_ros};

use super::Writer;
use super::labelled::LabelledSequence;
use super::options::{Sensors, Split};
use crate::disk::alone::open_alone;
use crate::error::DataError;
use crate::result::OutFolder;
use foxglove::Layout;
use ralf_ros::container::{Container, recognises};
use ralf_ros::writer::{Compression, MessageWriter, WriteError};
use recorder::Recorder;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;

/// The kind of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RosFormat {
    /// `.mcap`, of the profile `ros2`, compressed by zstd.
    Mcap,
    /// `.bag` 2.0 of ROS 1, not compressed.
    Bag,
}

/// A file in the making.
type FileWriter = MessageWriter<BufWriter<File>>;

impl RosFormat {
    /// The kind that a file's name tells of, in capitals or not.
    pub fn of_file(file: &Path) -> Option<Self> {
        let found = file.extension()?;
        [Self::Mcap, Self::Bag].into_iter().find(|format| found.eq_ignore_ascii_case(format.extension()))
    }

    /// How the names of files end, without the dot.
    pub fn extension(self) -> &'static str {
        match self {
            Self::Mcap => "mcap",
            Self::Bag => "bag",
        }
    }

    /// The same with the dot.
    pub(super) const fn ending(self) -> &'static str {
        match self {
            Self::Mcap => ".mcap",
            Self::Bag => ".bag",
        }
    }

    fn create(self, file: &Path) -> Result<FileWriter, DataError> {
        let open = BufWriter::new(open_alone(file).map_err(DataError::io(file))?);
        let writer = match self {
            Self::Mcap => MessageWriter::mcap(open, Compression::Zstd),
            Self::Bag => MessageWriter::bag(open),
        };
        writer.map_err(written(file))
    }
}

/// Writes the labels of sequences, and for MCAP files a layout of Foxglove beside them.
pub(super) struct Ros {
    format: RosFormat,
    layout: Layout,
}

impl Ros {
    pub(super) fn new(format: RosFormat) -> Self {
        Self { format, layout: Layout::default() }
    }
}

impl Writer for Ros {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let file = folder.file(&sequence.names.sequence.and(self.format.ending()));
        let (reader, sensors) = (sequence.reader, sequence.sensors);
        let recorder = Recorder::new(self.format.create(&file)?, &file, reader, sensors, true)?;
        // Of a copied recording the other topics have their own names.
        let shown =
            if recorder.copies() { Sensors { lidar: false, camera: false, ..sensors } } else { sensors };
        if recorder.copies() && sequence.split != Split::All {
            return Err(split_of_copies(sequence));
        }
        self.layout.add(recorder.names(), shown);
        let delay_ns = recorder.record(Some(&mut *sequence), &|_| {})?;
        sequence.delayed(delay_ns);
        Ok(())
    }

    fn finish(&mut self, folder: &OutFolder) -> Result<(), DataError> {
        match self.format {
            RosFormat::Mcap => self.layout.write(&folder.own_file(foxglove::FILE)),
            RosFormat::Bag => Ok(()),
        }
    }
}

/// Messages that are copied byte for byte hold all detections, and some of them in types that nobody here knows.
fn split_of_copies(sequence: &LabelledSequence) -> DataError {
    let reason = "expected all detections (--split all) where all messages are copied as they are, found a part of \
                  them: --sensors=lidar,camera leaves out the radars' own messages, and labelled clouds have all that \
                  the radars measured";
    DataError::Unsuitable { file: sequence.name().into(), place: "split".into(), reason: reason.into() }
}

/// The file could not be written: with all reasons, for libraries hide the system's behind their own.
fn written(file: &Path) -> impl Fn(WriteError) -> DataError {
    move |error| {
        let mut texts = vec![error.to_string()];
        let mut reason = error.source();
        while let Some(error) = reason {
            texts.push(error.to_string());
            reason = error.source();
        }
        // Some tell the reason's text as their own.
        texts.dedup();
        DataError::io(file)(std::io::Error::other(texts.join(": ")))
    }
}

/// Whether a file has a labelled cloud, as every export has.
pub(super) fn is_labelled(file: &Path) -> Result<bool, DataError> {
    if !recognises(file) {
        return Ok(false);
    }
    let container = Container::open(file)?;
    Ok(container.topics().iter().any(|topic| topic.name.ends_with(names::LABELLED)))
}
