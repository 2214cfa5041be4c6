//! Reading `plausibility.parquet` back, scan by scan.

use super::rows_read::column;
use super::{Columns, ScanTable};
use crate::disk::files;
use crate::error::DataError;
use parquet::data_type::{ByteArrayType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

/// Tables by radar and scan.
pub type ScanTables = BTreeMap<(String, usize), ScanTable>;

/// The labelled detections of a sequence, read a row group at a time.
pub struct PlausibilityReader {
    file: PathBuf,
    columns: Columns,
    reader: SerializedFileReader<File>,
    places: BTreeMap<(String, usize), Place>,
}

/// Where a scan's rows lie.
#[derive(Debug, Clone, Copy)]
struct Place {
    group: usize,
    first: usize,
    rows: usize,
}

impl PlausibilityReader {
    /// Opens a result and finds out which scans it holds. `columns` are those of the sequence's rig.
    ///
    /// # Errors
    /// A file that is no result of `ralf label`, or whose scans are torn apart.
    pub fn open(file: &Path, columns: Columns) -> Result<Self, DataError> {
        let open = files::open(file)?;
        let unreadable = |error| unreadable(file, error);
        let reader = SerializedFileReader::new(open).map_err(unreadable)?;
        let mut places = BTreeMap::new();
        for number in 0..reader.num_row_groups() {
            let group = reader.get_row_group(number).map_err(unreadable)?;
            for (scan, first, rows) in scans(group.as_ref()).map_err(unreadable)? {
                let place = format!("radar {}, scan {}", scan.0, scan.1);
                if places.insert(scan, Place { group: number, first, rows }).is_some() {
                    let expected = "its rows one after the other";
                    return Err(DataError::content(file, place, expected, "others between them"));
                }
            }
        }
        Ok(Self { file: file.to_owned(), columns, reader, places })
    }

    /// Where it lies.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The decimal columns.
    pub fn columns(&self) -> &Columns {
        &self.columns
    }

    /// How many row groups there are.
    pub fn groups(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// The row group that holds a scan; `None` of a scan without rows.
    pub fn group_of(&self, radar: &str, scan: usize) -> Option<usize> {
        self.places.get(&(radar.to_owned(), scan)).map(|place| place.group)
    }

    /// How many detections of a scan there are.
    pub fn detections(&self, radar: &str, scan: usize) -> usize {
        self.places.get(&(radar.to_owned(), scan)).map_or(0, |place| place.rows)
    }

    /// The tables of all scans in a row group.
    ///
    /// # Errors
    /// A file that can't be read, lacks a column, or has its detections in another order.
    pub fn tables(&self, group: usize) -> Result<ScanTables, DataError> {
        let rows = self
            .reader
            .get_row_group(group)
            .and_then(|rows| Rows::read(rows.as_ref(), &self.columns))
            .map_err(|error| unreadable(&self.file, error))?;
        let here = self.places.iter().filter(|(_, place)| place.group == group);
        here.map(|(scan, place)| {
            let in_order = rows.point[place.first..][..place.rows].iter().copied().eq(0..place.rows as i32);
            if in_order {
                return Ok((scan.clone(), rows.table(*place)));
            }
            let column = format!("radar {}, scan {}, column `point`", scan.0, scan.1);
            Err(DataError::content(&self.file, column, "0, 1, 2 and so on", "another order"))
        })
        .collect()
    }
}

impl std::fmt::Debug for PlausibilityReader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("PlausibilityReader").field("file", &self.file).finish_non_exhaustive()
    }
}

fn unreadable(file: &Path, error: ParquetError) -> DataError {
    DataError::content(file, "Parquet", "a result of `ralf label`", error.to_string())
}

/// A scan's radar and number, its first row in the group, and how many rows it has.
type Found = ((String, usize), usize, usize);

/// The scans of a row group in the order of its rows.
fn scans(group: &dyn RowGroupReader) -> Result<Vec<Found>, ParquetError> {
    let radars = column::<ByteArrayType>(group, "radar")?.into_iter().flatten();
    let numbers = column::<Int32Type>(group, "scan")?.into_iter().flatten();
    let mut scans: Vec<Found> = Vec::new();
    for (row, (radar, number)) in radars.zip(numbers).enumerate() {
        let (radar, number) = (radar.as_utf8()?, number.cast_unsigned() as usize);
        match scans.last_mut() {
            Some((scan, _, rows)) if scan.0 == radar && scan.1 == number => *rows += 1,
            _ => scans.push(((radar.to_owned(), number), row, 1)),
        }
    }
    Ok(scans)
}

/// The columns of a row group but for those that name the scan.
struct Rows {
    point: Vec<i32>,
    t_ns: Vec<i64>,
    decimals: Vec<Vec<f32>>,
    label: Vec<u8>,
    flags: Vec<u16>,
    semantic: Vec<Option<u16>>,
}

impl Rows {
    fn read(group: &dyn RowGroupReader, columns: &Columns) -> Result<Self, ParquetError> {
        let integers = |name| Ok::<_, ParquetError>(column::<Int32Type>(group, name)?.into_iter().flatten());
        let decimals = |name: &str| {
            let values = column::<FloatType>(group, name)?.into_iter();
            Ok::<_, ParquetError>(values.map(|value| value.unwrap_or(f32::NAN)).collect())
        };
        let classes = column::<Int32Type>(group, "semantic")?.into_iter();
        Ok(Self {
            point: integers("point")?.collect(),
            t_ns: column::<Int64Type>(group, "t_ns")?.into_iter().flatten().collect(),
            decimals: columns.names().map(decimals).collect::<Result<_, _>>()?,
            label: integers("label")?.map(|label| label as u8).collect(),
            flags: integers("flags")?.map(|flags| flags as u16).collect(),
            semantic: classes.map(|class| class.map(|class| class as u16)).collect(),
        })
    }

    fn table(&self, place: Place) -> ScanTable {
        let rows = place.first..place.first + place.rows;
        ScanTable {
            t_ns: self.t_ns[place.first],
            decimals: self.decimals.iter().map(|column| column[rows.clone()].to_vec()).collect(),
            label: self.label[rows.clone()].to_vec(),
            flags: self.flags[rows.clone()].to_vec(),
            semantic: self.semantic[rows].to_vec(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::PlausibilityWriter;
    use super::*;
    use ralf::sensors::Rig;

    fn table(columns: &Columns, rows: usize, seed: f32) -> ScanTable {
        let value = |column: usize, row: usize| {
            if (column + row).is_multiple_of(3) { f32::NAN } else { seed + (column * 100 + row) as f32 }
        };
        ScanTable {
            t_ns: seed as i64,
            decimals: (0..columns.count()).map(|c| (0..rows).map(|r| value(c, r)).collect()).collect(),
            label: (0..rows).map(|row| (row % 2) as u8).collect(),
            flags: (0..rows).map(|row| row as u16).collect(),
            semantic: (0..rows).map(|row| (row % 2 == 1).then_some(252)).collect(),
        }
    }

    #[test]
    fn every_scan_comes_back_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plausibility.parquet");
        let columns = Columns::of(&Rig::default()).unwrap();
        let mut writer = PlausibilityWriter::create(&file, &columns).unwrap();
        // The first scan fills a row group by itself.
        let sizes = [("a", 0, 140_000), ("a", 1, 3), ("a", 2, 0), ("b", 0, 2)];
        for (radar, scan, rows) in sizes {
            writer.append(radar, scan, &table(&columns, rows, scan as f32)).unwrap();
        }
        writer.finish().unwrap();
        let reader = PlausibilityReader::open(&file, columns.clone()).unwrap();
        assert_eq!((reader.groups(), reader.group_of("a", 2), reader.group_of("b", 0)), (2, None, Some(1)));
        for (radar, scan, rows) in sizes {
            assert_eq!(reader.detections(radar, scan), rows);
            let Some(group) = reader.group_of(radar, scan) else { continue };
            let tables = reader.tables(group).unwrap();
            let [found, written] = [&tables[&(radar.to_owned(), scan)], &table(&columns, rows, scan as f32)]
                .map(|t| format!("{t:?}"));
            assert_eq!(found, written);
        }
    }

    #[test]
    fn another_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plausibility.parquet");
        std::fs::write(&file, "no table").unwrap();
        let error = PlausibilityReader::open(&file, Columns::of(&Rig::default()).unwrap()).unwrap_err();
        assert!(error.to_string().contains("expected a result of `ralf label`"), "{error}");
    }
}
