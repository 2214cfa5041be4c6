//! A radar that delivers detections and no numbers: all of its places, or all values of a field, are NaN. A few such
//! rows are ordinary; where there is nothing else, labels look like any others and are worth nothing.

use super::Table;
use crate::error::DataError;
use ralf::sensors::Radar;
use serde::{Deserialize, Serialize};

/// Fewer detections are too few to tell.
const FEWEST: u64 = 30;
/// The column that has a value wherever a detection has a place.
const PLACE: &str = "x";

/// Which numbers were met among a radar's detections.
#[derive(Debug, Clone, Default)]
pub(crate) struct Numbers {
    detections: u64,
    /// Whether one had a place.
    place: bool,
    /// Of the radar's further fields, in its order: whether one had a value.
    fields: Vec<bool>,
}

/// A radar without numbers.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct WithoutNumbers {
    /// Its name.
    pub radar: String,
    /// How many detections it has.
    pub detections: u64,
    /// Whether none of them has finite coordinates.
    #[serde(default)]
    pub places: bool,
    /// Further fields that are NaN in all of them.
    #[serde(default)]
    pub fields: Vec<String>,
}

impl Numbers {
    /// None as yet.
    pub(crate) fn of(radar: &Radar) -> Self {
        Self { fields: vec![false; radar.further_fields().count()], ..Self::default() }
    }

    /// Adds a scan of the radar.
    ///
    /// # Errors
    /// A table that isn't of a labelled scan of this radar.
    pub(crate) fn add(&mut self, radar: &Radar, table: &Table) -> Result<(), DataError> {
        let met = |column: &str| {
            table.get::<f32>(column).map(|values| values.iter().any(|value| value.is_finite()))
        };
        self.detections += table.len() as u64;
        self.place = self.place || met(PLACE)?;
        for (seen, (_, field)) in self.fields.iter_mut().zip(radar.further_fields()) {
            *seen = *seen || met(field)?;
        }
        Ok(())
    }

    /// Adds what other scans of the radar had.
    pub(crate) fn append(&mut self, more: &Self) {
        self.detections += more.detections;
        self.place |= more.place;
        self.fields.iter_mut().zip(&more.fields).for_each(|(seen, more)| *seen |= more);
    }

    /// Whether a detection has a place.
    pub(crate) fn has_place(&self) -> bool {
        self.place
    }

    /// What is missing in all detections, if something is.
    pub(crate) fn missing(&self, radar: &Radar) -> Option<WithoutNumbers> {
        let fields = self.fields.iter().zip(radar.further_fields());
        let fields: Vec<String> =
            fields.filter(|(seen, _)| !**seen).map(|(_, (_, name))| name.to_owned()).collect();
        let is_missing = self.detections >= FEWEST && !(self.place && fields.is_empty());
        is_missing.then(|| WithoutNumbers {
            radar: radar.name.clone(),
            detections: self.detections,
            places: !self.place,
            fields,
        })
    }
}

impl WithoutNumbers {
    /// For people: ``none of its 1870 detections has a place, for their coordinates are not finite; `rcs` is NaN in all
    /// of them``.
    pub fn words(&self) -> String {
        let Self { detections, fields, .. } = self;
        let place = format!(
            "none of its {detections} detections has a place, for their coordinates are not finite: all are labelled \
             artifacts"
        );
        let names = fields.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let be = if fields.len() == 1 { "is" } else { "are" };
        match (self.places, fields.is_empty()) {
            (true, true) => place,
            (true, false) => format!("{place}; {names} {be} NaN in all of them, too"),
            (false, _) => format!("{names} {be} NaN in all of its {detections} detections"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::{Kind, Schema, Values};
    use crate::testing;
    use ralf::sensors::Rig;
    use std::sync::Arc;

    const NAN: f32 = f32::NAN;

    /// A radar with fields `doppler` and `rcs`.
    fn radar() -> Radar {
        testing::radar(&["x", "y", "z", "doppler", "rcs"])
    }

    /// So many detections, all alike.
    fn scan(rows: usize, place: f32, doppler: f32, rcs: f32) -> Table {
        let rig = Rig { radars: vec![radar()], ..Rig::default() };
        let schema = Arc::new(Schema::of(&rig, &[]).unwrap());
        let mut values: Vec<Values> =
            schema.columns().iter().map(|column| Values::none(column.kind)).collect();
        for (column, values) in schema.columns().iter().zip(&mut values) {
            let number = match column.name.as_ref() {
                "doppler" => doppler,
                "rcs" => rcs,
                _ => place,
            };
            *values = match column.kind {
                Kind::F32 => Values::F32(vec![number; rows]),
                Kind::I64 => Values::I64(vec![0; rows]),
                Kind::U8 => Values::U8(vec![0; rows]),
                Kind::U16 => Values::U16(vec![0; rows]),
                Kind::Class => Values::Class(vec![None; rows]),
                _ => Values::U32(vec![0; rows]),
            };
        }
        Table::new(schema, values).unwrap()
    }

    fn words(scans: &[Table]) -> Option<String> {
        let radar = radar();
        let mut all = Numbers::of(&radar);
        for scan in scans {
            let mut one = Numbers::of(&radar);
            one.add(&radar, scan).unwrap();
            all.append(&one);
        }
        all.missing(&radar).map(|missing| missing.words())
    }

    #[test]
    fn a_radar_without_a_single_place_is_named_and_one_with_some_is_not() {
        let none = words(&[scan(20, NAN, 1.0, 1.0), scan(20, NAN, 1.0, 1.0)]).unwrap();
        assert!(none.starts_with("none of its 40 detections has a place"), "{none}");
        assert_eq!(words(&[scan(20, NAN, NAN, NAN), scan(1, 5.0, 1.0, 1.0), scan(20, NAN, NAN, NAN)]), None);
        assert_eq!(words(&[scan(20, NAN, NAN, NAN)]), None, "too few");
    }

    #[test]
    fn fields_that_are_never_a_number_are_named() {
        let one = words(&[scan(40, 5.0, NAN, 1.0)]).unwrap();
        assert_eq!(one, "`doppler` is NaN in all of its 40 detections");
        let both = words(&[scan(40, 5.0, NAN, NAN)]).unwrap();
        assert_eq!(both, "`doppler`, `rcs` are NaN in all of its 40 detections");
        assert!(words(&[scan(40, NAN, 1.0, NAN)]).unwrap().ends_with("`rcs` is NaN in all of them, too"));
    }
}
