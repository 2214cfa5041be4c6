//! Which of a scene's measurements lie on disk: parts of such data sets are published one by one. A radar's file that
//! is missing beside others of its folder is no such part: its scan keeps its place, and can't be read.

use super::join::{Channel, Measurement};
use super::raw::{Modality, Token};
use crate::disk::files::Folders;
use crate::error::DataError;
use crate::read::measured_files::{MeasuredFiles, expected, present};
use ralf::sensors::Timelines;
use std::path::Path;

/// What the tables call the radar scans of a scene: a sequence's
/// [`origin`](crate::read::SequenceReader::origin).
pub(crate) struct TableOrigin {
    /// The version folder's name, as `v1.0-mini`.
    pub(crate) version: String,
    /// The row of each scan of each radar in `sample_data.json`.
    radar_tokens: Vec<Vec<Token>>,
}

impl TableOrigin {
    /// The row of a radar's scan in `sample_data.json`.
    pub(crate) fn sample_data_token(&self, radar: usize, scan: usize) -> Option<String> {
        Some(self.radar_tokens.get(radar)?.get(scan)?.to_string())
    }
}

/// The measurements of a scene that are there, sensor by sensor, and radar scans that should be.
#[derive(Default)]
pub(crate) struct Measurements {
    pub(crate) times: Timelines,
    pub(crate) files: MeasuredFiles,
    /// What the tables list and the disk lacks, a sentence per sensor.
    pub(crate) warnings: Vec<String>,
    radar_tokens: Vec<Vec<Token>>,
}

impl Measurements {
    /// Keeps what is on disk of what the tables list, and radar scans whose files are missing there.
    pub(crate) fn find(
        dataset: &Path,
        channels: Vec<Channel>,
        folders: &mut Folders,
    ) -> Result<Self, DataError> {
        let mut found = Self::default();
        for channel in channels {
            found.add(dataset, channel, folders)?;
        }
        Ok(found)
    }

    /// The names that the tables of this version folder have for the radars' scans.
    pub(crate) fn origin(&mut self, version: &Path) -> TableOrigin {
        let version = version.file_name().unwrap_or_default().to_string_lossy().into_owned();
        TableOrigin { version, radar_tokens: std::mem::take(&mut self.radar_tokens) }
    }

    fn add(&mut self, dataset: &Path, channel: Channel, folders: &mut Folders) -> Result<(), DataError> {
        let listed = channel.measurements.into_iter();
        let listed = listed.map(|Measurement { token, t_ns, file }| ((t_ns, token), dataset.join(&*file)));
        let (name, modality) = (&channel.calibration.name, channel.calibration.modality);
        let listed = listed.collect();
        let found = match modality {
            Modality::Radar => expected(name, listed, folders, &mut self.warnings)?,
            _ => present(name, listed, folders, &mut self.warnings)?,
        };
        let (named, files): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        let (times, tokens): (Vec<_>, Vec<_>) = named.into_iter().unzip();
        let (timelines, place) = match modality {
            Modality::Radar => {
                self.radar_tokens.push(tokens);
                (&mut self.times.radars, &mut self.files.radars)
            }
            Modality::Lidar => (&mut self.times.lidars, &mut self.files.lidars),
            Modality::Camera => (&mut self.times.cameras, &mut self.files.cameras),
            Modality::Other => return Ok(()),
        };
        timelines.push(times);
        place.push(files);
        Ok(())
    }
}
