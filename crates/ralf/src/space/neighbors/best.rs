//! The nearest points that a search has met so far.

use super::Neighbor;
use wide::f64x4;

/// Distances are computed for so many points at a time, which the compiler turns into vector instructions.
pub(super) const LANES: usize = 8;
/// The identity of nothing: what holds the place of a point that isn't found yet.
const NOTHING: u32 = u32::MAX;

/// The nearest points so far, of those at most as far away as a point may be.
pub(super) trait Best {
    /// Points at most this far, m^2, can still enter.
    fn worst(&self) -> f32;

    /// Whether nothing was found.
    fn is_empty(&self) -> bool;

    /// Gives what was found, nearest first.
    fn give(&self, found: &mut Vec<Neighbor>);

    /// Looks at some points side by side, of which the first so many count.
    fn take(&mut self, distances: &[f32; LANES], ids: &[u32; LANES], count: usize);
}

/// One: the nearest of each lane. Which of the lanes has it is asked no sooner than it must be known, for whether a
/// point is the nearest so far is hard to foretell.
pub(super) struct One {
    /// Keys, whose bits are taken for those of numbers: of positive ones they grow with the number, and numbers are
    /// compared side by side. Distances have fewer bits for an exponent, so that all of these numbers are finite.
    nearest: f64x4,
}

const ONE_LANES: usize = 4;

impl One {
    /// The nearest among the points at most so far away, m^2.
    pub(super) fn within(limit: f32) -> Self {
        Self { nearest: f64x4::splat(f64::from_bits(key(limit, NOTHING))) }
    }

    #[inline]
    fn key(&self) -> u64 {
        let [a, b, c, d] = self.nearest.to_array();
        a.min(b).min(c.min(d)).to_bits()
    }
}

impl Best for One {
    #[inline]
    fn worst(&self) -> f32 {
        distance_squared(self.key())
    }

    #[inline]
    fn is_empty(&self) -> bool {
        neighbor(self.key()).is_none()
    }

    fn give(&self, found: &mut Vec<Neighbor>) {
        found.extend(neighbor(self.key()));
    }

    /// All of them count: what follows a run are points, too, and to meet the nearest point twice does no harm.
    #[inline]
    fn take(&mut self, distances: &[f32; LANES], ids: &[u32; LANES], _: usize) {
        let (distances, _) = distances.as_chunks::<ONE_LANES>();
        let (ids, _) = ids.as_chunks::<ONE_LANES>();
        for (distances, ids) in distances.iter().zip(ids) {
            // Without a sign what is no number is farther than everything.
            let key_of = |lane: usize| f64::from_bits(key(distances[lane].abs(), ids[lane]));
            let keys = f64x4::new([key_of(0), key_of(1), key_of(2), key_of(3)]);
            self.nearest = self.nearest.fast_min(keys);
        }
    }
}

/// Several, as keys in order. Those that aren't found yet are nothing, as far away as a point may be.
trait Sorted {
    /// As many as are wanted, nearest first.
    fn keys(&self) -> &[u64];

    /// The last of them.
    fn last(&self) -> u64;

    /// A point takes its place, unless as many are nearer.
    fn enter(&mut self, key: u64);
}

impl<S: Sorted> Best for S {
    #[inline]
    fn worst(&self) -> f32 {
        distance_squared(self.last())
    }

    #[inline]
    fn is_empty(&self) -> bool {
        self.keys().first().is_none_or(|key| neighbor(*key).is_none())
    }

    fn give(&self, found: &mut Vec<Neighbor>) {
        found.extend(self.keys().iter().map_while(|key| neighbor(*key)));
    }

    #[inline]
    fn take(&mut self, distances: &[f32; LANES], ids: &[u32; LANES], count: usize) {
        let mut hits = those_within(distances, self.worst());
        if count < LANES {
            hits &= (1 << count) - 1;
        }
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize % LANES;
            self.enter(key(distances[lane], ids[lane]));
            hits &= hits - 1;
        }
    }
}

/// A few, no more than `N`.
pub(super) struct Few<const N: usize> {
    keys: [u64; N],
    k: usize,
}

impl<const N: usize> Few<N> {
    /// The `k` nearest among the points at most so far away, m^2.
    pub(super) fn within(limit: f32, k: usize) -> Self {
        Self { keys: [key(limit, NOTHING); N], k: k.min(N) }
    }
}

impl<const N: usize> Sorted for Few<N> {
    #[inline]
    fn keys(&self) -> &[u64] {
        &self.keys[..self.k]
    }

    #[inline]
    fn last(&self) -> u64 {
        self.keys[self.k - 1]
    }

    /// All are moved or not without a branch, for which of them move is hard to foretell.
    #[inline]
    fn enter(&mut self, entering: u64) {
        for at in (1..N).rev() {
            self.keys[at] = self.keys[at].min(self.keys[at - 1].max(entering));
        }
        self.keys[0] = self.keys[0].min(entering);
    }
}

/// Any number.
pub(super) struct Many {
    keys: Vec<u64>,
}

impl Many {
    /// The `k` nearest among the points at most so far away, m^2.
    pub(super) fn within(limit: f32, k: usize) -> Self {
        Self { keys: vec![key(limit, NOTHING); k] }
    }
}

impl Sorted for Many {
    fn keys(&self) -> &[u64] {
        &self.keys
    }

    fn last(&self) -> u64 {
        self.keys.last().copied().unwrap_or_default()
    }

    fn enter(&mut self, entering: u64) {
        let place = self.keys.partition_point(|key| *key < entering);
        let last = self.keys.len() - 1;
        if place <= last {
            self.keys.copy_within(place..last, place + 1);
            self.keys[place] = entering;
        }
    }
}

/// Squared distances are never negative, and the bits of such numbers grow with them.
fn key(distance_squared: f32, id: u32) -> u64 {
    u64::from(distance_squared.to_bits()) << 32 | u64::from(id)
}

fn distance_squared(key: u64) -> f32 {
    f32::from_bits((key >> 32) as u32)
}

fn neighbor(key: u64) -> Option<Neighbor> {
    let id = key as u32;
    (id != NOTHING).then(|| Neighbor { id, distance_squared: distance_squared(key) })
}

/// A bit for each of the points that is at most so far away, m^2.
#[inline]
fn those_within(distances: &[f32; LANES], limit: f32) -> u32 {
    (0..LANES).fold(0, |bits, lane| bits | u32::from(distances[lane] <= limit) << lane)
}
