//! Where a store keeps what belongs to the images of a sequence.

use super::folder::ViewFolder;
use crate::disk::numbered::number_of;
use crate::disk::real_path::real_path;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::{SequenceNames, WriterLock};
use std::path::{Path, PathBuf};

/// The files of a sequence's images in a store. Beside the images, in a recording of the own layout, they have the
/// numbers of the images' own files, by which the recording finds them; elsewhere the images' places in their timeline.
pub(super) struct ImageFiles {
    store: ViewFolder,
    names: SequenceNames,
    /// Of each camera, whether its images lie in the folder in which the store keeps what belongs to them.
    is_beside: Vec<bool>,
}

impl ImageFiles {
    /// Those of a reader's sequence.
    ///
    /// # Errors
    /// A name that can't be a folder's.
    pub(super) fn new(store: &ViewFolder, reader: &dyn SequenceReader) -> Result<Self, DataError> {
        let names = SequenceNames::new(reader.sequence())?;
        let is_beside = |(camera, name)| {
            let image = reader.image_file(camera, 0);
            let images = image.as_deref().and_then(Path::parent);
            let own = store.of_camera(&names.sequence, name);
            images.is_some_and(|images| real_path(images) == real_path(own.path()))
        };
        let is_beside = names.cameras.iter().enumerate().map(is_beside).collect();
        Ok(Self { store: store.clone(), names, is_beside })
    }

    /// The right to write them; see [`ViewFolder::lock`].
    pub(super) fn lock(&self) -> Result<WriterLock, DataError> {
        self.store.lock(&self.names)
    }

    /// The file of an image's views; `None` of a camera that isn't there. It need not exist.
    pub(super) fn file(&self, reader: &dyn SequenceReader, camera: usize, image: usize) -> Option<PathBuf> {
        let name = self.names.cameras.get(camera)?;
        let number = if self.is_beside[camera] { own_number(reader, camera, image) } else { None };
        Some(self.store.file(&self.names.sequence, name, number.unwrap_or(image)))
    }
}

/// The number that is the name of an image's file.
fn own_number(reader: &dyn SequenceReader, camera: usize, image: usize) -> Option<usize> {
    number_of(&reader.image_file(camera, image)?).and_then(|number| usize::try_from(number).ok())
}
