//! A Parquet data set, partitioned by sequence as Hive does it: `sequence=NAME/RADAR.parquet`, a row per detection. All
//! files have the same columns.

use super::common_columns::CommonColumns;
use super::labelled::LabelledSequence;
use super::{Contents, Writer};
use crate::error::DataError;
use crate::result::schema::SCAN;
use crate::result::{Column, Component, GROUP_ROWS, Layout, OutFolder, Table, Values, checked, written};
use parquet::file::writer::SerializedFileWriter;
use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

/// The column that tables of a single radar don't have.
static RADAR: &Column = &SCAN[0];

/// Writes the data set.
pub(super) struct Parquet {
    columns: CommonColumns,
}

impl Parquet {
    /// A data set of these contents.
    pub(super) fn new(contents: &Contents) -> Result<Self, DataError> {
        Ok(Self { columns: CommonColumns::new(contents)? })
    }
}

impl Writer for Parquet {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let partition = format!("sequence={}", partition(sequence.name()));
        let folder = folder.folder(&checked("sequence, as a partition's name", &partition)?);
        fs::create_dir_all(folder.path()).map_err(DataError::io(folder.path()))?;
        let files = file_names(&sequence.names.radars);
        for (radar, sensor) in sequence.reader.sequence().rig.radars.iter().enumerate() {
            let file = folder.file(&files[radar].and(".parquet"));
            let radar_name = sensor.name.as_str().into();
            let mut rows = RadarFile { file: &file, radar: radar_name, rows: None, writer: None };
            for scan in 0..sequence.scans(radar) {
                let labelled = sequence.scan(radar, scan)?;
                rows.append(self.columns.table(sequence, &labelled)?)?;
            }
            rows.finish()?;
        }
        Ok(())
    }
}

/// A value in a folder's name: what is neither a letter, a digit nor one of `-_.` stands as `%` and two hex digits.
fn partition(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    name.bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

/// How the files of radars are called, without their ending. Who reads a data set passes over files with an underscore
/// or a dot in front: before such a name stands `radar`, as often as it takes to be unlike all others.
fn file_names(radars: &[Component]) -> Vec<Component> {
    let mut names = radars.to_vec();
    for place in 0..names.len() {
        let is_hidden = names[place].as_str().starts_with(['_', '.']);
        while is_hidden && (names[place] == radars[place] || radars.contains(&names[place])) {
            names[place] = names[place].after("radar");
        }
    }
    names
}

/// The file of one radar; one that never scanned has none.
struct RadarFile<'a> {
    file: &'a Path,
    radar: Arc<str>,
    /// Rows that are still to be written.
    rows: Option<Table>,
    writer: Option<(SerializedFileWriter<File>, Layout)>,
}

impl RadarFile<'_> {
    fn append(&mut self, table: Table) -> Result<(), DataError> {
        match &mut self.rows {
            Some(rows) => rows.append(&table)?,
            none => *none = Some(table),
        }
        let rows = self.rows.as_ref().map_or(0, Table::len);
        if rows >= GROUP_ROWS { self.flush() } else { Ok(()) }
    }

    /// Writes a row group. The first one, even without rows, begins the file.
    fn flush(&mut self) -> Result<(), DataError> {
        let Some(rows) = self.rows.take() else { return Ok(()) };
        let refused = |error| written(self.file, error);
        let (writer, layout) = match &mut self.writer {
            Some(begun) => begun,
            none => {
                let open = File::create(self.file).map_err(DataError::io(self.file))?;
                let columns = std::iter::once(RADAR).chain(rows.schema().columns());
                let layout = Layout::new("labels", columns).map_err(refused)?;
                none.insert((layout.begin(open).map_err(refused)?, layout))
            }
        };
        let radar = Values::Text(vec![self.radar.clone(); rows.len()]);
        let group = layout.encode(std::iter::once(&radar).chain(rows.columns().map(|(_, values)| values)));
        group.and_then(|group| group.append_to(writer)).map_err(refused)
    }

    fn finish(mut self) -> Result<(), DataError> {
        self.flush()?;
        let finished = self.writer.map(|(mut writer, _)| writer.finish().map(drop)).transpose();
        finished.map(drop).map_err(|error| written(self.file, error))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_file_is_passed_over_and_no_two_have_one_name() {
        let named = |names: &[&str]| {
            let radars: Vec<_> = names.iter().map(|name| Component::new(name).unwrap()).collect();
            file_names(&radars).iter().map(|name| name.as_str().to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(named(&["front", "_r"]), ["front", "radar_r"]);
        assert_eq!(named(&["radar_r", "_r", "__r"]), ["radar_r", "radarradar_r", "radar__r"]);
    }

    #[test]
    fn names_are_escaped_as_in_addresses() {
        for (name, expected) in
            [("00", "00"), ("scene-0061_a.b", "scene-0061_a.b"), ("a b=c%", "a%20b%3Dc%25"), ("é", "%C3%A9")]
        {
            assert_eq!(partition(name), expected);
        }
    }
}
