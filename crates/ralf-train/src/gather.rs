//! From frames to evidence: every mismatch that a search may ask for.

use super::table::Row;
use super::{EvidenceTable, Space};
use ralf::config::Config;
use ralf::paper::{Evidence, Labeler};
use ralf::scene::Frame;

/// A detection without a place: whatever the weights, it is not plausible.
const UNOBSERVED: Evidence =
    Evidence { d_lm: None, d_cm: None, d_tr: None, on_floor: false, in_blind_spot: false, gamma_s: 1.0 };

/// Asks the branches about frames, once for each `K` and each `n_b`.
#[derive(Debug, Clone)]
pub struct Gatherer {
    space: Space,
    /// With the longest batch.
    frames: Config,
    /// Without LiDAR and tracking: what depends on neither `K` nor `n_b`.
    rest: Config,
    /// Per `K`.
    lidar: Vec<Config>,
    /// Per `n_b`.
    tracking: Vec<Config>,
}

impl Gatherer {
    /// For all settings but those that are tuned.
    pub fn new(config: &Config, space: Space) -> Self {
        let changed = |change: &dyn Fn(&mut Config)| {
            let mut config = config.clone();
            change(&mut config);
            config
        };
        let longest = space.scans.iter().copied().max().unwrap_or(config.tracking.scans);
        let lidar = |k: &usize| changed(&|config| config.lidar.neighbours = *k);
        let tracking = |n_b: &usize| changed(&|config| config.tracking.scans = *n_b);
        Self {
            frames: changed(&|config| config.tracking.scans = longest),
            rest: changed(&|config| (config.lidar.enabled, config.tracking.enabled) = (false, false)),
            lidar: space.neighbours.iter().map(lidar).collect(),
            tracking: space.scans.iter().map(tracking).collect(),
            space,
        }
    }

    /// The settings with which frames must be gathered.
    pub fn frame_config(&self) -> &Config {
        &self.frames
    }

    /// A table for its scans.
    pub fn table(&self) -> EvidenceTable {
        EvidenceTable::new(self.space.clone())
    }

    /// Adds a scan to a table. `truth` says of each detection whether it is plausible; those of which it says nothing
    /// stay out.
    pub fn add(&self, table: &mut EvidenceTable, frame: &Frame, truth: &[Option<bool>]) {
        let rest = Labeler::new(&self.rest).evidence(frame);
        let lidar: Vec<_> = self.lidar.iter().map(|config| Labeler::new(config).ask_lidar(frame)).collect();
        let tracking: Vec<_> =
            self.tracking.iter().map(|config| Labeler::new(config).ask_tracking(frame)).collect();
        let row = |(i, plausible): (usize, &Option<bool>)| {
            let rest = rest[i].unwrap_or(UNOBSERVED);
            Some(Row {
                d_lm: lidar
                    .iter()
                    .map(|of_k| of_k[i].map(|found| found.d).filter(|_| !rest.on_floor))
                    .collect(),
                d_tr: tracking.iter().map(|of_n_b| of_n_b[i]).collect(),
                rest,
                plausible: (*plausible)?,
            })
        };
        table.push_scan(truth.iter().take(rest.len()).enumerate().filter_map(row));
    }
}
