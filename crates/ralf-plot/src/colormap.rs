//! Depth as colour: viridis (Smith and van der Walt), whose lightness is even, so that near is bright and far is dark.

/// Viridis at nine even steps, dark to bright.
const VIRIDIS: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];

/// The nearest and the farthest depth that have a colour of their own, m: always the same, so that pictures can be
/// compared.
pub(crate) const DEPTHS: [f64; 2] = [2.0, 80.0];

/// The colour of a share from 0 (dark) to 1 (bright), linear between the steps.
pub(crate) fn viridis(share: f64) -> [u8; 3] {
    let place = share.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let below = (place as usize).min(VIRIDIS.len() - 2);
    let part = place - below as f64;
    let between = |axis: usize| {
        let [low, high] = [VIRIDIS[below][axis], VIRIDIS[below + 1][axis]].map(f64::from);
        (low + (high - low) * part).round() as u8
    };
    [between(0), between(1), between(2)]
}

/// Where a depth (m, above 0) lies between the farthest (0) and the nearest (1), on a logarithmic scale: an error of a
/// tenth looks the same near and far.
pub(crate) fn nearness(depth: f64) -> f64 {
    let [near, far] = DEPTHS;
    ((far / depth).ln() / (far / near).ln()).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness of an sRGB colour.
    fn lightness(rgb: [u8; 3]) -> f64 {
        let [r, g, b] = rgb.map(|value| (f64::from(value) / 255.0).powf(2.2));
        116.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b).cbrt() - 16.0
    }

    #[test]
    fn near_is_yellow_and_far_is_violet() {
        assert_eq!([viridis(nearness(2.0)), viridis(nearness(0.1))], [VIRIDIS[8]; 2]);
        assert_eq!([viridis(nearness(80.0)), viridis(nearness(1e9))], [VIRIDIS[0]; 2]);
        assert!((nearness(160.0_f64.sqrt()) - 0.5).abs() < 1e-12, "the geometric mean lies in the middle");
        assert_eq!(viridis(0.5), VIRIDIS[4]);
    }

    #[test]
    fn lightness_grows_evenly() {
        let steps: Vec<f64> = (0..=64).map(|i| lightness(viridis(f64::from(i) / 64.0))).collect();
        for pair in steps.windows(2) {
            let step = pair[1] - pair[0];
            assert!((0.3..2.5).contains(&step), "{steps:?}");
        }
    }
}
