//! Detections of a sequence that belong together in the world: what one answer of a person can be about.
//!
//! A *thing* is either part of what stands still (neighbouring cells of the world whose detections the machine mostly
//! calls alike), or the track of something that moves. [`group`] is a pure function of places, times, range rates and
//! labels; [`SequenceThings`] asks a recording and its labels for these. A [`Kind`] is wider: detections all over a
//! sequence whose evidence says the same against their label.

mod doubtful;
mod evidence;
mod heard;
mod kinds;
mod moving;
mod opinion;
mod sequence;
mod sign;
mod standing;

pub use doubtful::{Answer, Doubtful, Thing};
pub use evidence::{Extent, SequenceEvidence};
pub use kinds::{Kind, KindName};
pub use opinion::Change;
pub use sequence::SequenceThings;
pub use sign::Sign;

/// A detection, as far as it matters to what it belongs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sighting {
    /// When it was measured, ns.
    pub t_ns: i64,
    /// Where it lies in the odometry frame, m; not finite where that isn't known.
    pub place: [f64; 3],
    /// Its range rate without the vehicle's motion, m/s; NaN where none was measured.
    pub rate: f64,
    /// Its plausibility.
    pub w: f32,
    /// What the machine calls it.
    pub plausible: bool,
}

/// What is faster than this along the ray moves, m/s.
pub const MOVING: f64 = 0.7;

impl Sighting {
    /// Whether it moves: faster than [`MOVING`].
    pub fn moves(&self) -> bool {
        self.rate.abs() > MOVING
    }

    fn has_place(&self) -> bool {
        self.place.iter().all(|metres| metres.is_finite())
    }
}

/// The thing of each detection: the same number for those that belong together. Things are numbered as their first
/// detections come; one without a place is a thing of its own. The same sightings give the same numbers.
pub fn group(sightings: &[Sighting]) -> Vec<u32> {
    let rows = |moves: bool| {
        let chosen = sightings.iter().enumerate().filter(move |(_, s)| s.has_place() && s.moves() == moves);
        chosen.map(|(row, _)| row).collect::<Vec<_>>()
    };
    let mut leader: Vec<usize> = (0..sightings.len()).collect();
    standing::join(sightings, &rows(false), &mut leader);
    moving::join(sightings, rows(true), &mut leader);
    numbered(&leader)
}

/// Numbers groups, of each of which every member knows the leader, by their first members.
fn numbered(leader: &[usize]) -> Vec<u32> {
    let mut number = vec![None; leader.len()];
    let mut count = 0;
    let mut numbers = Vec::with_capacity(leader.len());
    for leader in leader {
        let next = *number[*leader].get_or_insert_with(|| {
            count += 1;
            count - 1
        });
        numbers.push(next);
    }
    numbers
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SECOND: i64 = 1_000_000_000;

    fn standing(x: f64, y: f64, w: f32) -> Sighting {
        Sighting { t_ns: 0, place: [x, y, 0.0], rate: 0.0, w, plausible: w >= 0.5 }
    }

    #[test]
    fn neighbours_that_are_called_alike_are_one_thing_however_far_apart_in_time() {
        let mut seen = vec![
            standing(0.1, 0.1, 0.9),
            standing(0.3, 0.1, 0.9),
            standing(9.0, 0.1, 0.9),
            standing(0.1, 0.3, 0.1),
        ];
        seen[1].t_ns = 100 * SECOND;
        assert_eq!(group(&seen), [0, 0, 1, 2]);
    }

    #[test]
    fn few_in_a_cell_that_say_otherwise_belong_to_it() {
        let mut seen = vec![standing(0.1, 0.1, 0.9); 12];
        seen[5] = standing(0.1, 0.1, 0.4);
        assert!(group(&seen).iter().all(|thing| *thing == 0));
    }

    #[test]
    fn a_wall_is_cut_into_pieces_that_a_person_can_judge() {
        let wall: Vec<Sighting> = (0..100).map(|i| standing(f64::from(i) * 0.25, 0.1, 0.9)).collect();
        let things = group(&wall);
        for (a, thing) in things.iter().enumerate() {
            let last = things.iter().rposition(|other| other == thing).unwrap();
            assert!(wall[last].place[0] - wall[a].place[0] <= 2.0 * standing::REACH + 2.0 * standing::CELL);
        }
        assert!((10..60).contains(&(things.iter().max().unwrap() + 1)));
    }

    /// A car at 10 m/s, seen every tenth of a second, and another one that comes towards it.
    #[test]
    fn a_mover_is_one_thing_over_its_life_and_none_of_another() {
        let seen: Vec<Sighting> = (0..40)
            .map(|i| {
                let (step, comes) = (f64::from(i / 2), i % 2 == 1);
                let (x, rate) = if comes { (40.0 - step, -10.0) } else { (step, 10.0) };
                let t_ns = i64::from(i / 2) * SECOND / 10;
                Sighting { t_ns, place: [x, 0.5, 0.0], rate, w: 0.9, plausible: true }
            })
            .collect();
        let things = group(&seen);
        for (i, thing) in things.iter().enumerate() {
            assert_eq!(*thing, (i % 2) as u32);
        }
    }

    #[test]
    fn what_has_no_place_is_a_thing_of_its_own() {
        let nowhere = Sighting { place: [f64::NAN; 3], ..standing(0.0, 0.0, 0.9) };
        assert_eq!(group(&[nowhere, standing(0.0, 0.0, 0.9), nowhere]), [0, 1, 2]);
        assert!(group(&[]).is_empty());
    }

    fn sighting() -> impl Strategy<Value = Sighting> {
        (0..20i64, -4..4i32, -4..4i32, prop_oneof![Just(0.0), Just(3.0), Just(-3.0)], 0..5u8).prop_map(
            |(t, x, y, rate, w)| Sighting {
                t_ns: t * SECOND / 10,
                place: [f64::from(x) * 0.3, f64::from(y) * 0.3, 0.0],
                rate,
                w: f32::from(w) * 0.25,
                plausible: w >= 2,
            },
        )
    }

    fn pairs(seen: &[Sighting]) -> impl Iterator<Item = (usize, usize)> {
        let count = seen.len();
        (0..count).flat_map(move |a| (0..count).map(move |b| (a, b)))
    }

    proptest! {
        /// Against going through all pairs.
        #[test]
        fn movers_are_joined_as_if_every_pair_had_been_looked_at(seen in proptest::collection::vec(sighting(), 0..40)) {
            let things = group(&seen);
            let mut leader: Vec<usize> = (0..seen.len()).collect();
            for _ in 0..seen.len() {
                for (a, b) in pairs(&seen) {
                    if seen[a].moves() && seen[b].moves() && moving::follows(&seen[a], &seen[b]) {
                        let least = leader[a].min(leader[b]);
                        (leader[a], leader[b]) = (least, least);
                    }
                }
            }
            for (a, b) in pairs(&seen).filter(|(a, b)| seen[*a].moves() && seen[*b].moves()) {
                prop_assert_eq!(things[a] == things[b], leader[a] == leader[b]);
            }
        }

        /// No thing holds what moves and what stands, nor reaches farther than it may; every number is used.
        #[test]
        fn things_keep_their_bounds(seen in proptest::collection::vec(sighting(), 0..60)) {
            let things = group(&seen);
            let mut used: Vec<u32> = things.clone();
            used.sort_unstable();
            used.dedup();
            prop_assert!(used.iter().copied().eq(0..used.len() as u32));
            for (a, b) in pairs(&seen).filter(|(a, b)| things[*a] == things[*b]) {
                prop_assert_eq!(seen[a].moves(), seen[b].moves());
                let [ax, ay, _] = seen[a].place;
                let [bx, by, _] = seen[b].place;
                let most = 2.0 * standing::REACH + 3.0 * standing::CELL;
                prop_assert!(seen[a].moves() || (ax - bx).hypot(ay - by) <= most);
            }
        }
    }
}
