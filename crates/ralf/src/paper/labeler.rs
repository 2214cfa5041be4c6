//! The whole method, for one radar scan.

use super::blind_spot::in_blind_spot;
use super::camera::{self, CameraMatch};
use super::evidence::{Evidence, Verdict, Weights};
use super::lidar::{self, LidarMatch};
use super::tracking;
use crate::config::Config;
use crate::label::flag;
use crate::scene::{Frame, LocalGround, Located};

/// What the method says of one detection. `None` is *not observed*, which is something else than implausible.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct DetectionLabel {
    /// Mean mismatch with the LiDAR's points.
    pub d_lm: Option<f64>,
    /// Mean mismatch with the cameras' points.
    pub d_cm: Option<f64>,
    /// Weighted mismatch with the neighbouring scans.
    pub d_tr: Option<f64>,
    /// `exp(-beta_lm d_lm)`.
    pub w_lm: Option<f64>,
    /// `exp(-beta_cm d_cm)`.
    pub w_cm: Option<f64>,
    /// `exp(-beta_tr d_tr)`.
    pub w_tr: Option<f64>,
    /// Of LiDAR and cameras together.
    pub w_opt: Option<f64>,
    /// The plausibility.
    pub w: f64,
    /// Whether the detection is plausible.
    pub plausible: bool,
    /// Bits of [`flag`].
    pub flags: u16,
    /// SemanticKITTI id of the LiDAR points around, where they carry one.
    pub semantic: Option<u16>,
}

/// Labels radar scans with one set of settings.
#[derive(Debug, Clone)]
pub struct Labeler<'a> {
    config: &'a Config,
}

impl<'a> Labeler<'a> {
    /// A labeler with these settings.
    pub fn new(config: &'a Config) -> Self {
        Self { config }
    }

    /// The plausibility and label of every detection of a frame, in the scan's order.
    pub fn label(&self, frame: &Frame) -> Vec<DetectionLabel> {
        let answers = self.ask(frame);
        let weights = Weights::of(self.config);
        let located = frame.detections.located.iter().enumerate();
        let label = |(i, detection): (usize, &Option<Located>)| match detection {
            Some(detection) => {
                let evidence = self.evidence_of(frame, i, detection, &answers);
                answers.label(i, &evidence, &evidence.weigh(&weights))
            }
            None => DetectionLabel { flags: flag::UNOBSERVED, ..Default::default() },
        };
        located.map(label).collect()
    }

    /// What is known of every detection of a frame before `alpha`, the `beta` and `w0` come in, in the scan's order.
    /// `None` for a detection whose coordinates are not finite: whatever the weights, it is not plausible.
    pub fn evidence(&self, frame: &Frame) -> Vec<Option<Evidence>> {
        let answers = self.ask(frame);
        let located = frame.detections.located.iter().enumerate();
        located.map(|(i, found)| Some(self.evidence_of(frame, i, found.as_ref()?, &answers))).collect()
    }

    /// Asks all branches.
    fn ask(&self, frame: &Frame) -> Answers {
        Answers {
            lidar: self.ask_lidar(frame),
            camera: self.ask_cameras(frame),
            tracking: self.ask_tracking(frame),
            absent: self.absent_branches(frame),
        }
    }

    /// What is known of one detection.
    fn evidence_of(&self, frame: &Frame, i: usize, detection: &Located, answers: &Answers) -> Evidence {
        let is_on =
            |local: &LocalGround| local.is_floor_detection(frame.radar, detection, &self.config.ground);
        let on_floor = frame.ground.as_ref().is_some_and(is_on);
        Evidence {
            d_lm: answers.lidar[i].map(|found| found.d).filter(|_| !on_floor),
            d_cm: answers.camera[i].d.filter(|_| !on_floor),
            d_tr: answers.tracking[i],
            on_floor,
            in_blind_spot: in_blind_spot(&frame.rig.lidars, &detection.position),
            gamma_s: frame.radar.reliability.at(frame.detections.scan.spherical[i].azimuth),
        }
    }

    /// What the LiDAR says of each detection.
    pub fn ask_lidar(&self, frame: &Frame) -> Vec<Option<LidarMatch>> {
        match &frame.lidar {
            Some(view) if self.config.lidar.enabled => {
                lidar::match_detections(frame.radar, &frame.detections, view, self.config.lidar.neighbours)
            }
            _ => vec![None; frame.detections.located.len()],
        }
    }

    fn ask_cameras(&self, frame: &Frame) -> Vec<CameraMatch> {
        camera::match_detections(frame.radar, &frame.detections, &frame.images, &self.config.camera)
    }

    /// What the neighbouring scans say of each detection.
    pub fn ask_tracking(&self, frame: &Frame) -> Vec<Option<f64>> {
        let Frame { radar, detections, doppler, .. } = frame;
        let steps = frame.steps_within(self.config.tracking.scans);
        tracking::match_detections(radar, detections, steps, doppler.as_deref(), &self.config.tracking)
    }

    /// Flags of enabled branches that have nothing to say on the whole scan.
    fn absent_branches(&self, frame: &Frame) -> u16 {
        flag::when(self.config.lidar.enabled && frame.lidar.is_none(), flag::NO_LIDAR)
            | flag::when(self.config.tracking.enabled && frame.steps.is_empty(), flag::NO_NEIGHBOURS)
    }
}

/// What each branch says of a scan: one entry per detection.
struct Answers {
    lidar: Vec<Option<LidarMatch>>,
    camera: Vec<CameraMatch>,
    tracking: Vec<Option<f64>>,
    /// Flags of the branches that say nothing of the whole scan.
    absent: u16,
}

impl Answers {
    /// All that is told of one detection.
    fn label(&self, i: usize, evidence: &Evidence, verdict: &Verdict) -> DetectionLabel {
        let Evidence { d_lm, d_cm, d_tr, on_floor, in_blind_spot, .. } = *evidence;
        let Verdict { w_lm, w_cm, w_tr, w_opt, w, plausible } = *verdict;
        DetectionLabel {
            d_lm,
            d_cm,
            d_tr,
            w_lm,
            w_cm,
            w_tr,
            w_opt,
            w: w.unwrap_or(0.0),
            plausible,
            flags: self.absent
                | flag::when(on_floor, flag::GROUND)
                | flag::when(in_blind_spot, flag::BLIND_SPOT)
                | flag::when(self.camera[i].in_failed_view, flag::CAMERA_FAILED)
                | flag::when(w.is_none(), flag::UNOBSERVED),
            semantic: self.lidar[i].filter(|_| !on_floor).and_then(|found| found.semantic),
        }
    }
}
