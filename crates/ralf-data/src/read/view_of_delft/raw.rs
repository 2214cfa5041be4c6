//! Calibration and pose files, and the numbering of frames, as they lie on disk.

use crate::disk::files;
use crate::disk::numbered::number_of;
use crate::error::DataError;
use ralf_files::Kind;
use serde::Deserialize;
use std::path::Path;

/// Frames are taken at 10 Hz.
pub(super) const FRAME_NS: i64 = 100_000_000;

/// A frame: its number, and that number as the files have it (`00549`).
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Frame {
    pub(super) number: u32,
    pub(super) stem: String,
}

impl Frame {
    /// When it was taken, ns.
    pub(super) fn time_ns(&self) -> i64 {
        i64::from(self.number) * FRAME_NS
    }
}

/// The frames of a folder of `.bin` files, ascending; at least one. Hidden files are none: macOS leaves `._00549.bin`
/// beside `00549.bin`.
pub(super) fn frames(folder: &Path) -> Result<Vec<Frame>, DataError> {
    let mut frames = Vec::new();
    for entry in files::entries(folder, "a folder of frames, NNNNN.bin")? {
        let file = entry.map_err(DataError::io(folder))?.path();
        let stem = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        if file.extension().is_none_or(|extension| extension != "bin") || stem.starts_with('.') {
            continue;
        }
        let number = number_of(&file).and_then(|number| u32::try_from(number).ok());
        let number =
            number.ok_or_else(|| DataError::content(&file, "file name", "a frame's number", &stem))?;
        frames.push(Frame { number, stem });
    }
    frames.sort();
    if let Some(pair) = frames.windows(2).find(|pair| pair[0].number == pair[1].number) {
        let found = format!("{} and {}", pair[0].stem, pair[1].stem);
        return Err(DataError::content(folder, "file names", "one file per frame", found));
    }
    if frames.is_empty() {
        return Err(DataError::content(folder, "files", "frames, NNNNN.bin", "none"));
    }
    Ok(frames)
}

/// The numbers of KITTI's calibration file that are needed, row-major.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Calib {
    /// 3 x 4: camera to pixels.
    pub(super) p2: [f64; 12],
    /// 3 x 3: rectification.
    pub(super) r0_rect: [f64; 9],
    /// 3 x 4: the folder's sensor to the camera.
    pub(super) tr_velo_to_cam: [f64; 12],
}

impl Calib {
    /// Reads a file of lines `KEY: numbers`. Other keys (the empty `Tr_imu_to_velo:` among them) don't matter.
    pub(super) fn read(file: &Path) -> Result<Self, DataError> {
        let text = files::read_text(file, Kind::Settings)?;
        Ok(Self {
            p2: numbers(file, &text, "P2")?,
            r0_rect: numbers(file, &text, "R0_rect")?,
            tr_velo_to_cam: numbers(file, &text, "Tr_velo_to_cam")?,
        })
    }
}

fn numbers<const N: usize>(file: &Path, text: &str, key: &str) -> Result<[f64; N], DataError> {
    let mut lines =
        text.lines().enumerate().filter_map(|(index, line)| Some((index + 1, line.split_once(':')?)));
    let bad =
        |place, found: &str| DataError::content(file, place, format!("`{key}:` and {N} numbers"), found);
    let Some((line, (_, rest))) = lines.find(|(_, (found, _))| found.trim() == key) else {
        return Err(bad("lines".to_owned(), "no such line"));
    };
    let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
    let parsed: Option<Vec<f64>> = rest.split_whitespace().map(number).collect();
    parsed.and_then(|values| values.try_into().ok()).ok_or_else(|| bad(format!("line {line}"), rest.trim()))
}

/// One of the documents of a pose file.
#[derive(Deserialize)]
struct PoseDocument {
    #[serde(rename = "odomToCamera")]
    odom_from_camera: Option<[f64; 16]>,
}

/// `odomToCamera` (which maps camera to odom), 4 x 4 row-major, from a file of several JSON documents. `None` where the
/// file isn't there, is empty, or ends before it: the published data set has such frames.
pub(super) fn read_odom_from_camera(file: &Path) -> Result<Option<[f64; 16]>, DataError> {
    if !files::exists(file)? {
        return Ok(None);
    }
    let text = files::read_text(file, Kind::Settings)?;
    for document in serde_json::Deserializer::from_str(&text).into_iter::<PoseDocument>() {
        match document {
            Ok(PoseDocument { odom_from_camera: None }) => {}
            Ok(PoseDocument { odom_from_camera }) => return Ok(odom_from_camera),
            Err(error) if error.is_eof() => return Ok(None),
            Err(error) => {
                let place = format!("line {}", error.line());
                let expected = "JSON documents, one with 16 numbers `odomToCamera`";
                return Err(DataError::content(file, place, expected, error.to_string()));
            }
        }
    }
    Ok(None)
}
