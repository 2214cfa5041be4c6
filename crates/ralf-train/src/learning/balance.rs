//! Weights that take away what a world's shares happen to say.
//!
//! How many of the detections that move are real depends on the traffic and on the noise of a recording, and both
//! differ from place to place: where a simulator has few cars and much noise, *it moves* would mean *it is an
//! artifact*, and on a real street all cars and people would go. So movers count such that moving by itself says
//! nothing.

use super::table::TrainingTable;

/// The feature that tells how surely a detection moves.
const MOVES: &str = "doppler_residual";
/// Between those that stand, may move, move and move fast, in units of [`MOVES`].
const EDGES: [f32; 3] = [1.5, 3.0, 6.0];
/// No row counts more than so many.
const MOST: f64 = 8.0;

/// Of the detections of one class in one cell.
#[derive(Debug, Clone, Copy, Default)]
struct Cell {
    plausible: f64,
    all: f64,
}

/// The weight of each row: in every world, and among those that stand as among those that move, as large a share is
/// plausible.
pub(super) fn weights(table: &TrainingTable) -> Vec<f32> {
    let moves = table.features.iter().position(|feature| feature.name == MOVES);
    let cell_of = |row: usize| {
        let value = moves.map_or(f32::NAN, |moves| table.rows.row(row)[moves].abs());
        // What has no range rate is in a cell of its own.
        if value.is_nan() { EDGES.len() + 1 } else { EDGES.partition_point(|edge| *edge <= value) }
    };
    let mut cells = vec![[Cell::default(); EDGES.len() + 2]; table.worlds.len()];
    let mut worlds = vec![Cell::default(); table.worlds.len()];
    for (row, known) in table.known.iter().enumerate() {
        let world = usize::from(known.world);
        let plausible = if known.plausible { 1.0 } else { 0.0 };
        for cell in [&mut cells[world][cell_of(row)], &mut worlds[world]] {
            cell.plausible += plausible;
            cell.all += 1.0;
        }
    }
    let mut weights = Vec::with_capacity(table.len());
    for (row, known) in table.known.iter().enumerate() {
        let world = usize::from(known.world);
        let share = |cell: &Cell| {
            let plausible = cell.plausible / cell.all;
            if known.plausible { plausible } else { 1.0 - plausible }
        };
        let weight = share(&worlds[world]) / share(&cells[world][cell_of(row)]);
        weights.push(weight.min(MOST) as f32);
    }
    weights
}

#[cfg(test)]
mod tests {
    use super::super::testing::table;
    use super::*;

    #[test]
    fn what_moves_is_plausible_as_often_as_what_stands() {
        let mut table = table(300, 10);
        let moves = table.features.iter().position(|feature| feature.name == MOVES).unwrap();
        for row in 0..table.len() {
            let moving = row % 3 == 0;
            table.rows.row_mut(row)[moves] = if moving { -9.0 } else { 0.5 };
            // Of those that move one in five is plausible, of the others four.
            table.known[row].plausible = (row / 30 % 5 == 0) == moving;
        }
        let weights = weights(&table);
        let share = |moving: bool| {
            let (mut plausible, mut all) = (0.0, 0.0);
            for (row, weight) in weights.iter().enumerate().filter(|(row, _)| (row % 3 == 0) == moving) {
                all += weight;
                plausible += if table.known[row].plausible { *weight } else { 0.0 };
            }
            plausible / all
        };
        assert!((share(true) - share(false)).abs() < 0.02, "{} {}", share(true), share(false));
    }
}
