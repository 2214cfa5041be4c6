//! A scan as named, typed columns: what tables and clouds have in common.

use super::labelled::{LabelledScan, LabelledSequence};
use crate::error::DataError;
use crate::result::ANSWERS;
use ralf::label::truth_of;
use ralf::sensors::{Radar, RadarScan};

/// Names of what a labelled cloud has beside the radar's own fields. The one of 2 bytes is last, so that all lie aligned.
const ADDED: [&str; 7] = ["plausibility", "label", "w_lm", "w_cm", "w_tr", "w_opt", "flags"];

/// One column, a value per detection of the split.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) values: Values,
}

/// The values of a column.
pub(super) enum Values {
    /// NaN is absent.
    F32(Vec<f32>),
    U16(Vec<u16>),
    U32(Vec<u32>),
    I64(Vec<i64>),
    /// Of a detection that is unlabeled `None`.
    Truth(Vec<Option<bool>>),
}

impl Values {
    /// How many.
    pub(super) fn len(&self) -> usize {
        match self {
            Self::F32(values) => values.len(),
            Self::U16(values) => values.len(),
            Self::U32(values) => values.len(),
            Self::I64(values) => values.len(),
            Self::Truth(values) => values.len(),
        }
    }

    /// Bytes of a value.
    pub(super) fn size(&self) -> usize {
        match self {
            Self::Truth(_) => 1,
            Self::U16(_) => 2,
            Self::F32(_) | Self::U32(_) => 4,
            Self::I64(_) => 8,
        }
    }

    /// Adds the little-endian bytes of a value: of what is true 1, of what is false 0, of what nobody knows -1.
    pub(super) fn append_bytes(&self, row: usize, bytes: &mut Vec<u8>) {
        match self {
            Self::F32(values) => bytes.extend(values[row].to_le_bytes()),
            Self::U16(values) => bytes.extend(values[row].to_le_bytes()),
            Self::U32(values) => bytes.extend(values[row].to_le_bytes()),
            Self::I64(values) => bytes.extend(values[row].to_le_bytes()),
            Self::Truth(values) => bytes.extend(values[row].map_or(-1, i8::from).to_le_bytes()),
        }
    }

    /// Adds values of the same type; others are none of this column.
    pub(super) fn append(&mut self, others: Self) {
        match (self, others) {
            (Self::F32(values), Self::F32(others)) => values.extend(others),
            (Self::U16(values), Self::U16(others)) => values.extend(others),
            (Self::U32(values), Self::U32(others)) => values.extend(others),
            (Self::I64(values), Self::I64(others)) => values.extend(others),
            (Self::Truth(values), Self::Truth(others)) => values.extend(others),
            _ => {}
        }
    }
}

/// The columns of `plausibility.parquet` but `radar`, with the effective labels; of what was measured only if asked for.
pub(super) fn table_columns(sequence: &LabelledSequence, scan: &LabelledScan) -> Vec<Column> {
    let whole = |value: usize| value as u32;
    let mut columns = vec![
        column("scan", Values::U32(vec![whole(scan.scan); scan.kept.len()])),
        column("point", Values::U32(scan.kept.iter().copied().map(whole).collect())),
        column("t_ns", Values::I64(vec![scan.table.t_ns; scan.kept.len()])),
    ];
    for (name, values) in sequence.columns().names().zip(&scan.table.decimals) {
        if sequence.options.sensors.radar || ANSWERS.contains(&name) {
            columns.push(column(name, Values::F32(kept(scan, values))));
        }
    }
    let ids: Vec<u16> = scan.kept.iter().map(|row| scan.labels[*row].id).collect();
    columns.push(column("plausible", Values::Truth(ids.iter().copied().map(truth_of).collect())));
    columns.push(column("label", Values::U16(ids)));
    columns.push(column("flags", Values::U16(kept(scan, &scan.table.flags))));
    columns
}

/// The columns of a labelled cloud: where the radar saw the detections (its own frame, m), its further fields as they are,
/// and what was found about them.
pub(super) fn cloud_columns(
    sequence: &LabelledSequence,
    scan: &LabelledScan,
    measured: &RadarScan,
) -> Result<Vec<Column>, DataError> {
    let radar = &sequence.reader.sequence().rig.radars[scan.radar];
    if let Some(name) = radar.fields.iter().find(|name| ADDED.contains(&name.as_str())) {
        let reason = format!("field `{name}` of the radar has the name of one that the export adds");
        let (file, place) = (sequence.name().into(), radar.name.clone());
        return Err(DataError::Unsuitable { file, place, reason });
    }
    let mut columns = place(radar, measured);
    let fields = radar.fields.iter().zip(&measured.columns);
    let further = fields.filter(|(name, _)| !["x", "y", "z"].contains(&name.as_str()));
    columns.extend(further.map(|(name, values)| (name.clone(), values.clone())));
    let mut columns: Vec<Column> = columns
        .into_iter()
        .map(|(name, values)| Column { name, values: Values::F32(kept(scan, &values)) })
        .collect();
    columns.extend(ADDED.map(|name| column(name, added(sequence, scan, name))));
    Ok(columns)
}

/// x, y, z as they were recorded, or worked out from range, azimuth and elevation.
fn place(radar: &Radar, measured: &RadarScan) -> Vec<(String, Vec<f32>)> {
    let axis = |(axis, name): (usize, &str)| {
        let recorded = radar.column(name).map(|column| measured.columns[column].clone());
        let worked_out = || measured.positions.iter().map(|position| position[axis] as f32).collect();
        (name.to_owned(), recorded.unwrap_or_else(worked_out))
    };
    ["x", "y", "z"].into_iter().enumerate().map(axis).collect()
}

fn added(sequence: &LabelledSequence, scan: &LabelledScan, name: &str) -> Values {
    match name {
        "label" => Values::U32(scan.kept.iter().map(|row| scan.labels[*row].id.into()).collect()),
        "flags" => Values::U16(kept(scan, &scan.table.flags)),
        _ => {
            let name = if name == "plausibility" { "w" } else { name };
            let found = sequence.columns().names().position(|known| known == name);
            let values = found.and_then(|at| scan.table.decimals.get(at)).map(|values| kept(scan, values));
            Values::F32(values.unwrap_or_default())
        }
    }
}

fn column(name: &str, values: Values) -> Column {
    Column { name: name.to_owned(), values }
}

fn kept<T: Copy>(scan: &LabelledScan, values: &[T]) -> Vec<T> {
    scan.kept.iter().map(|row| values[*row]).collect()
}
