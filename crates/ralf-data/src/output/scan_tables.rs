//! Reading `plausibility.parquet` back scan by scan, in any order and in bounded memory.

use super::rows_read::column;
use super::{Columns, ScanTable};
use crate::DataError;
use parquet::data_type::{ByteArray, ByteArrayType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use std::collections::BTreeMap;
use std::fs::File;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The tables of one sequence. One row group per radar is held in memory, so that going through each radar's scans in
/// order, all radars side by side, reads every group once per radar in it.
pub(crate) struct ScanTables {
    file: PathBuf,
    reader: SerializedFileReader<File>,
    columns: Columns,
    /// First row of each row group, and the number of all rows.
    group_begins: Vec<usize>,
    /// Per radar the first row of each scan, and the row behind its last one.
    scan_begins: BTreeMap<String, Vec<usize>>,
    /// Per radar the row group that was read last, and its number.
    held: BTreeMap<String, (usize, Group)>,
}

/// The rows of one row group.
struct Group {
    radar: Vec<ByteArray>,
    scan: Vec<i32>,
    point: Vec<i32>,
    t_ns: Vec<i64>,
    decimals: Vec<Vec<f32>>,
    label: Vec<u8>,
    flags: Vec<u16>,
    semantic: Vec<Option<u16>>,
}

impl ScanTables {
    /// Opens a file with these columns. `detections` tells how many rows each scan of each radar has, in the file's order.
    pub(crate) fn open<'a>(
        file: &Path,
        columns: Columns,
        detections: impl IntoIterator<Item = (&'a str, &'a [u32])>,
    ) -> Result<Self, DataError> {
        let open = File::open(file).map_err(DataError::io(file))?;
        let reader = SerializedFileReader::new(open).map_err(unreadable(file))?;
        let groups = reader.metadata().row_groups();
        let group_begins =
            begins(0, groups.iter().map(|group| usize::try_from(group.num_rows()).unwrap_or(0)));
        let (mut rows, mut scan_begins) = (0, BTreeMap::new());
        for (radar, counts) in detections {
            let of_radar = begins(rows, counts.iter().map(|count| *count as usize));
            rows = of_radar.last().copied().unwrap_or(rows);
            scan_begins.insert(radar.to_owned(), of_radar);
        }
        let found = group_begins.last().copied().unwrap_or(0);
        if found != rows {
            let expected = format!("{rows} detections, as run.json says");
            return Err(DataError::content(file, "rows", expected, found.to_string()));
        }
        let (file, held) = (file.to_owned(), BTreeMap::new());
        Ok(Self { file, reader, columns, group_begins, scan_begins, held })
    }

    /// The table of a scan; `None` where the file has no rows of it.
    pub(crate) fn table(&mut self, radar: &str, scan: usize) -> Result<Option<ScanTable>, DataError> {
        let begins = self.scan_begins.get(radar).map_or(&[][..], Vec::as_slice);
        let (Some(&begin), Some(&end)) = (begins.get(scan), begins.get(scan + 1)) else { return Ok(None) };
        if begin == end {
            return Ok(None);
        }
        let number = self.group_begins.partition_point(|first| *first <= begin) - 1;
        let first = self.group_begins[number];
        let rows = begin - first..end - first;
        if self.held.get(radar).is_none_or(|(held, _)| *held != number) {
            let group = self.reader.get_row_group(number).map_err(unreadable(&self.file))?;
            let group = Group::read(group.as_ref(), &self.columns).map_err(unreadable(&self.file))?;
            self.held.insert(radar.to_owned(), (number, group));
        }
        let group =
            self.held.get(radar).map(|(_, group)| group).filter(|group| group.holds(radar, scan, &rows));
        let group = group.ok_or_else(|| {
            let expected = format!("scan {scan} of {radar}, as run.json says");
            DataError::content(&self.file, format!("rows {begin} to {}", end - 1), expected, "other rows")
        })?;
        Ok(Some(group.table(rows)))
    }
}

/// Where each of some parts begins that follow one another, and where the last one ends.
fn begins(first: usize, sizes: impl Iterator<Item = usize>) -> Vec<usize> {
    let ends = sizes.scan(first, |end, size| {
        *end += size;
        Some(*end)
    });
    std::iter::once(first).chain(ends).collect()
}

fn unreadable(file: &Path) -> impl Fn(ParquetError) -> DataError {
    |error| DataError::content(file, "Parquet", "a result of `ralf label`", error.to_string())
}

impl Group {
    fn read(group: &dyn RowGroupReader, columns: &Columns) -> Result<Self, ParquetError> {
        let integers = |name| Ok::<_, ParquetError>(column::<Int32Type>(group, name)?.into_iter());
        let decimals = |name| {
            let values = column::<FloatType>(group, name)?.into_iter();
            Ok::<_, ParquetError>(values.map(|value| value.unwrap_or(f32::NAN)).collect())
        };
        let group = Self {
            radar: column::<ByteArrayType>(group, "radar")?.into_iter().flatten().collect(),
            scan: integers("scan")?.flatten().collect(),
            point: integers("point")?.flatten().collect(),
            t_ns: column::<Int64Type>(group, "t_ns")?.into_iter().flatten().collect(),
            decimals: columns.names().map(decimals).collect::<Result<_, _>>()?,
            label: integers("label")?.flatten().map(|label| label as u8).collect(),
            flags: integers("flags")?.flatten().map(|flags| flags as u16).collect(),
            semantic: integers("semantic")?.map(|class| class.map(|class| class as u16)).collect(),
        };
        let rows = group.scan.len();
        let others =
            [group.radar.len(), group.point.len(), group.t_ns.len(), group.label.len(), group.flags.len()];
        match others.iter().all(|found| *found == rows) {
            true => Ok(group),
            false => Err(ParquetError::General("null in a column that is never null".into())),
        }
    }

    /// Whether these rows are all of one scan, in order.
    fn holds(&self, radar: &str, scan: usize, rows: &Range<usize>) -> bool {
        let of_scan = |(point, row): (usize, usize)| {
            self.radar[row].data() == radar.as_bytes()
                && (self.scan[row].cast_unsigned() as usize, self.point[row].cast_unsigned() as usize)
                    == (scan, point)
        };
        rows.end <= self.scan.len() && rows.clone().enumerate().all(of_scan)
    }

    fn table(&self, rows: Range<usize>) -> ScanTable {
        ScanTable {
            t_ns: self.t_ns[rows.start],
            decimals: self.decimals.iter().map(|column| column[rows.clone()].to_vec()).collect(),
            label: self.label[rows.clone()].to_vec(),
            flags: self.flags[rows.clone()].to_vec(),
            semantic: self.semantic[rows].to_vec(),
        }
    }
}
