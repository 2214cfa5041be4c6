//! Images of which a store holds nothing: whoever filled it was stopped, or had no such images.

use super::folder::ViewFolder;
use super::image_files::ImageFiles;
use super::stored_view::StoredView;
use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use ralf::config::{Config, nanoseconds};
use ralf::sensors::{ClassImage, DepthImage, Sequence};
use ralf::space::sync;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A camera of some of whose images a store holds something, and not of all.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Lacking {
    /// The store's folder.
    pub store: PathBuf,
    /// What it holds: `depth` or `segmentation`.
    pub what: &'static str,
    /// Name of the sequence.
    pub sequence: String,
    /// Name of the camera.
    pub camera: String,
    /// Of so many images it holds nothing.
    pub missing: usize,
    /// So many images labelling asks for.
    pub of: usize,
    /// The first that is missing.
    pub first: usize,
}

impl Lacking {
    /// For people.
    pub fn words(&self) -> String {
        let Self { store, what, sequence, camera, missing, of, first } = self;
        let file = store.display();
        format!("{file}: no {what} of {missing} of {of} images of {sequence} {camera}, the first is {first}")
    }
}

/// The images, camera and number, that are nearest to some radar scan within a tolerance in ms: those that labelling
/// asks for.
pub fn images_of_scans(sequence: &Sequence, tolerance_ms: f64) -> Vec<(usize, usize)> {
    let tolerance = nanoseconds(tolerance_ms);
    let of_camera = |(camera, times): (usize, &Vec<i64>)| {
        let scans = sequence.times.radars.iter().flatten();
        let images: BTreeSet<usize> =
            scans.filter_map(|t_ns| sync::nearest(times, *t_ns, tolerance)).collect();
        images.into_iter().map(move |image| (camera, image)).collect::<Vec<_>>()
    };
    sequence.times.cameras.iter().enumerate().flat_map(of_camera).collect()
}

/// What the stores in these folders lack of the images that labelling a recording asks for; of a recording that is a
/// store itself, where no folder is named, what that one lacks.
///
/// # Errors
/// A name in the recording that can't be a folder's.
pub fn lacking(
    recording: &Recording,
    depth: Option<&Path>,
    segmentation: Option<&Path>,
    config: &Config,
) -> Result<Vec<Lacking>, DataError> {
    if !config.camera.enabled {
        return Ok(Vec::new());
    }
    let mut all = Vec::new();
    let stores = [(depth, DepthImage::KIND), (segmentation, ClassImage::KIND)];
    for (folder, kind) in stores {
        let store = ViewFolder::new(folder.unwrap_or(&recording.path), kind);
        if !store.has_card() {
            continue;
        }
        for reader in &recording.sequences {
            all.extend(of_sequence(reader.as_ref(), &store, config.sync.camera_tolerance_ms)?);
        }
    }
    Ok(all)
}

fn of_sequence(
    reader: &dyn SequenceReader,
    store: &ViewFolder,
    tolerance_ms: f64,
) -> Result<Vec<Lacking>, DataError> {
    let sequence = reader.sequence();
    let files = ImageFiles::new(store, reader)?;
    let asked = images_of_scans(sequence, tolerance_ms);
    let mut found = Vec::new();
    for (place, camera) in sequence.rig.cameras.iter().enumerate() {
        let images: Vec<usize> =
            asked.iter().filter(|(camera, _)| *camera == place).map(|(_, image)| *image).collect();
        let lacks = |image: &&usize| !files.file(reader, place, **image).is_some_and(|file| file.exists());
        let missing: Vec<usize> = images.iter().filter(lacks).copied().collect();
        let Some(first) = missing.first().copied().filter(|_| missing.len() < images.len()) else { continue };
        found.push(Lacking {
            store: store.root().to_owned(),
            what: store.what(),
            sequence: sequence.name.clone(),
            camera: camera.name.clone(),
            missing: missing.len(),
            of: images.len(),
            first,
        });
    }
    Ok(found)
}
