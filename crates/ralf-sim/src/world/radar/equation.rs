//! The radar equation, the antenna's pattern, Doppler's ambiguity.

use super::model::RadarModel;

/// Range at which the sensitivity is stated, m.
pub(super) const REFERENCE_RANGE: f64 = 10.0;
/// What the antenna takes at the edge of the field of view, there and back, dB: views are stated between such points.
const EDGE_LOSS_DB: [f64; 2] = [9.0, 12.0];

/// Sensitivity of a radar for which 10 dBsm on boresight at `car_range` (m) are 13 dB above noise.
pub(crate) fn sensitivity_db(car_range: f64) -> f64 {
    13.0 - 10.0 + range_loss_db(car_range)
}

/// The fourth power of range, relative to the reference, dB.
pub(super) fn range_loss_db(range: f64) -> f64 {
    40.0 * (range / REFERENCE_RANGE).log10()
}

/// Signal to noise of a cross-section in a direction, dB: `sensitivity + rcs - 40 log10(r / 10 m) + 2 G`.
pub(super) fn snr_db(radar: &RadarModel, rcs_db: f64, range: f64, [azimuth, elevation]: [f64; 2]) -> f64 {
    radar.sensitivity_db + rcs_db - range_loss_db(range) + gain_db(radar, [azimuth, elevation])
}

/// The pattern of the antenna there and back, dB below boresight.
pub(super) fn gain_db(radar: &RadarModel, angles: [f64; 2]) -> f64 {
    let loss = |axis: usize| EDGE_LOSS_DB[axis] * (2.0 * angles[axis] / radar.fov[axis]).powi(2);
    -loss(0) - loss(1)
}

/// The cross-section that a signal to noise ratio means at a range and azimuth, dBsm: a radar knows its pattern in
/// azimuth.
pub(super) fn apparent_rcs_db(radar: &RadarModel, snr_db: f64, range: f64, azimuth: f64) -> f64 {
    snr_db - radar.sensitivity_db + range_loss_db(range) - gain_db(radar, [azimuth, 0.0])
}

/// A range rate as an ambiguous radar tells it, in `[-interval / 2, interval / 2)`.
pub(super) fn folded(range_rate: f64, interval: f64) -> f64 {
    (range_rate + interval / 2.0).rem_euclid(interval) - interval / 2.0
}

/// dB as a ratio.
pub(super) fn ratio(db: f64) -> f64 {
    10.0_f64.powf(db / 10.0)
}

/// A ratio in dB.
pub(super) fn decibel(ratio: f64) -> f64 {
    10.0 * ratio.log10()
}

#[cfg(test)]
mod tests {
    use super::super::model::tests::radar;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_car_on_boresight_is_13_db_above_noise_at_its_range() {
        let radar = RadarModel { sensitivity_db: sensitivity_db(80.0), ..radar() };
        assert!((snr_db(&radar, 10.0, 80.0, [0.0; 2]) - 13.0).abs() < 1e-12);
    }

    proptest! {
        #[test]
        fn twice_the_range_costs_twelve_db_and_ten_times_the_cross_section_gains_ten(
            range in 1.0..150.0, rcs in -30.0..30.0, azimuth in -1.0..1.0, elevation in -0.2..0.2,
        ) {
            let near = snr_db(&radar(), rcs, range, [azimuth, elevation]);
            let far = snr_db(&radar(), rcs, 2.0 * range, [azimuth, elevation]);
            prop_assert!((near - far - 40.0 * 2.0_f64.log10()).abs() < 1e-9);
            prop_assert!((snr_db(&radar(), rcs + 10.0, range, [azimuth, elevation]) - near - 10.0).abs() < 1e-9);
        }

        #[test]
        fn nothing_is_louder_than_on_boresight(azimuth in -1.4..1.4, elevation in -0.3..0.3) {
            let at = |angles| snr_db(&radar(), 0.0, 30.0, angles);
            prop_assert!(at([azimuth, elevation]) <= at([0.0; 2]));
            prop_assert!((at([azimuth, elevation]) - at([-azimuth, -elevation])).abs() < 1e-9);
        }

        #[test]
        fn a_radar_on_its_horizon_tells_the_cross_section_itself(
            range in 1.0..150.0, rcs in -30.0..30.0, azimuth in -1.3..1.3,
        ) {
            let snr = snr_db(&radar(), rcs, range, [azimuth, 0.0]);
            prop_assert!((apparent_rcs_db(&radar(), snr, range, azimuth) - rcs).abs() < 1e-9);
        }

        #[test]
        fn a_folded_rate_lies_in_the_interval_and_is_off_by_whole_ones(rate in -200.0..200.0, interval in 5.0..150.0) {
            let found = folded(rate, interval);
            prop_assert!((-interval / 2.0..=interval / 2.0).contains(&found));
            let turns = (rate - found) / interval;
            prop_assert!((turns - turns.round()).abs() < 1e-9);
            prop_assert!(rate.abs() > interval / 2.0 || (found - rate).abs() < 1e-9);
        }
    }
}
