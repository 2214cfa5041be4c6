//! What stands still: cells of the world, and neighbours of the same kind joined around the fullest of them.

use super::Sighting;
use std::cmp::Reverse;
use std::collections::{BTreeMap, VecDeque};

/// The side of a cell, m.
pub(super) const CELL: f64 = 0.25;
/// How far the cells of a thing lie from the one that it grew from, at most, m.
pub(super) const REACH: f64 = 0.5;
/// How much the mean plausibility of a cell may differ from that of the one that its thing grew from.
const LIKE: f64 = 0.1;

/// A cell's place, in cells.
type Place = (i64, i64);

/// What lies in a cell.
#[derive(Default)]
struct Cell {
    rows: Vec<usize>,
    plausible: usize,
    sum: f64,
}

impl Cell {
    /// What most of it is called.
    fn is_plausible(&self) -> bool {
        2 * self.plausible >= self.rows.len()
    }

    fn mean(&self) -> f64 {
        self.sum / self.rows.len() as f64
    }

    fn is_like(&self, seed: &Self) -> bool {
        self.is_plausible() == seed.is_plausible() && (self.mean() - seed.mean()).abs() <= LIKE
    }
}

/// Gives the detections of each thing among `rows` the same leader. The fullest cell grows first.
pub(super) fn join(sightings: &[Sighting], rows: &[usize], leader: &mut [usize]) {
    let mut cells = cells_of(sightings, rows);
    let mut seeds: Vec<(Reverse<usize>, Place)> =
        cells.iter().map(|(place, cell)| (Reverse(cell.rows.len()), *place)).collect();
    seeds.sort_unstable();
    for (_, place) in seeds {
        let Some(seed) = cells.remove(&place) else { continue };
        let Some(first) = seed.rows.first().copied() else { continue };
        let mut edge = VecDeque::from([place]);
        let mut members = seed.rows.clone();
        while let Some(from) = edge.pop_front() {
            for next in neighbours(from).filter(|next| is_near(*next, place)) {
                if cells.get(&next).is_some_and(|cell| cell.is_like(&seed)) {
                    members.extend(cells.remove(&next).unwrap_or_default().rows);
                    edge.push_back(next);
                }
            }
        }
        for row in members {
            leader[row] = first;
        }
    }
}

fn cells_of(sightings: &[Sighting], rows: &[usize]) -> BTreeMap<Place, Cell> {
    let mut cells: BTreeMap<Place, Cell> = BTreeMap::new();
    for row in rows {
        let Sighting { place: [x, y, _], w, plausible, .. } = sightings[*row];
        let cell = cells.entry(((x / CELL).floor() as i64, (y / CELL).floor() as i64)).or_default();
        cell.rows.push(*row);
        cell.plausible += usize::from(plausible);
        cell.sum += f64::from(w);
    }
    cells
}

fn neighbours((x, y): Place) -> impl Iterator<Item = Place> {
    (-1..=1).flat_map(move |dx| (-1..=1).map(move |dy| (x + dx, y + dy)))
}

fn is_near((x, y): Place, (seed_x, seed_y): Place) -> bool {
    let apart = ((x - seed_x) as f64).hypot((y - seed_y) as f64);
    apart * CELL <= REACH
}
