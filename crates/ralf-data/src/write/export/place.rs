//! Where an export goes: it appears whole or not at all, and never takes the place of anything else.

use super::formats::SingleFile;
use super::record::{RECORD, Record};
use super::ros::foxglove::FILE as LAYOUT;
use super::{ExportFormat, ExportOptions};
use crate::disk::files;
use crate::error::DataError;
use crate::result::own_folder::{self, refuse_others, remove_own};
use crate::result::{Component, OutFolder, WriterLock};
use std::fs;
use std::path::{Path, PathBuf};

/// The folder of an export, or its only file; it is written beside its place.
pub(super) struct Place {
    path: PathBuf,
    part: OutFolder,
    /// What the folder tells of itself.
    record: Record,
    /// An earlier export, while the new one takes its place.
    earlier: PathBuf,
    /// The name that the only file has in the folder that is written.
    file: Option<Component>,
    /// Another export to the same place would write to the same folder beside it.
    _lock: WriterLock,
}

impl Place {
    /// Checks that an export of these sequences may be put at `path`, and begins it.
    pub(super) fn prepare<'n>(
        path: &Path,
        options: &ExportOptions,
        sequences: impl IntoIterator<Item = &'n Component>,
    ) -> Result<Self, DataError> {
        let names: Vec<&Component> = sequences.into_iter().collect();
        let sequences: Vec<String> = names.iter().map(|name| name.as_str().to_owned()).collect();
        let (Some(name), Some(parent)) = (path.file_name(), path.parent()) else {
            return Err(DataError::content(path, "path", "one that ends in a name", "none"));
        };
        let lock = WriterLock::beside(path)?;
        let hidden = |end: &str| parent.join(format!(".{}.{end}", name.to_string_lossy()));
        let (part, earlier) = (OutFolder::new(&hidden("part")), hidden("earlier"));
        bring_back(&earlier, path)?;
        let file = match options.format.single_file() {
            Some(single) if single.is_named_by(path) && !path.is_dir() => {
                check_file(path, single, options, &sequences)?;
                names.first().map(|name| name.and(single.ending))
            }
            _ => {
                check_folder(path, options)?;
                None
            }
        };
        own_folder::begin(&part, RECORD)?;
        let record = Record::new(options, sequences);
        Ok(Self { path: path.to_owned(), part, record, earlier, file, _lock: lock })
    }

    /// The folder to write to.
    pub(super) fn folder(&self) -> &OutFolder {
        &self.part
    }

    /// Puts the layout of an only file beside it. One that is there already may be somebody's own, and stays.
    fn keep_layout(&self) -> Result<(), DataError> {
        let (from, to) = (self.part.own_file(LAYOUT), self.path.with_extension(LAYOUT));
        if !from.exists() || to.exists() {
            return Ok(());
        }
        fs::rename(from, &to).map_err(DataError::io(&to))
    }

    /// Puts the export in its place.
    pub(super) fn finish(self) -> Result<(), DataError> {
        let refused = || DataError::io(&self.path);
        if let Some(file) = &self.file {
            fs::rename(self.part.file(file), &self.path).map_err(refused())?;
            return self.keep_layout();
        }
        self.record.write(&self.part)?;
        // Somebody may have put something there while the export was made.
        check_folder(&self.path, &self.record.options)?;
        remove_own(&self.earlier, RECORD)?;
        if self.path.exists() {
            fs::rename(&self.path, &self.earlier).map_err(refused())?;
        }
        if let Err(error) = fs::rename(self.part.path(), &self.path) {
            // The earlier one comes back; the error that matters is the first one.
            let _ = fs::rename(&self.earlier, &self.path);
            return Err(refused()(error));
        }
        remove_own(&self.earlier, RECORD)
    }
}

impl Drop for Place {
    /// A half-written export is of no use to anyone. Of a finished one nothing is left beside its place.
    fn drop(&mut self) {
        let _ = remove_own(self.part.path(), RECORD);
    }
}

/// An export that was killed while it took the place of an earlier one has left that beside it. It comes back, unless
/// its removal had begun: what is left then would be taken for all.
fn bring_back(earlier: &Path, path: &Path) -> Result<(), DataError> {
    refuse_others(earlier, RECORD)?;
    if files::exists(path)? || !files::exists(earlier)? {
        return Ok(());
    }
    match Record::of(earlier) {
        Some(record) if record.is_whole(earlier)? => fs::rename(earlier, path).map_err(DataError::io(path)),
        _ => remove_own(earlier, RECORD),
    }
}

/// Refuses a file that can't hold the sequences, or must not be replaced.
fn check_file(
    path: &Path,
    single: &SingleFile,
    options: &ExportOptions,
    sequences: &[String],
) -> Result<(), DataError> {
    if sequences.len() != 1 {
        let expected = "one sequence for one file; more of them go into a folder";
        return Err(DataError::content(path, "sequences", expected, sequences.join(", ")));
    }
    if !path.exists() {
        return Ok(());
    }
    if !(single.is_export)(path)? {
        let expected = "no file yet, or an earlier export";
        return Err(DataError::content(path, "file", expected, "one without labelled clouds"));
    }
    if options.replace {
        return Ok(());
    }
    Err(DataError::content(path, "file", "none yet", "an earlier export, which only --force replaces"))
}

/// Refuses a name for a folder that is one of another format's file.
fn refuse_ending(path: &Path, format: ExportFormat) -> Result<(), DataError> {
    let Some(other) = ExportFormat::of_file(path) else { return Ok(()) };
    let expected = format!("a place for the format {}", format.name());
    Err(DataError::content(path, "name", expected, format!("the ending of a file of {}", other.name())))
}

/// Refuses a path where there is something that must not be replaced.
fn check_folder(path: &Path, options: &ExportOptions) -> Result<(), DataError> {
    if !path.exists() {
        return refuse_ending(path, options.format);
    }
    if !path.is_dir() {
        return Err(DataError::content(path, "path", "a folder, or nothing yet", "a file"));
    }
    let mut entries = fs::read_dir(path).map_err(DataError::io(path))?;
    if entries.next().is_none() {
        return Ok(());
    }
    let format = options.format.name();
    let earlier = Record::of(path).filter(|record| record.options.format == options.format);
    let Some(earlier) = earlier else {
        let expected = format!("an empty folder, or an earlier export in the format {format}");
        return Err(DataError::content(path, "folder", expected, "other files"));
    };
    if options.replace {
        return earlier.refuse_others(path);
    }
    let found = format!("an earlier export in the format {format}, which only --force replaces");
    Err(DataError::content(path, "folder", "an empty folder", found))
}
