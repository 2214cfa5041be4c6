//! From frames to mismatches: every one that a search may ask for.

use super::mismatches::DetectionMismatches;
use super::settings::Space;
use super::table::{MismatchTable, Row};
use ralf::config::{Config, ConfigError, LidarConfig, TrackingConfig};
use ralf::paper::{camera, in_blind_spot, lidar, tracking};
use ralf::scene::Frame;

/// Asks the branches about frames, once for each `K` and each `n_b`.
#[derive(Debug, Clone)]
pub struct Gatherer {
    space: Space,
    /// With the longest batch.
    config: Config,
    /// Per `K`.
    lidar: Vec<LidarConfig>,
    /// Per `n_b`.
    tracking: Vec<TrackingConfig>,
}

impl Gatherer {
    /// A gatherer for all settings but those that are tuned.
    ///
    /// # Errors
    /// A setting, or a value of the space, out of its range ([`Config::check`]).
    pub fn new(config: &Config, space: Space) -> Result<Self, ConfigError> {
        check(config, &space)?;
        let mut lidar = Vec::with_capacity(space.neighbours.len());
        for neighbours in space.neighbours.iter().copied() {
            lidar.push(LidarConfig { neighbours, ..config.lidar.clone() });
        }
        let mut tracking = Vec::with_capacity(space.scans.len());
        for scans in space.scans.iter().copied() {
            tracking.push(TrackingConfig { scans, ..config.tracking.clone() });
        }
        let mut config = config.clone();
        config.tracking.scans = space.scans.iter().copied().max().unwrap_or(config.tracking.scans);
        Ok(Self { space, config, lidar, tracking })
    }

    /// The settings with which frames must be gathered.
    pub fn frame_config(&self) -> &Config {
        &self.config
    }

    /// A table for its scans.
    pub fn table(&self) -> MismatchTable {
        MismatchTable::new(self.space.clone())
    }

    /// Adds a scan to a table. `truth` says of each detection whether it is plausible; those of which it says nothing
    /// stay out.
    pub fn add(&self, table: &mut MismatchTable, frame: &Frame, truth: &[Option<bool>]) {
        let camera = camera::match_detections(frame, &self.config.camera);
        let lidar: Vec<_> = self.lidar.iter().map(|config| lidar::match_detections(frame, config)).collect();
        let tracking: Vec<_> =
            self.tracking.iter().map(|config| tracking::match_detections(frame, config)).collect();
        let mut rows = Vec::new();
        for (i, (detection, plausible)) in frame.scan.detections.iter().zip(truth).enumerate() {
            let Some(plausible) = *plausible else { continue };
            let mut rest = DetectionMismatches::NOTHING;
            if let Some(detection) = detection {
                rest.on_floor = frame.is_on_floor(detection, &self.config.ground);
                rest.in_blind_spot = in_blind_spot(&frame.rig.lidars, &detection.position);
                rest.gamma_s = frame.radar.reliability.at(frame.scan.measured.spherical[i].azimuth);
                rest.d_cm = camera[i].d.filter(|_| !rest.on_floor);
            }
            let optical = |found: &Vec<Option<lidar::LidarMatch>>| found[i].map(|found| found.d);
            let d_lm = lidar.iter().map(|found| optical(found).filter(|_| !rest.on_floor)).collect();
            rows.push(Row { d_lm, d_tr: tracking.iter().map(|found| found[i]).collect(), rest, plausible });
        }
        table.push_scan(rows);
    }
}

/// Refuses what the settings must not have, with every value of a space in them.
fn check(config: &Config, space: &Space) -> Result<(), ConfigError> {
    let mut config = config.clone();
    config.check()?;
    for neighbours in space.neighbours.iter().copied() {
        config.lidar.neighbours = neighbours;
        config.check()?;
    }
    for scans in space.scans.iter().copied() {
        config.tracking.scans = scans;
        config.check()?;
    }
    Ok(())
}
