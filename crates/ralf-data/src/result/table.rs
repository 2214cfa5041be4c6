//! The result of one scan as a table.

use super::Columns;
use crate::disk::label_file::Label;
use ralf::label::{ARTIFACT, PLAUSIBLE, truth_of};
use ralf::paper::DetectionLabel;
use ralf::scene::LocatedScan;
use ralf::sensors::{Elevation, Radar};

/// One row per detection of one scan.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ScanTable {
    /// Time of the scan, ns.
    pub t_ns: i64,
    /// The decimal columns in the order of [`Columns::names`]; not finite is absent.
    pub decimals: Vec<Vec<f32>>,
    /// 1 plausible, 0 artifact.
    pub label: Vec<u8>,
    /// Bits of [`ralf::label::flag`].
    pub flags: Vec<u16>,
    /// SemanticKITTI ids, where known.
    pub semantic: Vec<Option<u16>>,
}

impl ScanTable {
    /// The table of a labelled scan.
    pub fn new(columns: &Columns, radar: &Radar, scan: &LocatedScan, labels: &[DetectionLabel]) -> Self {
        let mut decimals = measured_columns(columns, radar, scan);
        let answers: [fn(&DetectionLabel) -> Option<f64>; 8] = [
            |label| label.d_lm,
            |label| label.d_cm,
            |label| label.d_tr,
            |label| label.w_lm,
            |label| label.w_cm,
            |label| label.w_tr,
            |label| label.w_opt,
            |label| Some(label.w),
        ];
        decimals.extend(
            answers.map(|of| labels.iter().map(|label| of(label).map_or(f32::NAN, |v| v as f32)).collect()),
        );
        Self {
            t_ns: scan.t_ns(),
            decimals,
            label: labels.iter().map(|label| u8::from(label.plausible)).collect(),
            flags: labels.iter().map(|label| label.flags).collect(),
            semantic: labels.iter().map(|label| label.semantic).collect(),
        }
    }

    /// The table of a scan that was not labelled: all answers are absent.
    pub(crate) fn not_labelled(columns: &Columns, radar: &Radar, scan: &LocatedScan) -> Self {
        let rows = scan.len();
        let mut decimals = measured_columns(columns, radar, scan);
        decimals.resize(columns.count(), vec![f32::NAN; rows]);
        let (label, flags, semantic) = (vec![0; rows], vec![0; rows], vec![None; rows]);
        Self { t_ns: scan.t_ns(), decimals, label, flags, semantic }
    }

    /// How many detections.
    pub fn len(&self) -> usize {
        self.label.len()
    }

    /// Whether the radar saw nothing.
    pub fn is_empty(&self) -> bool {
        self.label.is_empty()
    }

    /// The values of the `.label` file: 1 for an artifact; for a plausible detection its class where it has a plausible one,
    /// else 99.
    pub fn labels(&self) -> Vec<Label> {
        let class = |(label, semantic): (&u8, &Option<u16>)| match (label, semantic) {
            (0, _) => ARTIFACT,
            (_, Some(class)) if truth_of(*class) == Some(true) => *class,
            _ => PLAUSIBLE,
        };
        self.label.iter().zip(&self.semantic).map(class).map(Label::of_class).collect()
    }
}

/// Place and further radar fields.
fn measured_columns(columns: &Columns, radar: &Radar, scan: &LocatedScan) -> Vec<Vec<f32>> {
    let mut decimals = place_columns(radar, scan);
    for name in columns.further() {
        let column = radar.column(name).map(|column| scan.measured.columns[column].clone());
        decimals.push(column.unwrap_or_else(|| vec![f32::NAN; scan.len()]));
    }
    decimals
}

/// x, y, z (vehicle frame), range, azimuth, elevation (as measured). All absent for a detection without a place.
fn place_columns(radar: &Radar, scan: &LocatedScan) -> Vec<Vec<f32>> {
    let mut columns = vec![Vec::new(); 6];
    for (located, spherical) in scan.detections.iter().zip(&scan.measured.spherical) {
        let row = match located {
            None => [f32::NAN; 6],
            Some(located) => {
                let elevation = match radar.elevation {
                    Elevation::Measured => spherical.elevation,
                    Elevation::None => f64::NAN,
                };
                let p = located.position;
                [p.x, p.y, p.z, spherical.range, spherical.azimuth, elevation].map(|value| value as f32)
            }
        };
        columns.iter_mut().zip(row).for_each(|(column, value)| column.push(value));
    }
    columns
}
