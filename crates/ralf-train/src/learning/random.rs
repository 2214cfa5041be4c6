//! Choices that follow from a seed and from what they are about, in whatever order they are made.

/// A number that looks random, of a seed and two numbers (SplitMix64's finalizer).
pub(super) fn drawn(seed: u64, about: u64, which: u64) -> u64 {
    mixed(mixed(mixed(seed) ^ about) ^ which)
}

fn mixed(seed: u64) -> u64 {
    let z = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// In [0, 1).
pub(super) fn uniform(drawn: u64) -> f64 {
    (drawn >> 11) as f64 / (1_u64 << 53) as f64
}
