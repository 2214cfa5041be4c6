//! Random numbers of the simulator: each draw follows from the seed, what it is for, and which measurement it belongs
//! to, so that a measurement is the same whenever it is asked for.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::f64::consts::TAU;

/// What numbers are drawn for.
#[derive(Debug, Clone, Copy)]
pub(super) enum Purpose {
    Placement = 1,
    Scatterers,
    Odometry,
    Lidar,
    Radar,
    Image,
    Depth,
    World,
    Calibration,
}

/// A stream of random numbers.
#[derive(Debug)]
pub(super) struct Random(Pcg64Mcg);

impl Random {
    /// The stream of one purpose and one measurement of one sensor.
    pub(super) fn new(seed: u64, purpose: Purpose, sensor: usize, measurement: usize) -> Self {
        let parts = [purpose as u64, sensor as u64, measurement as u64];
        Self(Pcg64Mcg::seed_from_u64(parts.into_iter().fold(mixed(seed), |state, part| mixed(state ^ part))))
    }

    /// In [0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        self.0.random()
    }

    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// Normally distributed about 0 (Box and Muller).
    pub(super) fn normal(&mut self, sigma: f64) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        sigma * radius * (TAU * self.uniform()).cos()
    }

    /// Exponentially distributed.
    pub(super) fn exponential(&mut self, mean: f64) -> f64 {
        -mean * (1.0 - self.uniform()).ln()
    }

    /// How many events of a Poisson process (Knuth); for means of some hundred at most.
    pub(super) fn poisson(&mut self, mean: f64) -> usize {
        let end = (-mean).exp();
        let mut product = self.uniform();
        let mut events = 0;
        while product > end {
            product *= self.uniform();
            events += 1;
        }
        events
    }
}

/// A number in [0, 1) that belongs to a place and stays what it is: grain of the ground, of a facade, of an aspect.
pub(super) fn grain(seed: u64, place: [i64; 3]) -> f64 {
    let hash = place.into_iter().fold(mixed(seed), |state, part| mixed(state ^ part as u64));
    (hash >> 11) as f64 / (1_u64 << 53) as f64
}

/// Spreads neighbouring numbers over all 64 bits (SplitMix64's finaliser).
fn mixed(value: u64) -> u64 {
    let z = value.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_as_asked_for() {
        let mut random = Random::new(1, Purpose::Radar, 0, 0);
        let n = 20_000;
        let (mut sum, mut squares, mut events) = (0.0, 0.0, 0);
        for _ in 0..n {
            let value = random.normal(2.0);
            sum += value;
            squares += value * value;
            events += random.poisson(60.0);
        }
        let n = f64::from(n);
        assert!((sum / n).abs() < 0.05 && (squares / n - 4.0).abs() < 0.15);
        assert!((events as f64 / n - 60.0).abs() < 0.3);
    }

    #[test]
    fn every_measurement_has_a_stream_of_its_own() {
        let first = |seed, purpose, sensor, scan| Random::new(seed, purpose, sensor, scan).uniform();
        let streams = [
            first(1, Purpose::Radar, 0, 0),
            first(2, Purpose::Radar, 0, 0),
            first(1, Purpose::Lidar, 0, 0),
            first(1, Purpose::Radar, 1, 0),
            first(1, Purpose::Radar, 0, 1),
        ];
        for (i, value) in streams.iter().enumerate() {
            assert!(!streams[..i].contains(value));
        }
        assert_eq!(streams[4], first(1, Purpose::Radar, 0, 1));
    }
}
