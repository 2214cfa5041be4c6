//! Plausibilities sorted roughly: in buckets of nearly equal ones, with what is true of them. One pass, and no sorting.

/// Buckets per factor of two, as a power of two.
const PER_OCTAVE_LOG: u32 = 9;
/// Plausibilities below `2^-OCTAVES` share a bucket.
const OCTAVES: u64 = 24;
/// How many of a float's bits don't name its bucket, which exponent and first digits do.
const SHIFT: u32 = 52 - PER_OCTAVE_LOG;
const LOWEST: u64 = (1023 - OCTAVES) << PER_OCTAVE_LOG;
const COUNT: usize = ((OCTAVES as usize) << PER_OCTAVE_LOG) + 1;

/// What is true of nearly equal plausibilities.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Bucket {
    pub(super) plausible: u64,
    pub(super) artifacts: u64,
    /// The highest of them.
    pub(super) highest: f64,
}

impl Bucket {
    pub(super) fn len(&self) -> usize {
        (self.plausible + self.artifacts) as usize
    }
}

/// The place of a plausibility's bucket: a higher plausibility never has a lower one.
pub(super) fn place(w: f64) -> usize {
    // The bits of floats that are not negative are ordered as the floats are.
    ((w.to_bits() >> SHIFT).saturating_sub(LOWEST) as usize).min(COUNT - 1)
}

/// All buckets, by their place.
pub(super) fn buckets(weighed: &[(f64, bool)]) -> Vec<Bucket> {
    let mut buckets = vec![Bucket::default(); COUNT];
    for &(w, plausible) in weighed {
        let bucket = &mut buckets[place(w)];
        bucket.highest = bucket.highest.max(w);
        *(if plausible { &mut bucket.plausible } else { &mut bucket.artifacts }) += 1;
    }
    buckets
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn places_are_ordered_as_plausibilities_are(a in 0.0..=1.0, b in 0.0..=1.0, exponent in -40..0) {
            let b = b * 2.0_f64.powi(exponent);
            let (low, high) = if a < b { (a, b) } else { (b, a) };
            prop_assert!(place(low) <= place(high));
        }
    }

    #[test]
    fn all_that_is_possible_has_a_place() {
        assert_eq!([place(0.0), place(1e-300), place(1.0)], [0, 0, COUNT - 1]);
        assert!(place(0.5) < place(0.501) && place(1e-6) < place(1.003e-6));
    }
}
