//! The paper's method, for one radar scan.

use super::blind_spot::in_blind_spot;
use super::fusion::{optical, prioritize};
use super::{camera, lidar, tracking};
use crate::config::{Config, ConfigError};
use crate::label::flag;
use crate::scene::{Frame, plausibility};

/// What the method says of one detection. `None` is *not observed*, which is something else than implausible.
///
/// Mismatches `d` are distances in standard deviations of the measurements (equations 1 to 4), 0 where they meet.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DetectionLabel {
    /// Mean mismatch with the nearest LiDAR points, at most `lidar.max_mismatch`; `None` on the floor, too.
    pub d_lm: Option<f64>,
    /// Mean mismatch with the nearest points of the cameras' scaled depth, at most `camera.max_mismatch`; `None` on the
    /// floor, too.
    pub d_cm: Option<f64>,
    /// Weighted mismatch with the neighbouring radar scans, at most `tracking.max_mismatch`.
    pub d_tr: Option<f64>,
    /// `exp(-beta_lm d_lm)`, in [0, 1]; 0 on the floor.
    pub w_lm: Option<f64>,
    /// `exp(-beta_cm d_cm)`, in [0, 1]; 0 on the floor.
    pub w_cm: Option<f64>,
    /// `exp(-beta_tr d_tr)`, in [0, 1].
    pub w_tr: Option<f64>,
    /// What LiDAR and cameras say together, in [0, 1] (equation 6).
    pub w_opt: Option<f64>,
    /// The plausibility, in [0, 1]; 0 where nothing was observed.
    pub w: f64,
    /// `w >= fusion.threshold`, and, where the paper's method answers, not on the floor.
    pub plausible: bool,
    /// Bits of [`flag`].
    pub flags: u16,
    /// SemanticKITTI id of the LiDAR points around, where they carry one.
    pub semantic: Option<u16>,
}

/// Labels radar scans with one set of settings.
#[derive(Debug, Clone, Copy)]
pub struct Labeler<'a> {
    config: &'a Config,
}

impl<'a> Labeler<'a> {
    /// A labeler with these settings.
    ///
    /// # Errors
    /// A setting out of its range ([`Config::check`]).
    pub fn new(config: &'a Config) -> Result<Self, ConfigError> {
        config.check()?;
        Ok(Self { config })
    }

    /// The plausibility and label of every detection of a frame, in the scan's order.
    ///
    /// This is the whole method. Equations, algorithm and figures are numbered as in the paper; `docs/method.md` states
    /// each step exactly.
    pub fn label(&self, frame: &Frame) -> Vec<DetectionLabel> {
        let Config { ground, lidar, camera, tracking, fusion, .. } = self.config;

        // Each branch gives the mismatch d (equations 1 to 4) of each detection with its nearest neighbours.
        // Branch I, LiDAR matching (algorithm 1): LiDAR points above the ground.
        let lidar_matches = lidar::match_detections(frame, lidar);
        // Branch I, camera matching (section 2.3): pixels of the scaled depth images.
        let camera_matches = camera::match_detections(frame, camera);
        // Branch II, tracking (equations 7 and 8): detections of the scans k - n_b .. k + n_b.
        let tracking_mismatches = tracking::match_detections(frame, tracking);

        let no_lidar = flag::when(lidar.enabled && frame.lidar.is_none(), flag::NO_LIDAR);
        let mut labels = Vec::with_capacity(frame.scan.len());
        for (i, detection) in frame.scan.detections.iter().enumerate() {
            let Some(detection) = detection else {
                labels.push(DetectionLabel { flags: flag::UNOBSERVED, ..Default::default() });
                continue;
            };

            // A detection on the floor is an artifact (section 2.3, LiDAR matching); tracking alone still says its
            // part.
            let on_floor = frame.is_on_floor(detection, ground);
            let lidar_match = lidar_matches[i].filter(|_| !on_floor);
            let d_lm = lidar_match.map(|found| found.d);
            let d_cm = camera_matches[i].d.filter(|_| !on_floor);
            let d_tr = tracking_mismatches[i];

            // Each branch's plausibility, exp(-beta d) (algorithm 1, its last line).
            let w_lm = if on_floor { Some(0.0) } else { d_lm.map(|d| plausibility(lidar.beta, d)) };
            let w_cm = if on_floor { Some(0.0) } else { d_cm.map(|d| plausibility(camera.beta, d)) };
            let w_tr = d_tr.map(|d| plausibility(tracking.beta, d));

            // In the LiDAR's blind spot (equation 5) the cameras answer, elsewhere the LiDAR (equation 6).
            let in_blind_spot = in_blind_spot(&frame.rig.lidars, &detection.position);
            let w_opt = optical(in_blind_spot, w_lm, w_cm);

            // alpha weighs the branches, gamma_s(phi) the sensor's mounting (figure 6), w_0 decides (equation 9).
            let gamma_s = frame.radar.reliability.at(frame.scan.measured.spherical[i].azimuth);
            let w = prioritize(fusion.alpha, w_opt, w_tr, gamma_s);
            let plausible = !on_floor && w.is_some_and(|w| w >= fusion.threshold);

            let flags = no_lidar
                | flag::when(tracking.enabled && d_tr.is_none(), flag::NO_NEIGHBOURS)
                | flag::when(on_floor, flag::GROUND)
                | flag::when(in_blind_spot, flag::BLIND_SPOT)
                | flag::when(camera_matches[i].in_failed_view, flag::CAMERA_FAILED)
                | flag::when(w.is_none(), flag::UNOBSERVED);
            let semantic = lidar_match.and_then(|found| found.semantic);
            let w = w.unwrap_or(0.0);
            let label =
                DetectionLabel { d_lm, d_cm, d_tr, w_lm, w_cm, w_tr, w_opt, w, plausible, flags, semantic };
            labels.push(label);
        }
        labels
    }
}
