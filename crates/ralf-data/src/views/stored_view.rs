//! What a store has to know of what it holds.

use super::attached::Stored;
use super::folder::{StoreKind, ViewFolder};
use crate::error::DataError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// What a network says of a view, as it is stored.
pub trait StoredView: Send + Sized {
    /// What a store says of itself: the network, and what else its files don't tell.
    type Card: Serialize + DeserializeOwned + PartialEq + Sync;

    /// What a store of these is called.
    const KIND: StoreKind;

    /// The network that a card names.
    fn network(card: &Self::Card) -> &str;

    /// A store of these, to be attached to a recording.
    fn stored(folder: ViewFolder, card: &Self::Card) -> Stored;

    /// What of a view's size (px: width and height) must be that of the other views in a file.
    fn stacked(size: [usize; 2]) -> [usize; 2];

    /// Whether a file holds what was written: a copy that broke off, or a full disk, cuts files.
    fn is_whole(file: &Path) -> bool;

    /// Stores an image's views in its file, whole or not at all.
    fn write(file: &Path, views: &[Self]) -> Result<(), DataError>;
}
