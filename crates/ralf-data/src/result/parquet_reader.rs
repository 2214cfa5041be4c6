//! Reading `plausibility.parquet` back, a row group at a time.

use super::learned_columns::learned_columns;
use super::parquet_columns::read_values;
use super::schema::{CLASS_FROM, Column, Group, Kind, SCAN, Schema, evidence_columns, field};
use super::table::Value;
use super::{RadarScanKey, Table};
use crate::disk::files;
use crate::error::DataError;
use parquet::basic::Type as Physical;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The labelled detections of a sequence, read a row group at a time.
pub struct PlausibilityReader {
    file: PathBuf,
    schema: Arc<Schema>,
    reader: SerializedFileReader<File>,
    /// Scans in the order of their rows.
    scans: Vec<(RadarScanKey, Place)>,
    places: BTreeMap<RadarScanKey, Place>,
}

/// Where a scan's rows lie.
#[derive(Debug, Clone, Copy)]
struct Place {
    group: usize,
    first: usize,
    rows: usize,
}

impl PlausibilityReader {
    /// Opens a result and finds out which scans it holds. `schema` has the columns that are needed; evidence that the
    /// file holds besides is read, too.
    ///
    /// # Errors
    /// A file that is no result of `ralf label`, that lacks a column, or whose scans are torn apart.
    pub fn open(file: &Path, schema: &Schema) -> Result<Self, DataError> {
        let (reader, schema) = begun(file, schema)?;
        let (mut scans, mut places) = (Vec::new(), BTreeMap::new());
        for number in 0..reader.num_row_groups() {
            let group = reader.get_row_group(number).map_err(|error| unreadable(file, error))?;
            for (key, place) in scans_of(number, group.as_ref()).map_err(|error| unreadable(file, error))? {
                if places.insert(key.clone(), place).is_some() {
                    let (place, expected) = (told(&key), "its rows one after the other");
                    return Err(DataError::content(file, place, expected, "others between them"));
                }
                scans.push((key, place));
            }
        }
        Ok(Self { file: file.to_owned(), schema, reader, scans, places })
    }

    /// The columns that [`Self::open`] reads, without a look at any row.
    ///
    /// # Errors
    /// A file that is no result of `ralf label`, or lacks a column.
    pub(crate) fn columns_of(file: &Path, schema: &Schema) -> Result<Arc<Schema>, DataError> {
        begun(file, schema).map(|(_, schema)| schema)
    }

    /// Opens a result with all columns that it holds, whichever fields the radars have.
    ///
    /// # Errors
    /// Those of [`Self::open`].
    pub fn open_all(file: &Path) -> Result<Self, DataError> {
        Self::open(file, &with_fields(file)?)
    }

    /// The columns that [`Self::open_all`] reads, without a look at any row.
    ///
    /// # Errors
    /// A file that is no result of `ralf label`.
    pub(crate) fn all_columns_of(file: &Path) -> Result<Arc<Schema>, DataError> {
        Self::columns_of(file, &with_fields(file)?)
    }

    /// Where it lies.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The columns of its tables.
    pub fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// How many row groups there are.
    pub fn groups(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// The row group that holds a scan; `None` of a scan without rows.
    pub fn group_of(&self, key: &RadarScanKey) -> Option<usize> {
        self.places.get(key).map(|place| place.group)
    }

    /// How many detections of a scan there are.
    pub fn detections(&self, key: &RadarScanKey) -> usize {
        self.places.get(key).map_or(0, |place| place.rows)
    }

    /// All rows of a row group as the file has them: `radar` and `scan`, and then the columns of [`Self::schema`].
    ///
    /// # Errors
    /// A file that can't be read.
    pub fn group(&self, group: usize) -> Result<Table, DataError> {
        let refused = |error| unreadable(&self.file, error);
        let rows = self.reader.get_row_group(group).map_err(refused)?;
        let schema = Arc::new(self.schema.with_scan());
        let values = schema.columns().iter().map(|column| read_values(rows.as_ref(), column));
        let values = values.collect::<Result<_, _>>().map_err(refused)?;
        Table::new(schema, values)
    }

    /// The scans of a row group in the order of its rows, with the number of rows of each.
    pub fn scans_of_group(&self, group: usize) -> impl Iterator<Item = (&RadarScanKey, usize)> {
        let here = self.scans.iter().filter(move |(_, place)| place.group == group);
        here.map(|(key, place)| (key, place.rows))
    }

    /// The tables of all scans in a row group, in the order of its rows, with all columns.
    ///
    /// # Errors
    /// A file that can't be read, or has its detections in another order.
    pub fn tables(&self, group: usize) -> Result<Vec<(RadarScanKey, Table)>, DataError> {
        self.tables_with(group, &self.schema)
    }

    /// The tables of all scans in a row group, in the order of its rows, with some columns alone ([`Schema::only`] of
    /// [`Self::schema`]).
    ///
    /// # Errors
    /// A file that can't be read, or has its detections in another order.
    pub fn tables_with(
        &self,
        group: usize,
        schema: &Arc<Schema>,
    ) -> Result<Vec<(RadarScanKey, Table)>, DataError> {
        let refused = |error| unreadable(&self.file, error);
        let rows = self.reader.get_row_group(group).map_err(refused)?;
        let values = schema.columns().iter().map(|column| read_values(rows.as_ref(), column));
        let all = Table::new(schema.clone(), values.collect::<Result<_, _>>().map_err(refused)?)?;
        let points = read_values(rows.as_ref(), &self.schema.columns()[self.schema.place("point")?])
            .map_err(refused)?;
        let points = u32::of(&points).unwrap_or_default();
        let here = self.scans.iter().filter(|(_, place)| place.group == group);
        here.map(|(key, place)| {
            let rows = place.first..place.first + place.rows;
            if points[rows.clone()].iter().copied().eq(0..place.rows as u32) {
                return Ok((key.clone(), all.slice(rows)));
            }
            let column = format!("{}, column `point`", told(key));
            Err(DataError::content(&self.file, column, "0, 1, 2 and so on", "another order"))
        })
        .collect()
    }

    /// The table of one scan with some columns; `None` of a scan without rows.
    ///
    /// # Errors
    /// A file that can't be read, or has its detections in another order.
    pub fn table_of(&self, key: &RadarScanKey, schema: &Arc<Schema>) -> Result<Option<Table>, DataError> {
        let Some(group) = self.group_of(key) else { return Ok(None) };
        let found = self.tables_with(group, schema)?.into_iter().find(|(found, _)| found == key);
        Ok(found.map(|(_, table)| table))
    }

    /// Goes through all scans with these columns, one row group in memory at a time.
    ///
    /// # Errors
    /// A column that isn't there, a file that can't be read, and those of `see`.
    pub fn each<E: From<DataError>>(
        &self,
        columns: &[&str],
        mut see: impl FnMut(&RadarScanKey, &Table) -> Result<(), E>,
    ) -> Result<(), E> {
        let schema = self.schema.only(columns)?;
        for group in 0..self.groups() {
            for (key, table) in self.tables_with(group, &schema)? {
                see(&key, &table)?;
            }
        }
        Ok(())
    }
}

impl std::fmt::Debug for PlausibilityReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PlausibilityReader").field("file", &self.file).finish_non_exhaustive()
    }
}

fn told(key: &RadarScanKey) -> String {
    format!("radar {}, scan {}", key.radar, key.scan)
}

fn unreadable(file: &Path, error: ParquetError) -> DataError {
    DataError::content(file, "Parquet", "a result of `ralf label`", error.to_string())
}

/// The columns of every result, with those that a file has between them: fields of its radars.
fn with_fields(file: &Path) -> Result<Schema, DataError> {
    let reader = SerializedFileReader::new(files::open(file)?).map_err(|error| unreadable(file, error))?;
    let columns = reader.metadata().file_metadata().schema_descr().columns();
    let place = |name: &str| columns.iter().position(|column| column.name() == name);
    let further = match (place("elevation"), place("d_lm")) {
        (Some(before), Some(after)) => columns.get(before + 1..after).unwrap_or_default(),
        _ => &[],
    };
    Ok(Schema::around(further.iter().map(|column| field(column.name())).collect(), &[]))
}

/// Opens a file, and finds out what is read of it: the columns that are needed, and evidence.
fn begun(file: &Path, needed: &Schema) -> Result<(SerializedFileReader<File>, Arc<Schema>), DataError> {
    let refused = |error| unreadable(file, error);
    let reader = SerializedFileReader::new(files::open(file)?).map_err(refused)?;
    let schema = with_evidence(&reader, needed).map_err(refused)?;
    Ok((reader, Arc::new(schema)))
}

/// The columns that are needed, and after them what the file has behind the last of them: evidence, and what a model
/// says.
fn with_evidence(reader: &SerializedFileReader<File>, needed: &Schema) -> Result<Schema, ParquetError> {
    let found = reader.metadata().file_metadata().schema_descr();
    let at = |name: &str| found.columns().iter().position(|column| column.name() == name);
    let mut columns = needed.columns().to_vec();
    for column in &columns {
        at(&column.name).ok_or_else(|| ParquetError::General(format!("no column `{}`", column.name)))?;
    }
    let further: Vec<Column> =
        evidence_columns().into_iter().chain(learned_columns()).chain([CLASS_FROM]).collect();
    let last = at("semantic").map_or(found.num_columns(), |semantic| semantic + 1);
    for column in &found.columns()[last..] {
        if columns.iter().any(|known| known.name == column.name()) {
            continue;
        }
        let known = further.iter().find(|known| known.name == column.name()).cloned();
        match (known, column.physical_type()) {
            (Some(known), Physical::FLOAT) if known.kind == Kind::F32 => columns.push(known),
            (Some(known), Physical::BYTE_ARRAY) if known.kind == Kind::Text => columns.push(known),
            (None, Physical::FLOAT) => columns.push(unknown_evidence(column.name())),
            _ => {}
        }
    }
    Ok(Schema::new(columns))
}

fn unknown_evidence(name: &str) -> Column {
    let meaning = "Evidence that this version doesn't know.";
    Column { name: name.to_owned().into(), kind: Kind::F32, unit: "", meaning, group: Group::Evidence }
}

/// The scans of a row group in the order of its rows.
fn scans_of(number: usize, group: &dyn RowGroupReader) -> Result<Vec<(RadarScanKey, Place)>, ParquetError> {
    let [radars, scans] = [read_values(group, &SCAN[0])?, read_values(group, &SCAN[1])?];
    let radars = Arc::<str>::of(&radars).unwrap_or_default();
    let numbers = u32::of(&scans).unwrap_or_default();
    let mut found: Vec<(RadarScanKey, Place)> = Vec::new();
    for (row, (radar, scan)) in radars.iter().zip(numbers).enumerate() {
        let scan = *scan as usize;
        match found.last_mut() {
            Some((key, place)) if key.radar == *radar && key.scan == scan => place.rows += 1,
            _ => {
                let key = RadarScanKey { radar: radar.clone(), scan };
                found.push((key, Place { group: number, first: row, rows: 1 }));
            }
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::super::{PlausibilityWriter, Values};
    use super::*;
    use ralf::sensors::Rig;

    fn table(schema: &Arc<Schema>, rows: usize, seed: f32) -> Table {
        let value = |column: usize, row: usize| {
            if (column + row).is_multiple_of(3) { f32::NAN } else { seed + (column * 100 + row) as f32 }
        };
        let values = schema.columns().iter().enumerate().map(|(at, column)| match column.kind {
            Kind::U32 => Values::U32((0..rows as u32).collect()),
            Kind::I64 => Values::I64(vec![seed as i64; rows]),
            Kind::U8 => Values::U8((0..rows).map(|row| (row % 2) as u8).collect()),
            Kind::U16 => Values::U16((0..rows).map(|row| row as u16).collect()),
            Kind::Class => Values::Class((0..rows).map(|row| (row % 2 == 1).then_some(252)).collect()),
            _ => Values::F32((0..rows).map(|row| value(at, row)).collect()),
        });
        Table::new(schema.clone(), values.collect()).unwrap()
    }

    /// Evidence that the reader was not told of is read, too.
    #[test]
    fn every_scan_comes_back_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plausibility.parquet");
        let plain = Schema::of(&Rig::default(), &[]).unwrap();
        let meaning = "Evidence that this version doesn't know.";
        let piece =
            Column { name: "tilt".into(), kind: Kind::F32, unit: "", meaning, group: Group::Evidence };
        let schema = Arc::new(Schema::of(&Rig::default(), &[piece]).unwrap());
        let mut writer = PlausibilityWriter::create(&file, &schema).unwrap();
        // The first scan fills a row group by itself.
        let sizes = [("b", 0, 140_000), ("b", 1, 3), ("b", 2, 0), ("a", 0, 2)];
        for (radar, scan, rows) in sizes {
            writer.append(&RadarScanKey::new(radar, scan), &table(&schema, rows, scan as f32)).unwrap();
        }
        let written = writer.finish().unwrap();
        assert_eq!(written, crate::result::hash_file(&file, &|_| {}).unwrap());
        let reader = PlausibilityReader::open(&file, &plain).unwrap();
        let group = |radar, scan| reader.group_of(&RadarScanKey::new(radar, scan));
        assert_eq!((reader.groups(), group("b", 2), group("a", 0)), (2, None, Some(1)));
        let mut seen = Vec::new();
        for number in 0..reader.groups() {
            seen.extend(reader.tables(number).unwrap());
        }
        for (key, found) in &seen {
            assert_eq!(reader.detections(key), found.len());
            assert_eq!(format!("{found:?}"), format!("{:?}", table(&schema, found.len(), key.scan as f32)));
        }
        let names: Vec<_> =
            seen.iter().map(|(key, table)| (key.radar.to_string(), key.scan, table.len())).collect();
        assert_eq!(names, [("b".into(), 0, 140_000), ("b".into(), 1, 3), ("a".into(), 0, 2)]);
    }

    #[test]
    fn another_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plausibility.parquet");
        std::fs::write(&file, "no table").unwrap();
        let error = PlausibilityReader::open(&file, &Schema::of(&Rig::default(), &[]).unwrap()).unwrap_err();
        assert!(error.to_string().contains("expected a result of `ralf label`"), "{error}");
    }
}
