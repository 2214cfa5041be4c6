//! The columns of a result: each is listed once, here, with its type, unit and meaning. Files, exports, the page and
//! the report go through this list.

use crate::error::DataError;
use ralf::evidence::{Feature, features};
use ralf::paper::DetectionLabel;
use ralf::sensors::Rig;
use std::borrow::Cow;
use std::sync::Arc;

/// What the values of a column are.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Text.
    Text,
    /// 8 bits, never absent.
    U8,
    /// 16 bits, never absent.
    U16,
    /// 32 bits, never absent.
    U32,
    /// 64 bits with a sign, never absent.
    I64,
    /// A decimal, or absent.
    F32,
    /// A SemanticKITTI id, or absent.
    Class,
    /// True, false, or unknown.
    Truth,
}

/// What a column tells of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Group {
    /// Which detection it is.
    Identity,
    /// What the radar measured.
    Measured,
    /// What the paper's branches answer.
    Answers,
    /// What comes of it.
    Verdict,
    /// What else is known of it.
    Evidence,
    /// What is said of it, for people.
    Words,
}

/// A column: how it is called, and what it means.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Column {
    /// Its name in every file.
    pub name: Cow<'static, str>,
    /// What its values are.
    pub kind: Kind,
    /// `m`, `rad`, `ns`; empty where there is none, or none is known.
    pub unit: &'static str,
    /// A sentence for people.
    pub meaning: &'static str,
    /// What it tells of.
    pub group: Group,
}

/// Columns in their order; no two have one name.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Schema {
    columns: Vec<Column>,
}

const fn column(
    name: &'static str,
    kind: Kind,
    unit: &'static str,
    meaning: &'static str,
    group: Group,
) -> Column {
    Column { name: Cow::Borrowed(name), kind, unit, meaning, group }
}

/// Which scan a row of a file belongs to. The table of one scan doesn't have these.
pub(crate) static SCAN: [Column; 2] = [
    column("radar", Kind::Text, "", "The radar's name.", Group::Identity),
    column("scan", Kind::U32, "", "The number of the scan.", Group::Identity),
];

const IDENTITY: [Column; 2] = [
    column("point", Kind::U32, "", "The detection's place in its scan.", Group::Identity),
    column("t_ns", Kind::I64, "ns", "The time of the scan.", Group::Identity),
];

/// Where a detection is. A radar's fields of these names are what these columns are made from.
const PLACE: [Column; 6] = [
    column("x", Kind::F32, "m", "Forward, in the vehicle frame at the scan's time.", Group::Measured),
    column("y", Kind::F32, "m", "To the left, in the vehicle frame at the scan's time.", Group::Measured),
    column("z", Kind::F32, "m", "Up, in the vehicle frame at the scan's time.", Group::Measured),
    column("range", Kind::F32, "m", "Distance from the radar, as measured.", Group::Measured),
    column(
        "azimuth",
        Kind::F32,
        "rad",
        "To the left of the radar's boresight, as measured.",
        Group::Measured,
    ),
    column("elevation", Kind::F32, "rad", "Above the radar's horizon, as measured.", Group::Measured),
];

/// An answer of the paper's method, and where it stands in a label.
struct Answer {
    column: Column,
    of: fn(&DetectionLabel) -> Option<f64>,
}

const fn answer(name: &'static str, meaning: &'static str, of: fn(&DetectionLabel) -> Option<f64>) -> Answer {
    Answer { column: column(name, Kind::F32, "1", meaning, Group::Answers), of }
}

const ANSWERS: [Answer; 8] = [
    answer("d_lm", "Mean mismatch with the nearest LiDAR points.", |label| label.d_lm),
    answer("d_cm", "Mean mismatch with the nearest points of the scaled depth images.", |label| label.d_cm),
    answer("d_tr", "Weighted mismatch with the neighbouring radar scans.", |label| label.d_tr),
    answer("w_lm", "Plausibility by LiDAR matching.", |label| label.w_lm),
    answer("w_cm", "Plausibility by camera matching.", |label| label.w_cm),
    answer("w_tr", "Plausibility by tracking.", |label| label.w_tr),
    answer("w_opt", "Plausibility by LiDAR or camera, whichever has the say.", |label| label.w_opt),
    answer("w", "The plausibility.", |label| Some(label.w)),
];

const VERDICT: [Column; 3] = [
    column("label", Kind::U8, "", "1 plausible, 0 artifact.", Group::Verdict),
    column(
        "flags",
        Kind::U16,
        "",
        "What was special about the detection: the bits of `ralf::label::flag`.",
        Group::Verdict,
    ),
    column("semantic", Kind::Class, "", "SemanticKITTI id, where one is known.", Group::Verdict),
];

/// Where a class is from: a column of recordings whose images have a segmentation.
pub(crate) const CLASS_FROM: Column = column(
    "class_from",
    Kind::Text,
    "",
    "What tells the class: `lidar` or `camera`; empty where there is none.",
    Group::Verdict,
);

impl Schema {
    /// These columns.
    pub(crate) fn new(columns: Vec<Column>) -> Self {
        Self { columns }
    }

    /// The columns of a scan's table for a rig: identity, place, the radars' further fields in the order in which they
    /// first appear, answers, verdict, and evidence.
    ///
    /// # Errors
    /// A further field that has the name of another column.
    pub fn of(rig: &Rig, evidence: &[Column]) -> Result<Self, String> {
        let own = || columns_of_the_method().chain(evidence.iter().cloned());
        let mut further: Vec<Column> = Vec::new();
        for radar in &rig.radars {
            for (_, name) in radar.further_fields() {
                let taken = SCAN.iter().chain(&IDENTITY).any(|column| column.name == name);
                if taken || own().any(|column| column.name == name) {
                    return Err(format!(
                        "field `{name}` of {} has the name of a column of the result",
                        radar.name
                    ));
                }
                if further.iter().all(|known| known.name != name) {
                    further.push(field(name));
                }
            }
        }
        Ok(Self::around(further, evidence))
    }

    /// The columns of a scan's table around the further fields of radars.
    pub(crate) fn around(further: Vec<Column>, evidence: &[Column]) -> Self {
        let before = IDENTITY.into_iter().chain(PLACE);
        let after = columns_of_the_method().chain(evidence.iter().cloned());
        Self { columns: before.chain(further).chain(after).collect() }
    }

    /// These columns after those that say which scan a row belongs to: those of a table of several scans.
    pub fn with_scan(&self) -> Self {
        Self { columns: SCAN.iter().chain(&self.columns).cloned().collect() }
    }

    /// The columns, in order.
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The place of a column.
    ///
    /// # Errors
    /// No column of this name.
    pub fn place(&self, name: &str) -> Result<usize, DataError> {
        let found = self.columns.iter().position(|column| column.name == name);
        found.ok_or_else(|| {
            let names: Vec<&str> = self.columns.iter().map(|column| column.name.as_ref()).collect();
            DataError::NoColumn { name: name.to_owned(), known: names.join(", ") }
        })
    }

    /// Some of the columns.
    ///
    /// # Errors
    /// No column of one of these names.
    pub fn only(&self, names: &[&str]) -> Result<Arc<Self>, DataError> {
        let columns = names.iter().map(|name| Ok(self.columns[self.place(name)?].clone()));
        Ok(Arc::new(Self { columns: columns.collect::<Result<_, DataError>>()? }))
    }
}

/// A field of a radar beside its place, of which no more is known than its name.
pub(crate) fn field(name: &str) -> Column {
    let meaning = "As the radar gave it.";
    Column { name: name.to_owned().into(), kind: Kind::F32, unit: "", meaning, group: Group::Measured }
}

/// The columns of all evidence that is known.
pub(crate) fn evidence_columns() -> Vec<Column> {
    let of = |feature: &'static Feature| {
        let Feature { name, unit, meaning, .. } = *feature;
        Column { name: name.into(), kind: Kind::F32, unit, meaning, group: Group::Evidence }
    };
    features().map(of).collect()
}

/// What an answer is of a label; `None` of a column that is no answer.
pub(crate) fn answer_of(name: &str) -> Option<fn(&DetectionLabel) -> Option<f64>> {
    ANSWERS.iter().find(|answer| answer.column.name == name).map(|answer| answer.of)
}

/// Answers and verdict.
fn columns_of_the_method() -> impl Iterator<Item = Column> {
    ANSWERS.into_iter().map(|answer| answer.column).chain(VERDICT)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_column_is_told_once_and_with_a_sentence() {
        let schema = Schema::of(&Rig::default(), &[]).unwrap();
        for (at, column) in schema.columns().iter().enumerate() {
            assert_eq!(schema.place(&column.name).unwrap(), at);
            assert!(column.meaning.ends_with('.'), "{column:?}");
        }
        assert_eq!(schema.columns().len(), 2 + 6 + 8 + 3);
    }

    #[test]
    fn a_column_that_is_not_there_is_an_error_that_names_those_that_are() {
        let schema = Schema::of(&Rig::default(), &[]).unwrap();
        let error = schema.place("w_lidar").unwrap_err().to_string();
        assert!(error.contains("no column `w_lidar`") && error.contains("w_lm, w_cm"), "{error}");
        assert!(schema.only(&["w", "doppler"]).is_err());
    }
}
