//! Where what a network said of images lies, in the tree of the project's own layout:
//! `ROOT/sequences/NAME/CAMERA/KIND/000000.EXTENSION`.

use crate::disk::files;
use crate::error::DataError;
use crate::result::{Component, OutFolder, SequenceNames, WriterLock, refuse_links_on_way};
use crate::tree::SEQUENCES;
use ralf_files::Kind;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::{Path, PathBuf};

/// What a store is called.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct StoreKind {
    /// The folder in that of a camera; with `.toml` the file that says what a store holds.
    pub(super) name: &'static str,
    /// How its files end.
    pub(super) extension: &'static str,
    /// The command that fills it.
    pub(super) verb: &'static str,
}

/// A folder of files of one network, one per image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ViewFolder {
    root: PathBuf,
    kind: StoreKind,
}

impl ViewFolder {
    pub(super) fn new(root: &Path, kind: StoreKind) -> Self {
        // What is wrong with its files is told in the same words from wherever the program is started.
        Self { root: files::whole(root), kind }
    }

    /// Where it lies.
    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// What it holds, in a word.
    pub(super) fn what(&self) -> &'static str {
        self.kind.name
    }

    /// Whether it was begun.
    pub(super) fn has_card(&self) -> bool {
        self.card().is_file()
    }

    /// Refuses a store of another network, and files of which nobody knows whose they are: they don't become the
    /// network's. `network` tells whose a store is. Returns whether it was begun.
    pub(super) fn refuse_other<T: DeserializeOwned + PartialEq>(
        &self,
        own: &T,
        network: fn(&T) -> &str,
    ) -> Result<bool, DataError> {
        let file = self.card();
        let found = if files::exists(&file)? {
            let found: T = self.read_card()?;
            if found == *own {
                return Ok(true);
            }
            format!("that of {}", network(&found))
        } else {
            let Some(stray) = self.any_file()? else { return Ok(false) };
            format!("{}, and nothing that tells which network made it", stray.display())
        };
        let expected = format!("{} of the network {}, or another folder", self.kind.name, network(own));
        Err(DataError::content(&file, "network", expected, found))
    }

    /// Writes what the store holds, where nothing tells it; where that is known, it has to be the same.
    pub(super) fn claim<T: Serialize + DeserializeOwned + PartialEq>(
        &self,
        own: &T,
        network: fn(&T) -> &str,
    ) -> Result<(), DataError> {
        if self.refuse_other(own, network)? {
            return Ok(());
        }
        let file = self.card();
        let text = toml::to_string(own);
        let text = text.map_err(|error| DataError::content(&file, "content", "TOML", error.to_string()))?;
        files::write_whole(&file, text.as_bytes())
    }

    /// The first file in the store.
    fn any_file(&self) -> Result<Option<PathBuf>, DataError> {
        let sequences = self.root.join(SEQUENCES);
        for sequence in files::folders(&sequences)? {
            for camera in files::folders(&sequences.join(&sequence))? {
                let folder = sequences.join(&sequence).join(camera).join(self.kind.name);
                let of_kind =
                    |name: &String| Path::new(name).extension().is_some_and(|it| it == self.kind.extension);
                if let Some(name) = files::names(&folder)?.into_iter().find(of_kind) {
                    return Ok(Some(folder.join(name)));
                }
            }
        }
        Ok(None)
    }

    /// What the store says that it holds.
    pub(super) fn read_card<T: DeserializeOwned>(&self) -> Result<T, DataError> {
        let file = self.card();
        let expected = format!("what `ralf {}` wrote", self.kind.verb);
        let refused =
            |error: toml::de::Error| DataError::content(&file, "content", expected, error.to_string());
        toml::from_str(&files::read_text(&file, Kind::Settings)?).map_err(refused)
    }

    /// The folder of a camera, in which that of the store's files lies.
    pub(super) fn of_camera(&self, sequence: &Component, camera: &Component) -> OutFolder {
        OutFolder::new(&self.root).own(SEQUENCES).folder(sequence).folder(camera)
    }

    /// The file of this number.
    pub(super) fn file(&self, sequence: &Component, camera: &Component, number: usize) -> PathBuf {
        let camera = self.of_camera(sequence, camera);
        camera.own(self.kind.name).file(&Component::numbered(number, self.kind.extension))
    }

    /// The right to write what belongs to a sequence's images; another process may have that.
    ///
    /// # Errors
    /// Another process writes, or a folder that would be written to is a link out of the store.
    pub(super) fn lock(&self, names: &SequenceNames) -> Result<WriterLock, DataError> {
        self.refuse_links(names)?;
        WriterLock::take(self.root.join(format!(".{}-lock", self.kind.name)), &self.root)
    }

    /// Refuses a folder of a sequence's cameras that would be written to and is a link out of the store.
    pub(super) fn refuse_links(&self, names: &SequenceNames) -> Result<(), DataError> {
        names.cameras.iter().try_for_each(|camera| {
            let way = [SEQUENCES, names.sequence.as_str(), camera.as_str(), self.kind.name];
            refuse_links_on_way(&self.root, &way)
        })
    }

    fn card(&self) -> PathBuf {
        self.root.join(format!("{}.toml", self.kind.name))
    }
}
