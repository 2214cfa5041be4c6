//! Fusion of the branches into a plausibility and a label (paper, equations 6 and 9; docs/method.md, sections 6 and 8).

/// `w_opt`: in the LiDAR's blind spot the camera's answer, elsewhere the LiDAR's; where the chosen one is absent, the
/// other.
pub fn optical(in_blind_spot: bool, w_lm: Option<f64>, w_cm: Option<f64>) -> Option<f64> {
    if in_blind_spot { w_cm.or(w_lm) } else { w_lm.or(w_cm) }
}

/// `w = (alpha w_opt + (1 - alpha) w_tr) / gamma_s`. With one branch absent the other counts alone; `None` without
/// both.
///
/// ```
/// use ralf::paper::prioritize;
/// assert_eq!(prioritize(0.25, Some(1.0), Some(0.5), 1.0), Some(0.625));
/// assert_eq!(prioritize(0.25, None, Some(0.5), 2.0), Some(0.25));
/// assert_eq!(prioritize(0.25, None, None, 1.0), None);
/// ```
pub fn prioritize(alpha: f64, w_opt: Option<f64>, w_tr: Option<f64>, gamma_s: f64) -> Option<f64> {
    let w = match (w_opt, w_tr) {
        (Some(w_opt), Some(w_tr)) => alpha * w_opt + (1.0 - alpha) * w_tr,
        (one, other) => one.or(other)?,
    };
    Some(w / gamma_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_camera_answers_in_the_blind_spot_and_the_lidar_elsewhere() {
        let [lm, cm] = [Some(0.3), Some(0.9)];
        assert_eq!(optical(true, lm, cm), cm);
        assert_eq!(optical(false, lm, cm), lm);
        assert_eq!(optical(true, lm, None), lm);
        assert_eq!(optical(false, None, cm), cm);
        assert_eq!(optical(false, None, None), None);
    }
}
