//! What moves: tracks, by place, range rate and time.

use super::Sighting;

/// A track goes on after a gap of at most this long, ns.
const GAP_NS: i64 = 250_000_000;
/// Detections of a mover lie at most this far apart, m, beside what it moves meanwhile.
const SIZE: f64 = 1.5;
/// The fastest that a mover crosses the ray, m/s: range rates don't tell.
const ACROSS: f64 = 8.0;
/// How much range rates of a mover differ within a gap, m/s.
const RATE: f64 = 1.0;

/// Whether two detections can be of one mover that the machine calls alike.
pub(super) fn follows(a: &Sighting, b: &Sighting) -> bool {
    let gap = (a.t_ns - b.t_ns).abs();
    if gap > GAP_NS || a.plausible != b.plausible || (a.rate - b.rate).abs() > RATE {
        return false;
    }
    let [ax, ay, _] = a.place;
    let [bx, by, _] = b.place;
    let speed = a.rate.abs().max(b.rate.abs()).max(ACROSS);
    (ax - bx).hypot(ay - by) <= SIZE + speed * gap as f64 * 1e-9
}

/// Gives the detections of each track among `rows` the same leader.
pub(super) fn join(sightings: &[Sighting], mut rows: Vec<usize>, leader: &mut [usize]) {
    rows.sort_by_key(|row| (sightings[*row].t_ns, *row));
    let mut first = 0;
    for (at, row) in rows.iter().enumerate() {
        let now = &sightings[*row];
        while now.t_ns - sightings[rows[first]].t_ns > GAP_NS {
            first += 1;
        }
        for before in &rows[first..at] {
            if follows(&sightings[*before], now) {
                unite(leader, *before, *row);
            }
        }
    }
    for row in rows {
        leader[row] = root(leader, row);
    }
}

fn root(leader: &mut [usize], row: usize) -> usize {
    let mut at = row;
    while leader[at] != at {
        leader[at] = leader[leader[at]];
        at = leader[at];
    }
    at
}

fn unite(leader: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(leader, a), root(leader, b));
    leader[a.max(b)] = a.min(b);
}
