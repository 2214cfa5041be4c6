//! What a model is worth by what could be observed: with all evidence and with less, by radars that measure elevation
//! and by others, where a camera sees something and where none does.

use super::scores::Scores;
use super::table::TrainingTable;
use super::view::View;

/// What a model is worth in a part of a world, and the paper's method beside it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SuiteScores {
    /// Which part, for people.
    pub name: &'static str,
    /// Detections of it.
    pub detections: usize,
    /// What the model is worth, at the threshold that is best in the other worlds.
    pub learned: Scores,
    /// What the paper's method is worth, with its settings.
    pub paper: Scores,
}

/// The parts' names, in the order in which they are told.
pub const SUITES: [&str; 9] = [
    "single frame",
    "no LiDAR",
    "no camera",
    "one radar scan",
    "half a second",
    "radars with elevation",
    "radars without elevation",
    "scans that a camera sees",
    "scans that no camera sees",
];

/// How many of them are views that show less; each other comes after these.
const LESS: usize = View::ALL.len() - 1;

/// To which of [`SUITES`] each row belongs, a bit for each.
pub(super) fn suites_of(table: &TrainingTable) -> Vec<u16> {
    let place = |wanted: &str| table.features.iter().position(|feature| feature.name == wanted);
    let (elevation, camera) = (place("geometry_elevation"), place("camera_residual"));
    let holds = |row: usize, place: Option<usize>| place.is_some_and(|at| !table.rows.row(row)[at].is_nan());
    let scans = table.known.iter().map(|known| known.scan as usize + 1).max().unwrap_or(0);
    let mut is_seen = vec![false; scans];
    for (row, known) in table.known.iter().enumerate() {
        is_seen[known.scan as usize] |= known.view == View::Whole && holds(row, camera);
    }
    let mut suites = Vec::with_capacity(table.len());
    for (row, known) in table.known.iter().enumerate() {
        let by_radar = told(elevation, holds(row, elevation), [1 << LESS, 2 << LESS]);
        let by_camera = told(camera, is_seen[known.scan as usize], [4 << LESS, 8 << LESS]);
        suites.push(match known.view {
            View::Whole => by_radar | by_camera,
            less => 1 << (less as u16 - 1),
        });
    }
    suites
}

/// One of two parts, or neither where the column that tells them apart isn't there.
fn told(column: Option<usize>, is: bool, [yes, no]: [u16; 2]) -> u16 {
    match column {
        Some(_) if is => yes,
        Some(_) => no,
        None => 0,
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::table;
    use super::*;

    #[test]
    fn rows_belong_to_what_could_be_observed_of_them() {
        let mut table = table(3, 2);
        let place = |name: &str| table.features.iter().position(|feature| feature.name == name).unwrap();
        let (elevation, camera) = (place("geometry_elevation"), place("camera_residual"));
        table.rows.row_mut(0)[elevation] = f32::NAN;
        // Of the second scan a camera sees one detection, of the third none.
        table.rows.row_mut(3)[camera] = f32::NAN;
        [4, 5].into_iter().for_each(|row| table.rows.row_mut(row)[camera] = f32::NAN);
        table.known[1].view = View::SingleFrame;
        let named = |row: usize| -> Vec<&str> {
            let bits = suites_of(&table)[row];
            SUITES
                .into_iter()
                .enumerate()
                .filter(|(at, _)| bits >> at & 1 == 1)
                .map(|(_, name)| name)
                .collect()
        };
        assert_eq!(named(0), ["radars without elevation", "scans that a camera sees"]);
        assert_eq!(named(1), ["single frame"]);
        assert_eq!(named(3), ["radars with elevation", "scans that a camera sees"]);
        assert_eq!(named(5), ["radars with elevation", "scans that no camera sees"]);
        let without = table.without_groups(&["Geometry".to_owned(), "Camera".to_owned()]);
        assert_eq!(suites_of(&without)[0], 0, "what isn't asked tells no parts apart");
    }

    #[test]
    fn a_view_has_the_name_of_its_suite() {
        for (view, name) in View::ALL.into_iter().skip(1).zip(SUITES) {
            assert_eq!(view.name(), name);
        }
    }
}
