//! Reading back from `plausibility.parquet` what pictures and reports need.

use crate::disk::files;
use crate::error::DataError;
use parquet::column::reader::get_typed_column_reader;
use parquet::data_type::{ByteArrayType, DataType, FloatType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use std::path::Path;

/// The rows of one sequence, by column.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LabelledRows {
    /// Names of the radars.
    pub radars: Vec<String>,
    /// Index into `radars`.
    pub radar: Vec<usize>,
    /// Number of the scan.
    pub scan: Vec<usize>,
    /// Vehicle frame at the scan's time, m; NaN where absent.
    pub x: Vec<f32>,
    /// Vehicle frame at the scan's time, m; NaN where absent.
    pub y: Vec<f32>,
    /// As measured, m; NaN where absent.
    pub range: Vec<f32>,
    /// As measured, rad; NaN where absent.
    pub azimuth: Vec<f32>,
    /// Plausibility by LiDAR or camera; NaN where absent.
    pub w_opt: Vec<f32>,
    /// Plausibility by tracking; NaN where absent.
    pub w_tr: Vec<f32>,
    /// Vehicle frame at the scan's time, m; NaN where absent.
    pub z: Vec<f32>,
    /// Plausibility.
    pub w: Vec<f32>,
    /// 1 plausible, 0 artifact.
    pub label: Vec<u8>,
    /// Bits of [`ralf::label::flag`].
    pub flags: Vec<u16>,
}

/// Reads the rows of a `plausibility.parquet`.
pub fn read_labelled_rows(file: &Path) -> Result<LabelledRows, DataError> {
    let open = files::open(file)?;
    let unreadable = |error: ParquetError| {
        DataError::content(file, "Parquet", "a result of `ralf label`", error.to_string())
    };
    let reader = SerializedFileReader::new(open).map_err(unreadable)?;
    let mut rows = LabelledRows::default();
    for group in 0..reader.num_row_groups() {
        let group = reader.get_row_group(group).map_err(unreadable)?;
        append_group(&mut rows, group.as_ref()).map_err(unreadable)?;
    }
    Ok(rows)
}

fn append_group(rows: &mut LabelledRows, group: &dyn RowGroupReader) -> Result<(), ParquetError> {
    for name in column::<ByteArrayType>(group, "radar")?.into_iter().flatten() {
        let name = name.as_utf8()?;
        let known = rows.radars.iter().rposition(|radar| radar == name);
        rows.radar.push(known.unwrap_or(rows.radars.len()));
        if known.is_none() {
            rows.radars.push(name.to_owned());
        }
    }
    let integers = |name| Ok::<_, ParquetError>(column::<Int32Type>(group, name)?.into_iter().flatten());
    let decimals = |name| {
        let values = column::<FloatType>(group, name)?.into_iter();
        Ok::<_, ParquetError>(values.map(|value| value.unwrap_or(f32::NAN)))
    };
    rows.scan.extend(integers("scan")?.map(|scan| scan.cast_unsigned() as usize));
    rows.x.extend(decimals("x")?);
    rows.y.extend(decimals("y")?);
    rows.range.extend(decimals("range")?);
    rows.azimuth.extend(decimals("azimuth")?);
    rows.w_opt.extend(decimals("w_opt")?);
    rows.w_tr.extend(decimals("w_tr")?);
    rows.z.extend(decimals("z")?);
    rows.w.extend(decimals("w")?);
    rows.label.extend(integers("label")?.map(|label| label as u8));
    rows.flags.extend(integers("flags")?.map(|flags| flags as u16));
    Ok(())
}

/// A column of a row group by name, `None` where a value is absent.
pub(super) fn column<T: DataType>(
    group: &dyn RowGroupReader,
    name: &str,
) -> Result<Vec<Option<T::T>>, ParquetError> {
    let schema = group.metadata().schema_descr();
    let at = schema.columns().iter().position(|column| column.name() == name);
    let at = at.ok_or_else(|| ParquetError::General(format!("no column `{name}`")))?;
    if schema.column(at).physical_type() != T::get_physical_type() {
        return Err(ParquetError::General(format!("column `{name}` has another type")));
    }
    let optional = schema.column(at).max_def_level() > 0;
    let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    let mut reader = get_typed_column_reader::<T>(group.get_column_reader(at)?);
    let (mut values, mut levels) = (Vec::new(), Vec::new());
    let (mut read, mut wanted) = (0, rows);
    while wanted > 0 {
        let (records, _, _) =
            reader.read_records(wanted, optional.then_some(&mut levels), None, &mut values)?;
        if records == 0 {
            return Err(ParquetError::General(format!("column `{name}` ends after {read} of {rows} rows")));
        }
        (read, wanted) = (read + records, wanted - records);
    }
    let mut values = values.into_iter();
    Ok(match optional {
        true => levels.into_iter().map(|level| if level > 0 { values.next() } else { None }).collect(),
        false => values.map(Some).collect(),
    })
}
