//! A scan as named, typed columns: what tables and clouds have in common.

use super::labelled::{LabelledScan, LabelledSequence};
use super::options::Sensors;
use crate::error::DataError;
use crate::result::schema::field;
use crate::result::{CLASS_FROM, Column, Group, Kind, Schema, Table, Values};
use ralf::label::truth_of;
use ralf::sensors::{Radar, RadarScan};
use std::sync::Arc;

/// Columns in the making.
#[derive(Default)]
struct Columns {
    columns: Vec<Column>,
    values: Vec<Values>,
}

impl Columns {
    fn add(&mut self, column: Column, values: Values) {
        self.columns.push(column);
        self.values.push(values);
    }

    fn table(self) -> Result<Table, DataError> {
        Table::new(Arc::new(Schema::new(self.columns)), self.values)
    }
}

/// The columns of `plausibility.parquet` but `radar` and `semantic`, with the effective labels; of what was measured
/// only if asked for. Words are the machine's, as plausibilities are.
pub(super) fn table_columns(sequence: &LabelledSequence, scan: &LabelledScan) -> Result<Table, DataError> {
    let sensors = sequence.sensors;
    let found = columns_of(scan, sensors)?;
    // `sequence` is how readers of a tree of tables call the part of its path.
    let is_twice = |name: &str| found.columns.iter().filter(|column| column.name == name).count() > 1;
    refuse_fields(sequence, scan, |name| sensors.radar && (name == "sequence" || is_twice(name)))?;
    found.table()
}

/// The columns that [`table_columns`] has of a sequence whose results have these.
pub(super) fn table_schema(results: Arc<Schema>, sensors: Sensors) -> Result<Schema, DataError> {
    let table = Table::empty(results);
    let nothing = LabelledScan { radar: 0, scan: 0, table, labels: Vec::new(), kept: Vec::new() };
    Ok(Schema::new(columns_of(&nothing, sensors)?.columns))
}

fn columns_of(scan: &LabelledScan, sensors: Sensors) -> Result<Columns, DataError> {
    let mut columns = Columns::default();
    let number = vec![scan.scan as u32; scan.kept.len()];
    columns.add(plain("scan", Kind::U32, "The number of the scan.", Group::Identity), Values::U32(number));
    for group in [Group::Identity, Group::Measured, Group::Answers] {
        if group != Group::Measured || sensors.radar {
            add_group(&mut columns, scan, group);
        }
    }
    let ids: Vec<u16> = scan.kept.iter().map(|row| scan.labels[*row].id).collect();
    let truth = Values::Truth(ids.iter().copied().map(truth_of).collect());
    columns.add(plain("plausible", Kind::Truth, "What the label says.", Group::Verdict), truth);
    let meaning = "SemanticKITTI id of the label that counts.";
    columns.add(plain("label", Kind::U16, meaning, Group::Verdict), Values::U16(ids));
    columns.add(flags(), flags_of(scan)?);
    add_where(&mut columns, scan, |column| column.name == CLASS_FROM.name);
    add_group(&mut columns, scan, Group::Evidence);
    add_group(&mut columns, scan, Group::Words);
    Ok(columns)
}

/// A field of the recording that is called like what the export adds could not be told from it.
fn refuse_fields(
    sequence: &LabelledSequence,
    scan: &LabelledScan,
    is_taken: impl Fn(&str) -> bool,
) -> Result<(), DataError> {
    let radar = &sequence.reader.sequence().rig.radars[scan.radar];
    let Some(name) = radar.fields.iter().find(|name| is_taken(name)) else { return Ok(()) };
    let reason = format!("expected fields of other names than those that the export adds, found `{name}`");
    Err(DataError::Unsuitable { file: sequence.name().into(), place: radar.name.clone(), reason })
}

/// Answers of the method that a labelled cloud has, and what they are called there.
const ANSWERS: [(&str, &str); 4] = [("w_lm", "w_lm"), ("w_cm", "w_cm"), ("w_tr", "w_tr"), ("w_opt", "w_opt")];

/// What viewers draw labels in, as `0xRRGGBBAA`: the review page's blue and orange, which are told apart with any
/// colour vision, and its grey.
pub(super) const PLAUSIBLE: u32 = 0x4b_a8_ea_ff;
pub(super) const ARTIFACT: u32 = 0xf0_80_3c_ff;
const UNLABELLED: u32 = 0x8b_96_a5_ff;

/// The columns of a labelled cloud: where the radar saw the detections (its own frame, m), its further fields as they
/// are, and what was found about them; with `drawn`, also the colours by which Rerun shows the labels.
pub(super) fn cloud_columns(
    sequence: &LabelledSequence,
    scan: &LabelledScan,
    measured: &RadarScan,
    drawn: bool,
) -> Result<Table, DataError> {
    let radar = &sequence.reader.sequence().rig.radars[scan.radar];
    let added = found_columns(scan, drawn)?;
    refuse_fields(sequence, scan, |name| added.columns.iter().any(|column| column.name == name))?;
    let mut columns = Columns::default();
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        columns.add(field(name), Values::F32(kept(scan, &place(radar, measured, axis, name))));
    }
    for (name, values) in radar.fields.iter().zip(&measured.columns) {
        if !["x", "y", "z"].contains(&name.as_str()) {
            columns.add(field(name), Values::F32(kept(scan, values)));
        }
    }
    columns.columns.extend(added.columns);
    columns.values.extend(added.values);
    columns.table()
}

/// What was found about a scan's detections. The column of 2 bytes is last, so that all lie aligned.
fn found_columns(scan: &LabelledScan, drawn: bool) -> Result<Columns, DataError> {
    let mut found = Columns::default();
    let decimals = |name: &str| Ok::<_, DataError>(Values::F32(kept(scan, scan.table.get::<f32>(name)?)));
    found.add(plain("plausibility", Kind::F32, "The plausibility.", Group::Answers), decimals("w")?);
    let ids: Vec<u16> = scan.kept.iter().map(|row| scan.labels[*row].id).collect();
    let colours = ids.iter().copied().map(colour).collect();
    let meaning = "SemanticKITTI id of the label that counts.";
    let label = Values::U32(ids.into_iter().map(u32::from).collect());
    found.add(plain("label", Kind::U32, meaning, Group::Verdict), label);
    for (name, of) in ANSWERS {
        found.add(plain(name, Kind::F32, "A branch's plausibility.", Group::Answers), decimals(of)?);
    }
    add_group(&mut found, scan, Group::Evidence);
    if drawn {
        // Under this name Rerun takes them for the points' own.
        found.add(plain("colors", Kind::U32, "The label's colour.", Group::Verdict), Values::U32(colours));
    }
    found.add(flags(), flags_of(scan)?);
    Ok(found)
}

fn colour(label: u16) -> u32 {
    match truth_of(label) {
        Some(true) => PLAUSIBLE,
        Some(false) => ARTIFACT,
        None => UNLABELLED,
    }
}

/// A table of decimals under these names.
pub(super) fn decimals<'a>(columns: impl Iterator<Item = (&'a str, Vec<f32>)>) -> Result<Table, DataError> {
    let mut all = Columns::default();
    columns.for_each(|(name, values)| all.add(field(name), Values::F32(values)));
    all.table()
}

/// Adds the columns of the result that belong to a group.
fn add_group(columns: &mut Columns, scan: &LabelledScan, group: Group) {
    add_where(columns, scan, |column| column.group == group);
}

/// Adds the columns of the result that are asked for.
fn add_where(columns: &mut Columns, scan: &LabelledScan, is_asked: impl Fn(&Column) -> bool) {
    for (column, values) in scan.table.columns().filter(|(column, _)| is_asked(column)) {
        columns.add(column.clone(), values.pick(&scan.kept));
    }
}

/// x, y or z as it was recorded, or worked out from range, azimuth and elevation.
fn place(radar: &Radar, measured: &RadarScan, axis: usize, name: &str) -> Vec<f32> {
    let recorded = radar.column(name).map(|column| measured.columns[column].clone());
    let worked_out = || measured.positions.iter().map(|position| position[axis] as f32).collect();
    recorded.unwrap_or_else(worked_out)
}

fn flags() -> Column {
    plain("flags", Kind::U16, "The bits of `ralf::label::flag`.", Group::Verdict)
}

fn flags_of(scan: &LabelledScan) -> Result<Values, DataError> {
    Ok(Values::U16(kept(scan, scan.table.get::<u16>("flags")?)))
}

fn plain(name: &'static str, kind: Kind, meaning: &'static str, group: Group) -> Column {
    Column { name: name.into(), kind, unit: "", meaning, group }
}

fn kept<T: Copy>(scan: &LabelledScan, values: &[T]) -> Vec<T> {
    scan.kept.iter().map(|row| values[*row]).collect()
}
