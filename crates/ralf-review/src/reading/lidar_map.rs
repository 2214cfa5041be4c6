//! What several LiDAR scans around one have seen stand still.

use super::lidar::{Seen, kept, seen};
use super::{matrix, time};
use crate::app::App;
use crate::http::{Answer, ApiError, Table};
use crate::labelled::SequenceLabels;
use ralf_data::SequenceReader;
use serde_json::{Map, json};
use std::ops::RangeInclusive;

/// Scans before and after that are taken part of, as many as radar scans may be accumulated.
const AROUND: usize = 100;
/// At most so many of them are read.
const READ: usize = 20;
/// Of each cell this wide one point is kept, m.
const CELL: f64 = 0.25;
/// What fewer scans have seen moves, or is noise.
const LEAST_SCANS: usize = 2;

/// A cell that a scan has seen something in: its place, the scan, and a point of it.
type Visited = ([i32; 3], usize, Seen);

/// One point for each cell of the world that several of the scans around one have seen something in, in the vehicle
/// frame at its time. Scans that can't be read are left out, as labelling leaves them out.
pub(crate) fn map(app: &App, sequence: &str, lidar: &str, scan: usize) -> Answer {
    kept(app, &app.maps, (sequence, lidar, scan), table)
}

fn table(
    reader: &dyn SequenceReader,
    labels: &SequenceLabels,
    (lidar, scan): (usize, usize),
) -> Result<Vec<u8>, ApiError> {
    let (motion, times) = (&reader.sequence().motion, &reader.sequence().times.lidars[lidar]);
    let mut visited: Vec<Visited> = Vec::new();
    let around = scan.saturating_sub(AROUND)..=(scan + AROUND).min(times.len() - 1);
    let (mut read, mut problem) = (0, None);
    for there in spread(around) {
        let points = match seen(reader, labels, (lidar, there), times[there]) {
            Ok(points) => points.into_iter().flatten(),
            Err(error) => {
                problem = Some(error);
                continue;
            }
        };
        read += 1;
        let here_from_there = motion.between(times[scan], times[there]);
        let moved = points.map(|seen| Seen { place: here_from_there * seen.place, ..seen });
        visited.append(&mut one_each(moved, there));
    }
    if let Some(problem) = problem.filter(|_| read == 0) {
        return Err(problem);
    }
    visited.sort_by_key(|(cell, scan, _)| (*cell, *scan));
    let least = LEAST_SCANS.min(read);
    let cells = visited.chunk_by(|a, b| a.0 == b.0).filter(|visits| visits.len() >= least);
    let found: Vec<Option<Seen>> = cells.map(|visits| Some(visits[0].2)).collect();
    let more = Map::from_iter([
        ("t_ns".to_owned(), time(times[scan])),
        ("odom_from_vehicle".to_owned(), matrix(&motion.odom_from_vehicle(times[scan]))),
        ("scans".to_owned(), json!(read)),
    ]);
    Ok(super::lidar::points(&found, Table::new(found.len())).finish(more))
}

/// One of a scan's points for each cell.
fn one_each(points: impl Iterator<Item = Seen>, scan: usize) -> Vec<Visited> {
    let mut visited: Vec<Visited> =
        points.map(|seen| (cell(&seen.place.coords.into()), scan, seen)).collect();
    visited.sort_by_key(|(cell, ..)| *cell);
    visited.dedup_by_key(|(cell, ..)| *cell);
    visited
}

/// So many of them that are read, as far apart from each other as may be.
fn spread(scans: RangeInclusive<usize>) -> Vec<usize> {
    let step = (scans.end() - scans.start() + 1).div_ceil(READ);
    scans.step_by(step).collect()
}

fn cell(place: &[f64; 3]) -> [i32; 3] {
    place.map(|metres| (metres / CELL).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scans_are_read_from_all_along() {
        assert_eq!(spread(3..=6), [3, 4, 5, 6]);
        let many = spread(0..=200);
        assert!(many.len() <= READ && many.len() > READ / 2);
        assert!(many.windows(2).all(|pair| pair[1] - pair[0] == many[1]) && many[0] == 0);
    }
}
