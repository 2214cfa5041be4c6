//! SemanticKITTI's tree: `sequences/NN/labels/000000.label`, and with the radars' data `velodyne/000000.bin`,
//! `calib.txt`, `poses.txt` and `times.txt`, as semantic-kitti-api reads them.
//!
//! A sequence of this tree is one radar of one sequence of the recording: frame n is scan n, point i its detection i,
//! and nothing is moved in time. A sequence that has a number and one radar keeps it; other radars get the numbers that
//! are free. `sequences.csv` tells which is which.

use super::labelled::{LabelledScan, LabelledSequence};
use super::{Split, Writer, npy_array};
use crate::disk::files;
use crate::disk::label_file::write_labels;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::{Component, OutFolder, Values, checked};
use crate::run::SequenceRecord;
use ralf::sensors::{Radar, RadarScan};
use ralf::space::Transform;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Writes the tree.
pub(super) struct SemanticKitti {
    /// Names of the recording's sequences that are numbers and have one radar, so that they can keep them.
    kept: BTreeSet<String>,
    /// Below this all numbers have been given, or are kept.
    next: usize,
    /// Rows of `sequences.csv`.
    table: Vec<String>,
}

impl SemanticKitti {
    pub(super) fn new(sequences: &[(&dyn SequenceReader, &SequenceRecord)]) -> Self {
        let numbered = |name: &str| name.len() == 2 && name.bytes().all(|byte| byte.is_ascii_digit());
        let records = sequences.iter().map(|(_, record)| record);
        let kept = records.filter(|record| record.radars.len() == 1 && numbered(&record.name));
        Self { kept: kept.map(|record| record.name.clone()).collect(), next: 0, table: Vec::new() }
    }

    /// The number of a radar of this sequence: the sequence's own, or else the first that is free.
    fn number(&mut self, sequence: &str) -> String {
        if self.kept.contains(sequence) {
            return sequence.to_owned();
        }
        loop {
            let number = format!("{:02}", self.next);
            self.next += 1;
            if !self.kept.contains(&number) {
                return number;
            }
        }
    }
}

impl Writer for SemanticKitti {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let all = sequence.reader.sequence();
        for (radar, Radar { name, .. }) in all.rig.radars.iter().enumerate() {
            let number = self.number(sequence.name());
            let folder = folder.own("sequences").folder(&checked("sequence", &number)?);
            self.table.push(format!(
                "{number},{},{},{}\n",
                csv(sequence.name()),
                csv(name),
                sequence.scans(radar)
            ));
            if sequence.sensors.radar {
                write_tables(&folder, sequence, radar)?;
            }
            for scan in 0..sequence.scans(radar) {
                let labelled = sequence.scan(radar, scan)?;
                write_scan(&folder, sequence, &labelled)?;
            }
        }
        Ok(())
    }

    fn finish(&mut self, folder: &OutFolder) -> Result<(), DataError> {
        let text = "number,sequence,radar,scans\n".to_owned() + &self.table.concat();
        files::write_whole(&folder.own_file("sequences.csv"), text.as_bytes())
    }
}

/// A cell of a table, quoted where it has to be.
fn csv(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

fn write_scan(folder: &OutFolder, sequence: &LabelledSequence, scan: &LabelledScan) -> Result<(), DataError> {
    let file = |kind: &'static str, ending: &'static str| {
        folder.own(kind).file(&Component::numbered(scan.scan, ending))
    };
    if !sequence.sensors.radar {
        return write_labels(&file("labels", "label"), &scan.labels_in_place());
    }
    let measured = sequence.measured_of(scan)?;
    let radar = &sequence.reader.sequence().rig.radars[scan.radar];
    let rows = scan.kept.iter().flat_map(|row| point(radar, &measured, *row));
    files::write_whole(&file("velodyne", "bin"), &files::f32_bytes(rows))?;
    let labels: Vec<_> = scan.kept.iter().map(|row| scan.labels[*row]).collect();
    write_labels(&file("labels", "label"), &labels)?;
    if sequence.split != Split::All {
        let points = Values::U32(scan.kept.iter().map(|row| *row as u32).collect());
        files::write_whole(&file("points", "npy"), &npy_array::of_column(&points))?;
    }
    Ok(())
}

/// x, y, z (radar frame, m) and intensity. A detection without a place is put at the origin, which stands for no
/// return.
fn point(radar: &Radar, measured: &RadarScan, row: usize) -> [f32; 4] {
    let position = measured.positions[row].coords.map(|value| value as f32);
    let place = if position.iter().all(|value| value.is_finite()) { position } else { Default::default() };
    let intensity = radar.amplitude().map_or(0.0, |field| measured.columns[field.column][row]);
    [place.x, place.y, place.z, if intensity.is_finite() { intensity } else { 0.0 }]
}

/// `calib.txt`, `poses.txt` and `times.txt`. In place of SemanticKITTI's camera stands the vehicle: `Tr` is
/// vehicle_from_radar, and a pose is that of the vehicle in its frame at the first scan.
fn write_tables(folder: &OutFolder, sequence: &LabelledSequence, radar: usize) -> Result<(), DataError> {
    let all = sequence.reader.sequence();
    let calib = format!("Tr:{}\n", matrix(&all.rig.radars[radar].vehicle_from_radar));
    files::write_whole(&folder.own_file("calib.txt"), calib.as_bytes())?;
    let (mut poses, mut seconds) = (String::new(), String::new());
    let times = &all.times.radars[radar];
    let first_ns = times.first().copied().unwrap_or_default();
    let first_from_odom = all.motion.odom_from_vehicle(first_ns).inverse();
    for t_ns in times {
        let pose = matrix(&(first_from_odom * all.motion.odom_from_vehicle(*t_ns)));
        // Writing to a string can't fail.
        let _ = writeln!(poses, "{}", pose.trim_start());
        let _ = writeln!(seconds, "{:.9}", (t_ns - first_ns) as f64 * 1e-9);
    }
    files::write_whole(&folder.own_file("poses.txt"), poses.as_bytes())?;
    files::write_whole(&folder.own_file("times.txt"), seconds.as_bytes())
}

/// The upper three rows of a transform, each number after a space.
fn matrix(transform: &Transform) -> String {
    let matrix = transform.to_homogeneous();
    let rows = matrix.fixed_rows::<3>(0).transpose();
    rows.iter().map(|value| format!(" {value:.9e}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_can_keep_a_number_keeps_it_and_others_get_the_free_ones() {
        let kept = BTreeSet::from(["01".to_owned()]);
        let mut writer = SemanticKitti { kept, next: 0, table: Vec::new() };
        let numbers = ["00", "00", "01", "02", "02"].map(|sequence| writer.number(sequence));
        assert_eq!(numbers, ["00", "02", "01", "03", "04"]);
    }

    #[test]
    fn cells_are_quoted_where_they_have_to_be() {
        for (text, expected) in [("00", "00"), ("a b", "a b"), ("a,b", "\"a,b\""), ("a\"b", "\"a\"\"b\"")] {
            assert_eq!(csv(text), expected);
        }
    }

    #[test]
    fn matrices_are_rows_of_three_by_four() {
        let turn = nalgebra::UnitQuaternion::from_euler_angles(0.0, 0.0, std::f64::consts::PI);
        let transform = Transform::from_parts(nalgebra::Translation3::new(1.5, -2.0, 0.25), turn);
        let values: Vec<f64> =
            matrix(&transform).split(' ').skip(1).map(|text| text.parse().unwrap()).collect();
        let expected = [-1.0, 0.0, 0.0, 1.5, 0.0, -1.0, 0.0, -2.0, 0.0, 0.0, 1.0, 0.25];
        assert_eq!(values.len(), expected.len());
        assert!(values.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{values:?}");
    }
}
