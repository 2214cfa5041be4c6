//! Where the files of a clip lie, in the data set's own folders or in one of the clip.

use crate::disk::files;
use crate::error::DataError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The files of a clip.
#[derive(Debug, Default)]
pub(super) struct Clip {
    /// The folder that holds `radar`, `labels` and `calibration`.
    root: PathBuf,
    /// By the radar's name.
    pub(super) radars: BTreeMap<String, PathBuf>,
}

/// All clips below a folder, by their names.
pub(super) fn clips(path: &Path) -> Result<BTreeMap<String, Clip>, DataError> {
    let mut clips = BTreeMap::new();
    add(path, &mut clips)?;
    if clips.is_empty() {
        for name in files::folders(path)? {
            add(&path.join(name), &mut clips)?;
        }
    }
    Ok(clips)
}

/// The clips of a folder with a folder `radar`.
fn add(root: &Path, clips: &mut BTreeMap<String, Clip>) -> Result<(), DataError> {
    let radar = root.join("radar");
    let mut folders = vec![radar.clone()];
    folders.extend(files::folders(&radar)?.into_iter().map(|name| radar.join(name)));
    for folder in folders {
        for name in files::names(&folder)? {
            // CLIP.NAME.parquet
            let Some((clip, sensor)) = name.strip_suffix(".parquet").and_then(|stem| stem.rsplit_once('.'))
            else {
                continue;
            };
            if sensor.starts_with("radar_") && !clip.is_empty() {
                let found = clips
                    .entry(clip.to_owned())
                    .or_insert_with(|| Clip { root: root.to_owned(), ..Clip::default() });
                found.radars.insert(sensor.to_owned(), folder.join(&name));
            }
        }
    }
    Ok(())
}

impl Clip {
    /// A clip's table of this name among the labels, in a folder of its own or beside others.
    pub(super) fn label(&self, clip: &str, name: &str) -> Result<Option<PathBuf>, DataError> {
        self.first(&["labels", &format!("labels/{name}")], &format!("{clip}.{name}.parquet"))
    }

    /// The tables that may hold the clip's mountings: its own, named after it or not (as `pai-clip-dl` leaves them), or
    /// those of whole chunks of clips. What was found offline goes before what the vehicle knew, as poses are.
    pub(super) fn extrinsics(&self, clip: &str) -> Result<Vec<PathBuf>, DataError> {
        let mut found = Vec::new();
        for name in ["sensor_extrinsics.offline", "sensor_extrinsics"] {
            for own in [format!("{clip}.{name}.parquet"), format!("{name}.parquet")] {
                found.extend(self.first(&["calibration"], &own)?);
            }
            let folder = self.root.join("calibration").join(name);
            let tables = files::names(&folder)?.into_iter().filter(|name| name.ends_with(".parquet"));
            found.extend(tables.map(|name| folder.join(name)));
        }
        Ok(found)
    }

    /// Whether the clip has anything in this folder.
    pub(super) fn has(&self, folder: &str) -> bool {
        self.root.join(folder).is_dir()
    }

    fn first(&self, folders: &[&str], name: &str) -> Result<Option<PathBuf>, DataError> {
        for folder in folders {
            let file = self.root.join(folder).join(name);
            if files::exists(&file)? {
                return Ok(Some(file));
            }
        }
        Ok(None)
    }
}

/// What is there where clips should be.
pub(super) fn instead(path: &Path) -> Result<&'static str, DataError> {
    files::names(path)?;
    Ok(if is_zipped(path) { "zip files: unzip them where they lie" } else { "none" })
}

/// Whether the radars' files are still zipped.
pub(super) fn is_zipped(path: &Path) -> bool {
    let radar = path.join("radar");
    let folders = files::folders(&radar).unwrap_or_default();
    let is_zip = |name: &String| name.ends_with(".zip");
    folders.iter().any(|name| {
        name.starts_with("radar_") && files::names(&radar.join(name)).unwrap_or_default().iter().any(is_zip)
    })
}
