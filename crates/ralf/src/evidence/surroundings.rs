//! A frame with what several pieces of evidence need of it, each worked out once.

use super::probe::{Probe, probes};
use crate::config::Config;
use crate::scene::{Frame, NeighbouringDetections};
use std::cell::OnceCell;

/// A frame, the settings, and what several pieces of evidence need: worked out where a piece first asks for it.
pub struct Surroundings<'a> {
    /// One radar scan with what is known around it.
    pub frame: &'a Frame<'a>,
    /// All settings.
    pub config: &'a Config,
    neighbours: OnceCell<NeighbouringDetections>,
    probes: OnceCell<Vec<Option<Probe>>>,
}

impl<'a> Surroundings<'a> {
    /// What can be told of a frame.
    pub fn new(frame: &'a Frame<'a>, config: &'a Config) -> Self {
        Self { frame, config, neighbours: OnceCell::new(), probes: OnceCell::new() }
    }

    /// The detections of all radars around the scan, in its frame.
    pub fn neighbours(&self) -> &NeighbouringDetections {
        self.neighbours.get_or_init(|| NeighbouringDetections::around(self.frame))
    }

    /// The scan's detections in the vehicle frame of its LiDAR window, `None` for those without a position; no entry
    /// at all without a window.
    pub fn probes(&self) -> &[Option<Probe>] {
        self.probes.get_or_init(|| probes(self.frame))
    }
}
