//! A whole recording as one file, with the settings by which it is read back beside it.

use super::recorder::Recorder;
use super::{RosFormat, left_out, settings};
use crate::disk::alone::alone;
use crate::disk::files::{self, beside};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::outside::refuse_own_places;
use crate::read::recording::{check_motion_corrected, check_nothing_lost};
use crate::result::WriterLock;
use crate::write::export::options::Sensors;
use ralf_files::Kind;
use std::fs;
use std::path::{Path, PathBuf};

/// What [`write_ros`] has written, and what not.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RosWritten {
    /// The file of the settings; `None` of a recording that was copied, for those of the original hold.
    pub settings: Option<PathBuf>,
    /// What the sequence has and such a file has no place for, a name each, for people.
    pub left_out: Vec<String>,
    /// How much later than it was measured everything is written, ns: more than 0 where there are times before 1970,
    /// which ROS doesn't know.
    pub delay_ns: i64,
}

/// Writes all that the sensors of a sequence measured as one file, and beside it, with the ending `.toml`, the settings
/// by which it is read back: which topic is which sensor, and the sensors' uncertainties. Each appears whole or not at
/// all. `progress` is told how many measurements are done. `docs/export.md` tells what is left out.
///
/// # Errors
/// A file that is there already, a place among the sequences of a recording in the own layout, a measurement that can't
/// be read, times that ROS doesn't know, what the system refuses.
pub fn write_ros(
    reader: &dyn SequenceReader,
    file: &Path,
    format: RosFormat,
    progress: &dyn Fn(usize),
) -> Result<RosWritten, DataError> {
    refuse_own_places(file)?;
    check_nothing_lost(reader)?;
    check_motion_corrected(reader)?;
    let _lock = WriterLock::beside(file)?;
    let settings = settings::settings(&usual_settings_file(file), reader)?;
    // Early, for what is refused in the end has taken its time.
    free_places(file, &settings)?;
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).map_err(DataError::io(folder))?;
    }
    let part = beside(file);
    let written = format.create(&part).and_then(|writer| {
        let recorder = Recorder::new(writer, file, reader, Sensors::ALL, false)?;
        let copies = recorder.copies();
        let delay_ns = recorder.record(None, progress)?;
        if copies {
            fs::rename(&part, file).map_err(DataError::io(file))?;
            let left_out = left_out::left_out_of_copy(reader);
            return Ok(RosWritten { settings: None, left_out, delay_ns });
        }
        let left_out = left_out::left_out(reader);
        let settings = Some(put_with_settings(&part, file, &settings)?);
        Ok(RosWritten { settings, left_out, delay_ns })
    });
    if written.is_err() {
        // The half-written file is of no use to anyone; the error that matters is the first one.
        let _ = fs::remove_file(&part);
    }
    written
}

/// Puts a recording in its place, and its settings beside it, whose file is returned. Another conversion, of the same
/// name and another ending, may be about to put its own there: it waits.
fn put_with_settings(part: &Path, file: &Path, settings: &str) -> Result<PathBuf, DataError> {
    let shared = usual_settings_file(file);
    let name = shared.file_name().unwrap_or_default().to_string_lossy();
    let put = || {
        let settings_file = free_places(file, settings)?;
        files::write_whole(&settings_file, settings.as_bytes())?;
        fs::rename(part, file).map_err(DataError::io(file))?;
        Ok(settings_file)
    };
    alone(&shared.with_file_name(format!(".{name}.lock")), put).map_err(DataError::io(&shared))?
}

/// The file for the settings of a recording. Refuses a file that is there, of the recording or of other settings.
fn free_places(file: &Path, settings: &str) -> Result<PathBuf, DataError> {
    let settings_file = settings_file(file, settings);
    let of_another = settings_file.exists() && !is_left(&settings_file, settings);
    let places = [(file, file.exists()), (&settings_file, of_another)];
    if let Some((there, _)) = places.into_iter().find(|(_, is_there)| *is_there) {
        return Err(DataError::content(there, "file", "none of this name yet", "one"));
    }
    Ok(settings_file)
}

/// `t.toml` beside `t.mcap` and beside `t.bag`.
fn usual_settings_file(file: &Path) -> PathBuf {
    file.with_extension("toml")
}

/// Where the settings of a recording go: `t.toml` beside `t.mcap`, and `t.bag.toml` beside `t.bag` where that is
/// another's.
fn settings_file(file: &Path, settings: &str) -> PathBuf {
    let usual = usual_settings_file(file);
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
