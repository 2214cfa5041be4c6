//! A table for tests.

use super::net::NetParameters;
use super::table::{Known, TrainingTable};
use super::view::View;
use ralf::evidence::features;
use ralf::learned::Rows;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// So many scans of so many detections in three worlds: what is plausible follows from the first feature. The paper's
/// method is taken to know nothing.
pub(super) fn table(scans: u32, detections: usize) -> TrainingTable {
    let mut random = Pcg64Mcg::seed_from_u64(9);
    let mut table = TrainingTable::new(features().collect());
    for scan in 0..scans {
        let world = table.world(["town", "motorway", "yard"][scan as usize % 3]);
        let mut rows = Rows::absent(detections, table.features.len());
        let mut known = Vec::new();
        for row in 0..detections {
            for value in rows.row_mut(row) {
                *value = random.random_range(-1.0..1.0);
            }
            let plausible = random.random_bool(if rows.row(row)[0] < -0.2 { 0.95 } else { 0.05 });
            let cause = if plausible { 0 } else { 1 + (row % 2) as u8 };
            known.push(Known {
                world,
                scan,
                t_ns: i64::from(scan) * 100_000_000,
                view: View::Whole,
                said: true,
                plausible,
                shown: None,
                cause,
                paper: random.random(),
                paper_label: random.random(),
                place: [row as f32, (row * row % 7) as f32, 0.0],
            });
        }
        table.append(&rows, known);
    }
    table
}

/// A net that is fitted in a moment.
pub(super) fn small() -> NetParameters {
    NetParameters { width: 8, layers: 1, nearest: 2, passes: 5.0, rate: 1e-2 }
}
