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
//! sensors' data are asked for, and the labelled clouds are in the frames of the original ones.
//!
//! Else a sensor's frame has the sensor's name, the vehicle's is `base_link`, and it moves in `odom`. A message is
//! recorded at the time of its measurement, so that they lie in order; where one is before 1970, which ROS doesn't
//! know, all are put off by some whole seconds.

mod cloud;
pub(super) mod foxglove;
mod images;
mod left_out;
mod motion;
mod names;
mod originals;
mod recorder;
mod settings;

use super::Writer;
use super::labelled::LabelledSequence;
use super::options::{Sensors, Split};
use crate::disk::files;
use crate::disk::files::{beside, remove};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::recording::{check_motion_corrected, check_nothing_lost};
use crate::result::{OutFolder, WriterLock};
use foxglove::Layout;
use ralf_files::Kind;
use ralf_ros::container::{Container, recognises};
use ralf_ros::writer::{Compression, MessageWriter, WriteError};
use recorder::Recorder;
use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::{Path, PathBuf};

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
        let open = BufWriter::new(File::create(file).map_err(DataError::io(file))?);
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

/// What [`write_ros`] has written, and what not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RosWritten {
    /// The file of the settings; `None` of a recording that was copied, for those of the original hold.
    pub settings: Option<PathBuf>,
    /// What the sequence has and such a file has no place for, a name each, for people.
    pub left_out: Vec<&'static str>,
    /// How much later than it was measured everything is written, ns: more than 0 where there are times before 1970,
    /// which ROS doesn't know.
    pub delay_ns: i64,
}

/// Writes all that the sensors of a sequence measured as one file, and beside it, with the ending `.toml`, the settings
/// by which it is read back: which topic is which sensor, and the sensors' uncertainties. Each appears whole or not at
/// all. `progress` is told how many measurements are done. `docs/export.md` tells what is left out.
///
/// # Errors
/// A file that is there already, a measurement that can't be read, times that ROS doesn't know, what the system
/// refuses.
pub fn write_ros(
    reader: &dyn SequenceReader,
    file: &Path,
    format: RosFormat,
    progress: &dyn Fn(usize),
) -> Result<RosWritten, DataError> {
    check_nothing_lost(reader)?;
    check_motion_corrected(reader)?;
    let _lock = WriterLock::beside(file)?;
    let settings = settings::settings(&file.with_extension("toml"), reader)?;
    let settings_file = settings_file(file, &settings);
    let of_another = settings_file.exists() && !is_left(&settings_file, &settings);
    if let Some(there) = [(file, file.exists()), (&settings_file, of_another)].into_iter().find(|(_, is)| *is)
    {
        let (there, _) = there;
        return Err(DataError::content(there, "file", "none of this name yet", "one"));
    }
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(DataError::io(folder))?;
    }
    let part = beside(file);
    let written = format.create(&part).and_then(|writer| {
        let recorder = Recorder::new(writer, file, reader, Sensors::ALL, false)?;
        let copies = recorder.copies();
        let delay_ns = recorder.record(None, progress)?;
        let left_out = if copies { Vec::new() } else { left_out::left_out(reader) };
        if !copies {
            files::write_whole(&settings_file, settings.as_bytes())?;
        }
        fs::rename(&part, file).map_err(DataError::io(file))?;
        Ok(RosWritten { settings: (!copies).then_some(settings_file), left_out, delay_ns })
    });
    if written.is_err() {
        // The half-written file is of no use to anyone; the error that matters is the first one.
        let _ = remove(&part);
    }
    written
}

/// Where the settings of a recording go: `t.toml` beside `t.mcap`, and `t.bag.toml` beside `t.bag` where that is
/// another's.
fn settings_file(file: &Path, settings: &str) -> PathBuf {
    let usual = file.with_extension("toml");
    if !usual.exists() || is_left(&usual, settings) {
        return usual;
    }
    let mut name = file.as_os_str().to_owned();
    name.push(".toml");
    name.into()
}

/// Whether these settings lie here for a file that isn't there: a conversion that was killed at its very end leaves
/// them.
fn is_left(settings_file: &Path, settings: &str) -> bool {
    let formats = [RosFormat::Mcap, RosFormat::Bag];
    let is_used = formats.iter().any(|format| settings_file.with_extension(format.extension()).exists());
    !is_used && files::read_text(settings_file, Kind::Settings).is_ok_and(|found| found == settings)
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
