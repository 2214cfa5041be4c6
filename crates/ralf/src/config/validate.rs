//! Refusing settings that make no sense.

use super::Config;
use super::read::{ConfigError, read_toml};

impl Config {
    /// Settings from a TOML text and assignments `key=value` that win over it.
    ///
    /// ```
    /// use ralf::config::Config;
    /// let config = Config::from_toml("[fusion]\nalpha = 0.7", &["lidar.beta=0.5", "ground.model=none"]).unwrap();
    /// assert_eq!((config.fusion.alpha, config.lidar.beta), (0.7, 0.5));
    /// assert!(Config::from_toml("", &["lidar.betta=0.5"]).unwrap_err().to_string().contains("betta"));
    /// ```
    pub fn from_toml(text: &str, assignments: &[&str]) -> Result<Self, ConfigError> {
        Self::from_toml_beside(&[], text, assignments)
    }

    /// [`Self::from_toml`] for a file that holds other tables besides: those of these names are left to whom they
    /// belong to.
    pub fn from_toml_beside(others: &[&str], text: &str, assignments: &[&str]) -> Result<Self, ConfigError> {
        let config: Self = read_toml(text, assignments, others)?;
        config.check()?;
        Ok(config)
    }

    /// All settings as TOML.
    pub fn to_toml(&self) -> Result<String, ConfigError> {
        toml::to_string(self).map_err(|error| ConfigError::Parse(error.to_string()))
    }

    fn check(&self) -> Result<(), ConfigError> {
        let Self { sync, ground, lidar, camera, tracking, fusion, .. } = self;
        at_least(
            0.0,
            &[
                ("sync.lidar_tolerance_ms", sync.lidar_tolerance_ms),
                ("sync.camera_tolerance_ms", sync.camera_tolerance_ms),
                ("ground.max_offset", ground.max_offset),
                ("ground.radar_sigmas", ground.radar_sigmas),
                ("camera.occlusion_window", camera.occlusion_window),
                ("camera.depth_sigma", camera.depth_sigma),
                ("camera.min_luminance", camera.min_luminance),
            ],
        )?;
        above_zero(&[
            ("ground.inlier_distance", ground.inlier_distance),
            ("lidar.beta", lidar.beta),
            ("camera.beta", camera.beta),
            ("camera.max_depth", camera.max_depth),
            ("camera.max_residual", camera.max_residual),
            ("tracking.beta", tracking.beta),
            ("tracking.max_mismatch", tracking.max_mismatch),
            ("tracking.max_gap_ms", tracking.max_gap_ms),
        ])?;
        finite(&[
            ("ground.lidar_margin", ground.lidar_margin),
            ("ground.camera_margin", ground.camera_margin),
            ("ground.radar_clearance", ground.radar_clearance),
        ])?;
        between((0.0, 1.0), &[("fusion.alpha", fusion.alpha), ("fusion.threshold", fusion.threshold)])?;
        between((0.0, 90.0), &[("ground.max_tilt_deg", ground.max_tilt_deg)])?;
        counts(&[
            ("lidar.neighbours", lidar.neighbours),
            ("camera.neighbours", camera.neighbours),
            ("camera.stride", camera.stride),
            ("camera.scale_neighbours", camera.scale_neighbours),
            ("tracking.scans", tracking.scans),
            ("tracking.neighbours", tracking.neighbours),
        ])
    }
}

type Values<'a> = &'a [(&'a str, f64)];

fn check_all(values: Values, expected: &str, fits: impl Fn(f64) -> bool) -> Result<(), ConfigError> {
    match values.iter().find(|(_, value)| !value.is_finite() || !fits(*value)) {
        None => Ok(()),
        Some((key, found)) => {
            Err(ConfigError::Value { key: (*key).to_owned(), expected: format!("{expected}, found {found}") })
        }
    }
}

fn at_least(limit: f64, values: Values) -> Result<(), ConfigError> {
    check_all(values, &format!("at least {limit}"), |value| value >= limit)
}

fn above_zero(values: Values) -> Result<(), ConfigError> {
    check_all(values, "more than 0", |value| value > 0.0)
}

fn finite(values: Values) -> Result<(), ConfigError> {
    check_all(values, "a finite number", |_| true)
}

fn between((low, high): (f64, f64), values: Values) -> Result<(), ConfigError> {
    check_all(values, &format!("{low} to {high}"), |value| (low..=high).contains(&value))
}

fn counts(values: &[(&str, usize)]) -> Result<(), ConfigError> {
    match values.iter().find(|(_, value)| *value == 0) {
        None => Ok(()),
        Some((key, _)) => {
            Err(ConfigError::Value { key: (*key).to_owned(), expected: "at least 1, found 0".into() })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str, assignments: &[&str]) -> String {
        Config::from_toml(text, assignments).unwrap_err().to_string()
    }

    #[test]
    fn unknown_keys_are_named() {
        assert!(refusal("[lidar]\nbetta = 1.0", &[]).contains("betta"));
        assert!(refusal("[lidarr]\nbeta = 1.0", &[]).contains("lidarr"));
        assert!(refusal("", &["fusion.aplha=1.0"]).contains("aplha"));
    }

    #[test]
    fn values_out_of_range_are_named() {
        assert!(refusal("[fusion]\nalpha = 1.5", &[]).contains("fusion.alpha"));
        assert!(refusal("", &["lidar.neighbours=0"]).contains("lidar.neighbours"));
        assert!(refusal("", &["lidar.beta=nan"]).contains("lidar.beta"));
        assert!(refusal("", &["lidar.beta"]).contains("KEY=VALUE"));
        assert!(refusal("", &["ground.model=round"]).contains("round"));
    }

    #[test]
    fn whole_numbers_are_decimals_where_those_are_wanted() {
        assert_eq!(Config::from_toml("[lidar]\nbeta = 1", &["tracking.beta=2"]).unwrap().tracking.beta, 2.0);
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut config = Config::from_toml("seed = 7", &["sensors.front.sigma_range_m=0.2"]).unwrap();
        config.fusion.alpha = 0.1 + 0.2;
        assert_eq!(Config::from_toml(&config.to_toml().unwrap(), &[]).unwrap(), config);
    }
}
