//! A folder of what one network says of images: `ROOT/sequences/NAME/CAMERA/KIND/000000.EXTENSION`.

use super::attached::attach;
use super::compute::{Computed, Estimate, ViewObserver, compute_views};
use super::folder::ViewFolder;
use super::stored_view::StoredView;
use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use crate::result::Component;
use std::path::{Path, PathBuf};

/// A folder of what one network says of images.
#[derive(Debug, Clone, PartialEq)]
pub struct Store<V: StoredView> {
    folder: ViewFolder,
    card: V::Card,
}

impl<V: StoredView> Store<V> {
    /// The store that a card tells of, begun if there is none. One of another card is refused.
    pub(super) fn begin(root: &Path, card: V::Card) -> Result<Self, DataError> {
        let folder = ViewFolder::new(root, V::KIND);
        folder.claim(&card, V::network)?;
        Ok(Self { folder, card })
    }

    /// A store that was made before.
    pub fn open(root: &Path) -> Result<Self, DataError> {
        let folder = ViewFolder::new(root, V::KIND);
        let card = folder.read_card()?;
        Ok(Self { folder, card })
    }

    /// The file of this number of a camera: that of the image at this place in its timeline, or, where the store is a
    /// recording of the own layout, of the image whose own file has this number.
    pub fn file(&self, sequence: &Component, camera: &Component, number: usize) -> PathBuf {
        self.folder.file(sequence, camera, number)
    }

    /// Computes and stores what the network says of the images (camera, number) that the store doesn't hold yet, or
    /// holds of another image or other views, several at a time.
    ///
    /// # Errors
    /// What can't be stored, and another process that writes to the store.
    pub fn compute(
        &self,
        reader: &dyn SequenceReader,
        images: &[(usize, usize)],
        estimate: &Estimate<V>,
        jobs: usize,
        observer: &ViewObserver,
    ) -> Result<Computed, DataError> {
        compute_views(reader, images, &self.folder, estimate, jobs, observer)
    }

    /// A recording with what this store holds in place of its own.
    pub fn attach(&self, recording: Recording) -> Recording {
        attach(recording, &V::stored(self.folder.clone(), &self.card))
    }
}
