//! What a user knows better than the recording.

use super::error::ConfigError;
use super::exact;
use crate::sensors::{Lidar, Radar, Reliability, Rig};
use serde::{Deserialize, Serialize};

/// `sensors.NAME`: values that replace those of the sensor of that name. Keys and units are those of `sequence.toml`.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SensorOverride {
    /// Radar or LiDAR, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_range_m: Option<f64>,
    /// Radar, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_azimuth_deg: Option<f64>,
    /// Radar, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sigma_elevation_deg: Option<f64>,
    /// Radar, full angle, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_azimuth_deg: Option<f64>,
    /// Radar, full angle, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fov_elevation_deg: Option<f64>,
    /// Radar: azimuth in degrees and value.
    #[serde(skip_serializing_if = "Option::is_none", deserialize_with = "exact::optional_rows")]
    pub reliability: Option<Vec<[f64; 2]>>,
    /// LiDAR: depression of the lowest beam, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lowest_beam_deg: Option<f64>,
    /// LiDAR, m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_range_m: Option<f64>,
}

impl super::Config {
    /// Puts the overrides of `sensors` into a rig, all or none. Names that the rig lacks are refused, but those of
    /// sensors that are `absent`: the recording has them, and nothing of them can be read.
    ///
    /// # Errors
    /// Such a name, values that the sensor can't have, and settings that [`Self::check`] refuses.
    pub fn apply_to(&self, rig: &mut Rig, absent: &[String]) -> Result<(), ConfigError> {
        self.check()?;
        let mut changed = rig.clone();
        self.change(&mut changed, absent)?;
        *rig = changed;
        Ok(())
    }

    fn change(&self, rig: &mut Rig, absent: &[String]) -> Result<(), ConfigError> {
        for (name, values) in self.sensors.iter().filter(|(name, _)| !absent.contains(name)) {
            if let Some(radar) = rig.radars.iter_mut().find(|radar| radar.name == *name) {
                values.apply_to_radar(radar).map_err(|expected| invalid(name, expected))?;
            } else if let Some(lidar) = rig.lidars.iter_mut().find(|lidar| lidar.name == *name) {
                values.apply_to_lidar(lidar).map_err(|expected| invalid(name, expected))?;
            } else {
                let names = rig.radars.iter().map(|radar| &radar.name);
                let names: Vec<_> =
                    names.chain(rig.lidars.iter().map(|lidar| &lidar.name)).cloned().collect();
                return Err(invalid(name, format!("one of the recording's sensors {}", names.join(", "))));
            }
        }
        Ok(())
    }
}

fn invalid(sensor: &str, expected: String) -> ConfigError {
    ConfigError::Value { key: format!("sensors.{sensor}"), expected }
}

fn replace(target: &mut f64, value: Option<f64>) {
    if let Some(value) = value {
        *target = value;
    }
}

impl SensorOverride {
    fn apply_to_radar(&self, radar: &mut Radar) -> Result<(), String> {
        if self.lowest_beam_deg.is_some() || self.max_range_m.is_some() {
            return Err("no LiDAR values, for it is a radar".into());
        }
        replace(&mut radar.sigma_range, self.sigma_range_m);
        replace(&mut radar.sigma_azimuth, self.sigma_azimuth_deg.map(f64::to_radians));
        replace(&mut radar.sigma_elevation, self.sigma_elevation_deg.map(f64::to_radians));
        replace(&mut radar.fov_azimuth, self.fov_azimuth_deg.map(f64::to_radians));
        replace(&mut radar.fov_elevation, self.fov_elevation_deg.map(f64::to_radians));
        if let Some(table) = &self.reliability {
            let rows = table.iter().map(|[azimuth, value]| (azimuth.to_radians(), *value));
            radar.reliability = Reliability::new(rows.collect())?;
        }
        radar.check()
    }

    fn apply_to_lidar(&self, lidar: &mut Lidar) -> Result<(), String> {
        let of_radars =
            [self.sigma_azimuth_deg, self.sigma_elevation_deg, self.fov_azimuth_deg, self.fov_elevation_deg];
        if of_radars.iter().any(Option::is_some) || self.reliability.is_some() {
            return Err("no radar values, for it is a LiDAR".into());
        }
        replace(&mut lidar.sigma_range, self.sigma_range_m);
        replace(&mut lidar.lowest_beam, self.lowest_beam_deg.map(f64::to_radians));
        lidar.max_range = self.max_range_m.or(lidar.max_range);
        lidar.check()
    }
}
