//! Groups of evidence taken away from some scans, so that a model stays of use where a sensor or circumstance lacks.

use super::random::{drawn, uniform};
use super::table::TrainingTable;
use ralf::evidence::GROUPS;
use ralf::learned::Rows;

/// The least and the largest share of scans that lack a group.
const SHARES: (f64, f64) = (0.05, 0.15);

/// The table's rows, in which every group lacks in some scans: in 5 to 15 %, drawn for each group.
pub(super) fn blanked(table: &TrainingTable, seed: u64) -> Rows {
    let mut shares = [0.0; GROUPS.len()];
    for (group, share) in shares.iter_mut().enumerate() {
        *share = SHARES.0 + (SHARES.1 - SHARES.0) * uniform(drawn(seed, u64::MAX, group as u64));
    }
    let group_of = table.group_of();
    let mut rows = table.rows.clone();
    for (row, known) in table.known.iter().enumerate() {
        let lacks = |group: usize| uniform(drawn(seed, known.scan.into(), group as u64)) < shares[group];
        let lacking: Vec<bool> = (0..GROUPS.len()).map(lacks).collect();
        blank(rows.row_mut(row), &group_of, &lacking);
    }
    rows
}

/// Takes groups of evidence away from a row.
pub(super) fn blank(row: &mut [f32], group_of: &[usize], lacking: &[bool]) {
    for (value, group) in row.iter_mut().zip(group_of) {
        if lacking[*group] {
            *value = f32::NAN;
        }
    }
}

impl TrainingTable {
    /// The group of each feature: its place in [`GROUPS`], or the last where it is in none.
    pub(super) fn group_of(&self) -> Vec<usize> {
        let place = |group| GROUPS.iter().position(|known| *known == group).unwrap_or(GROUPS.len() - 1);
        self.features.iter().map(|feature| place(feature.group)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::table;
    use super::*;

    #[test]
    fn whole_groups_lack_in_some_scans_and_nothing_else_changes() {
        let whole = table(400, 10);
        let rows = blanked(&whole, 1);
        let again = blanked(&whole, 1);
        let group_of = whole.group_of();
        let mut lacking = 0;
        for (row, known) in whole.known.iter().enumerate() {
            for feature in 0..group_of.len() {
                let (before, after) = (whole.rows.row(row)[feature], rows.row(row)[feature]);
                let first = known.scan as usize * 10;
                let of_its_scan = rows.row(first)[feature];
                assert_eq!(after.is_nan(), of_its_scan.is_nan(), "all of a scan or nothing");
                assert!(after.is_nan() || after.to_bits() == before.to_bits());
                assert_eq!(after.to_bits(), again.row(row)[feature].to_bits());
                lacking += usize::from(after.is_nan());
            }
        }
        let share = lacking as f64 / (whole.len() * group_of.len()) as f64;
        assert!((0.03..0.17).contains(&share), "{share}");
    }
}
