//! Label sidecars for nuScenes and TruckScenes, laid out as nuScenes-lidarseg: `radarseg/VERSION/TOKEN_radarseg.bin`
//! with one uint8 per point of the `.pcd`, `VERSION/radarseg.json` that lists them by `sample_data` token, and the
//! classes beside it.
//!
//! The table of classes has a name of its own: nuScenes' `category.json` lies in the same folder and must not be
//! overwritten.

use super::Writer;
use super::labelled::LabelledSequence;
use crate::disk::files;
use crate::error::DataError;
use crate::read::scene_tables::TableOrigin;
use crate::result::{Component, OutFolder, checked};
use ralf::label::{PLAUSIBLE, class_name, truth_of};
use serde::Serialize;
use std::any::Any;
use std::collections::BTreeMap;
use std::path::Path;

/// Writes the sidecars.
#[derive(Default)]
pub(super) struct NuScenes {
    /// The rows of `radarseg.json` by version.
    rows: BTreeMap<Component, Vec<Row>>,
}

/// A row of `radarseg.json`.
#[derive(Serialize)]
struct Row {
    token: String,
    sample_data_token: String,
    /// Relative to the data set's folder.
    filename: String,
}

/// A row of `radarseg_category.json`.
#[derive(Serialize)]
struct Category {
    token: String,
    name: &'static str,
    description: String,
    /// The value in a sidecar.
    index: u8,
}

impl Writer for NuScenes {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let ids = class_ids();
        let origin = origin(sequence)?;
        let version = &origin.version;
        for radar in 0..sequence.reader.sequence().rig.radars.len() {
            for scan in 0..sequence.scans(radar) {
                let sample_data_token =
                    origin.sample_data_token(radar, scan).ok_or_else(|| no_tokens(sequence.name()))?;
                let labels = sequence.scan(radar, scan)?.labels_in_place();
                let bytes: Vec<u8> = labels.iter().map(|label| index(&ids, label.id)).collect();
                let token = checked("sample_data token", &sample_data_token)?.and("_radarseg.bin");
                let folder_name = checked("version", version)?;
                files::write_whole(&folder.own("radarseg").folder(&folder_name).file(&token), &bytes)?;
                let filename = format!("radarseg/{version}/{}", token.as_str());
                let row = Row { token: sample_data_token.clone(), sample_data_token, filename };
                self.rows.entry(folder_name).or_default().push(row);
            }
        }
        Ok(())
    }

    fn finish(&mut self, folder: &OutFolder) -> Result<(), DataError> {
        for (version, rows) in &self.rows {
            let folder = folder.folder(version);
            write_table(&folder.own_file("radarseg.json"), rows)?;
            write_table(&folder.own_file("radarseg_category.json"), &categories())?;
        }
        Ok(())
    }
}

fn origin<'a>(sequence: &LabelledSequence<'a, '_>) -> Result<&'a TableOrigin, DataError> {
    let origin = sequence.reader.origin().and_then(<dyn Any>::downcast_ref);
    origin.ok_or_else(|| no_tokens(sequence.name()))
}

fn no_tokens(sequence: &str) -> DataError {
    DataError::Unsuitable {
        file: sequence.into(),
        place: "sample_data tokens".to_owned(),
        reason: "only a recording that is read from the tables of nuScenes or TruckScenes has them"
            .to_owned(),
    }
}

/// SemanticKITTI's ids, ascending: a class's place here is its value in a sidecar.
fn class_ids() -> Vec<u16> {
    (0..=u16::MAX).filter(|id| class_name(*id).is_some()).collect()
}

/// The value of a label. Ids that SemanticKITTI doesn't have are plausible, of unknown class.
fn index(ids: &[u16], id: u16) -> u8 {
    let place = ids.binary_search(&id).or_else(|_| ids.binary_search(&PLAUSIBLE));
    place.map_or(0, |place| place as u8)
}

fn categories() -> Vec<Category> {
    let category = |(index, id): (usize, &u16)| {
        let name = class_name(*id).unwrap_or_default();
        let kind = match truth_of(*id) {
            Some(true) => "plausible",
            Some(false) => "artifact",
            None => "unlabeled",
        };
        let description = format!("{kind}; SemanticKITTI id {id}");
        let token = blake3::hash(name.as_bytes()).to_hex()[..32].to_owned();
        Category { token, name, description, index: index as u8 }
    };
    class_ids().iter().enumerate().map(category).collect()
}

fn write_table<T: Serialize>(file: &Path, rows: &[T]) -> Result<(), DataError> {
    let json = serde_json::to_string_pretty(rows).map_err(std::io::Error::from);
    files::write_whole(file, (json.map_err(DataError::io(file))? + "\n").as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::label::{ARTIFACT, UNLABELED};

    #[test]
    fn every_label_has_a_value_that_the_table_explains() {
        let (ids, table) = (class_ids(), categories());
        let explained = |id: u16| {
            let category = &table[usize::from(index(&ids, id))];
            assert_eq!(category.index, index(&ids, id));
            category.description.as_str()
        };
        assert_eq!(explained(UNLABELED), "unlabeled; SemanticKITTI id 0");
        assert_eq!(explained(ARTIFACT), "artifact; SemanticKITTI id 1");
        assert_eq!(explained(PLAUSIBLE), "plausible; SemanticKITTI id 99");
        assert_eq!(explained(40), "artifact; SemanticKITTI id 40");
        assert_eq!(explained(259), "plausible; SemanticKITTI id 259");
        assert_eq!(explained(7), explained(PLAUSIBLE), "an id that SemanticKITTI doesn't have");
        let mut tokens: Vec<&str> = table.iter().map(|category| category.token.as_str()).collect();
        tokens.sort_unstable();
        tokens.dedup();
        assert!(tokens.len() == table.len() && tokens.iter().all(|token| token.len() == 32));
    }
}
