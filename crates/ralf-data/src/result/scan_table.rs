//! The table of one scan: what was measured, what was found, and the labels that come of it.

use super::class_source::ClassSource;
use super::learned_columns::{numbers, words};
use super::schema::{Column, Group, Kind, Schema, answer_of};
use super::table::{Table, Values};
use crate::disk::label_file::Label;
use crate::error::DataError;
use ralf::evidence;
use ralf::label::{ARTIFACT, PLAUSIBLE, truth_of};
use ralf::learned::Answer;
use ralf::paper::DetectionLabel;
use ralf::scene::{Detection, LocatedScan};
use ralf::sensors::{Elevation, Radar};
use ralf::space::Spherical;
use std::sync::Arc;

/// A scan of a radar, within its sequence.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct RadarScanKey {
    /// The radar's name.
    pub radar: Arc<str>,
    /// The number of the scan.
    pub scan: usize,
}

impl RadarScanKey {
    /// The scan of this number.
    pub fn new(radar: &str, scan: usize) -> Self {
        Self { radar: radar.into(), scan }
    }
}

/// What a scan's table is made of.
pub(crate) struct ScanParts<'a> {
    pub(crate) radar: &'a Radar,
    pub(crate) scan: &'a LocatedScan,
    /// One per detection; none at all where the scan could not be labelled: all answers are absent then.
    pub(crate) labels: Option<&'a [DetectionLabel]>,
    /// The columns of evidence; those that nobody gathered are absent.
    pub(crate) evidence: &'a [evidence::Column],
    /// What a model says, one per detection; none where no model was asked.
    pub(crate) answers: &'a [Answer],
    /// The class of what cameras see at each detection; none at all where no image has a segmentation.
    pub(crate) seen: &'a [Option<u16>],
}

impl Table {
    /// One table of several scans, in their order, with the columns `radar` and `scan` before the others.
    ///
    /// # Errors
    /// Scans with other columns than the first one's.
    pub fn of_scans(scans: &[(RadarScanKey, Self)]) -> Result<Self, DataError> {
        let Some((_, first)) = scans.first() else { return Ok(Self::empty(Arc::default())) };
        let mut all = Self::empty(first.schema().clone());
        let (mut radars, mut numbers) = (Vec::new(), Vec::new());
        for (key, table) in scans {
            all.append(table)?;
            radars.resize(all.len(), key.radar.clone());
            numbers.resize(all.len(), key.scan as u32);
        }
        let schema = Arc::new(all.schema().with_scan());
        let values = [Values::Text(radars), Values::U32(numbers)].into_iter().chain(all.into_values());
        Self::new(schema, values.collect())
    }

    /// The table of a scan, a row per detection.
    ///
    /// # Errors
    /// A column that nothing is known of.
    pub(crate) fn of_scan(schema: &Arc<Schema>, parts: &ScanParts) -> Result<Self, DataError> {
        let values = schema.columns().iter().map(|column| parts.values(column));
        Self::new(schema.clone(), values.collect::<Result<_, _>>()?)
    }

    /// The values of the `.label` file: 1 for an artifact; for a plausible detection its class where it has a plausible
    /// one, else 99.
    ///
    /// # Errors
    /// A table that isn't of a labelled scan.
    pub fn labels(&self) -> Result<Vec<Label>, DataError> {
        let (plausible, classes) = (self.get::<u8>("label")?, self.get::<Option<u16>>("semantic")?);
        let class = |(label, semantic): (&u8, &Option<u16>)| match (label, semantic) {
            (0, _) => ARTIFACT,
            (_, Some(class)) if truth_of(*class) == Some(true) => *class,
            _ => PLAUSIBLE,
        };
        Ok(plausible.iter().zip(classes).map(class).map(Label::of_class).collect())
    }
}

impl ScanParts<'_> {
    fn values(&self, column: &Column) -> Result<Values, DataError> {
        let rows = self.scan.len();
        Ok(match (column.group, column.kind, column.name.as_ref()) {
            (_, Kind::U32, "point") => Values::U32((0..rows as u32).collect()),
            (_, Kind::I64, "t_ns") => Values::I64(vec![self.scan.t_ns(); rows]),
            (Group::Measured, Kind::F32, name) => Values::F32(self.measured(name)),
            (Group::Answers, Kind::F32, name) => {
                let of = answer_of(name).ok_or_else(|| unknown(column))?;
                Values::F32(
                    self.of_labels(f32::NAN, |label| of(label).map_or(f32::NAN, |value| value as f32)),
                )
            }
            (_, Kind::U8, "label") => Values::U8(self.of_labels(0, |label| u8::from(label.plausible))),
            (_, Kind::U16, "flags") => Values::U16(self.of_labels(0, |label| label.flags)),
            (_, Kind::Class, "semantic") => Values::Class(self.classes().map(|(class, _)| class).collect()),
            (Group::Verdict, Kind::Text, "class_from") => {
                let name = |from: Option<ClassSource>| from.map_or("", ClassSource::name).into();
                Values::Text(self.classes().map(|(_, from)| name(from)).collect())
            }
            (Group::Evidence, Kind::F32, name) => {
                let told = numbers(name, self.answers).filter(|told| told.len() == rows);
                Values::F32(told.unwrap_or_else(|| self.evidence(name, rows)))
            }
            (Group::Words, Kind::Text, name) => {
                let told = words(name, self.answers).filter(|told| told.len() == rows);
                Values::Text(told.unwrap_or_else(|| vec!["".into(); rows]))
            }
            _ => return Err(unknown(column)),
        })
    }

    /// The class of each detection, and what tells it: a LiDAR's labels before a camera's image.
    fn classes(&self) -> impl Iterator<Item = (Option<u16>, Option<ClassSource>)> {
        let by_lidar = self.of_labels(None, |label| label.semantic).into_iter();
        by_lidar.enumerate().map(|(i, by_lidar)| match (by_lidar, self.seen.get(i).copied().flatten()) {
            (Some(class), _) => (Some(class), Some(ClassSource::Lidar)),
            (None, Some(class)) => (Some(class), Some(ClassSource::Camera)),
            (None, None) => (None, None),
        })
    }

    fn of_labels<T: Clone>(&self, absent: T, of: impl Fn(&DetectionLabel) -> T) -> Vec<T> {
        match self.labels {
            Some(labels) => labels.iter().map(of).collect(),
            None => vec![absent; self.scan.len()],
        }
    }

    /// Place in the vehicle frame and as measured, or a field as it is: a further one, or a range or an angle that the
    /// recording tells beside x, y and z. A place is absent of a detection without one, and a further field of a radar
    /// that doesn't have it.
    fn measured(&self, name: &str) -> Vec<f32> {
        if let Some(told) = self.radar.told_beside_place(name) {
            return self.scan.measured.columns[told].clone();
        }
        let of: fn(&Detection, &Spherical) -> f64 = match name {
            "x" => |located, _| located.position.x,
            "y" => |located, _| located.position.y,
            "z" => |located, _| located.position.z,
            "range" => |_, spherical| spherical.range,
            "azimuth" => |_, spherical| spherical.azimuth,
            "elevation" if self.radar.elevation == Elevation::None => |_, _| f64::NAN,
            "elevation" => |_, spherical| spherical.elevation,
            further => {
                let column =
                    self.radar.column(further).map(|column| self.scan.measured.columns[column].clone());
                return column.unwrap_or_else(|| vec![f32::NAN; self.scan.len()]);
            }
        };
        let rows = self.scan.detections.iter().zip(&self.scan.measured.spherical);
        rows.map(|(located, spherical)| {
            located.as_ref().map_or(f32::NAN, |found| of(found, spherical) as f32)
        })
        .collect()
    }

    /// Absent where nobody gathered it.
    fn evidence(&self, name: &str, rows: usize) -> Vec<f32> {
        let found = self.evidence.iter().find(|column| column.feature.name == name);
        let Some(found) = found else { return vec![f32::NAN; rows] };
        found.values.iter().map(|value| value.map_or(f32::NAN, |value| value as f32)).collect()
    }
}

fn unknown(column: &Column) -> DataError {
    let found = "a column that no scan has".to_owned();
    DataError::WrongColumn { name: column.name.to_string(), found }
}
