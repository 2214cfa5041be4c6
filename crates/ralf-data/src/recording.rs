//! A recording of any format, seen as its sequences.

use ralf::source::Source;
use std::path::PathBuf;

/// One sequence of a recording, and the files it is read from.
pub trait SequenceReader: Source {
    /// Every file that labelling reads, in a fixed order: what a run records with sizes and hashes.
    fn inputs(&self) -> Vec<PathBuf>;

    /// What was ignored or is missing, a sentence each, for people.
    fn warnings(&self) -> &[String];

    /// The file of a camera's image, to be copied as it is.
    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf>;
}

/// A recording, opened: cheap, for measurements are read on demand.
pub struct Recording {
    /// The folder or file that was opened.
    pub path: PathBuf,
    /// The format's name, as `--format` takes it.
    pub format: &'static str,
    /// In the order of their names.
    pub sequences: Vec<Box<dyn SequenceReader>>,
}
