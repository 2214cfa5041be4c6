//! A folder of what one network says of images: `ROOT/sequences/NAME/CAMERA/KIND/000000.EXTENSION`.

use super::attached::attach;
use super::compute::{Computed, Estimate, Unusable, ViewObserver, compute_views};
use super::folder::ViewFolder;
use super::stored_view::StoredView;
use crate::error::DataError;
use crate::read::open::refuse_other_format;
use crate::read::{Recording, SequenceReader};
use crate::result::{Component, SequenceNames};
use std::path::{Path, PathBuf};

/// A folder of what one network says of images.
#[derive(Debug, Clone, PartialEq)]
pub struct Store<V: StoredView> {
    folder: ViewFolder,
    card: V::Card,
}

impl<V: StoredView> Store<V> {
    /// The store that a card tells of; the first image that is stored begins it. One of another card is refused, and so
    /// is a recording of another format than the own layout.
    pub(super) fn begin(root: &Path, card: V::Card) -> Result<Self, DataError> {
        let expected = format!("a folder for {}, or a recording in the own layout", V::KIND.name);
        refuse_other_format(root, &expected)?;
        let folder = ViewFolder::new(root, V::KIND);
        folder.refuse_other(&card, V::network)?;
        Ok(Self { folder, card })
    }

    /// The store as it is once something was stored.
    #[cfg(test)]
    pub(super) fn begun(self) -> Result<Self, DataError> {
        self.folder.claim(&self.card, V::network).map(|()| self)
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

    /// Refuses a recording for whose images the store has no place of its own: a folder in it is a link that leads out,
    /// as to images on another disk. [`compute`](Self::compute) refuses it, too, sequence by sequence.
    ///
    /// # Errors
    /// The first such link by name, and where it leads; a name that can't be a folder's.
    pub fn refuse_links(&self, recording: &Recording) -> Result<(), DataError> {
        recording
            .sequences
            .iter()
            .try_for_each(|reader| self.folder.refuse_links(&SequenceNames::new(reader.sequence())?))
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
        compute_views(reader, images, (&self.folder, &self.card), estimate, jobs, observer)
    }

    /// A recording with what this store holds in place of its own.
    pub fn attach(&self, recording: Recording) -> Recording {
        self.attach_but(recording, Vec::new())
    }

    /// The same, where these images of each sequence, in the recording's order, have nothing for a reason that whoever
    /// asks for it is told, as it is told where an image can't be read.
    pub fn attach_but(&self, recording: Recording, without: Vec<Vec<Unusable>>) -> Recording {
        let reason = |found: Unusable| ((found.camera, found.image), found.error.to_string());
        let without = without.into_iter().map(|found| found.into_iter().map(reason).collect());
        attach(recording, &V::stored(self.folder.clone(), &self.card), without.collect())
    }
}
