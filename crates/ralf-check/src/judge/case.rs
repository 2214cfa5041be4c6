//! What is known of a sequence while it is judged.

use super::alternatives::elsewhere;
use crate::change::{SensorChange, used_motion};
use crate::doppler::{DopplerFigures, Timed, compare, fits, predicted};
use crate::overlap::{Measure, Setup, Tally, overlap};
use crate::sample::{LidarLook, Sample};
use crate::velocity_fit::TRUSTED;
use crate::verdict::RadarFigures;
use ralf::sensors::Sequence;
use ralf::space::EgoMotion;
use ralf::space::Transform;

/// A radar's Doppler is trusted in so many scans: the error of their median is then a third of a single one's.
pub(super) const SCANS: usize = 10;

/// Whether so many scans tell so much.
pub(super) fn is_trusted(figures: &DopplerFigures) -> bool {
    figures.scans >= SCANS && figures.inliers >= TRUSTED
}

/// A sequence under judgement.
pub(super) struct Case<'a> {
    pub(super) sequence: &'a Sequence,
    pub(super) sample: &'a Sample,
    /// The motion that labels rest on, with what was found wrong put right.
    pub(super) motion: EgoMotion,
    /// Velocities of each radar, by its range rates; signs and units put right.
    pub(super) fits: Vec<Vec<Timed>>,
    /// What was found wrong of each radar and each LiDAR.
    pub(super) radar_changes: Vec<SensorChange>,
    pub(super) lidar_changes: Vec<SensorChange>,
    /// LiDAR scans of LiDARs that are fit.
    pub(super) lidars: Vec<&'a LidarLook>,
    unfit: Vec<String>,
}

impl<'a> Case<'a> {
    pub(super) fn new(sequence: &'a Sequence, sample: &'a Sample, unfit: Vec<String>) -> Self {
        let rig = &sequence.rig;
        let is_fit = |look: &&LidarLook| !unfit.contains(&rig.lidars[look.lidar].name);
        let one = |(radar, looks): (usize, &Vec<_>)| {
            if unfit.contains(&rig.radars[radar].name) { Vec::new() } else { fits(looks) }
        };
        Self {
            sequence,
            sample,
            motion: used_motion(&sequence.motion),
            fits: sample.radars.iter().enumerate().map(one).collect(),
            radar_changes: vec![SensorChange::default(); rig.radars.len()],
            lidar_changes: vec![SensorChange::default(); rig.lidars.len()],
            lidars: sample.lidars.iter().filter(is_fit).collect(),
            unfit,
        }
    }

    /// The radars whose positions can be used.
    pub(super) fn radars(&self) -> impl Iterator<Item = usize> + use<'_> {
        let radars = self.sequence.rig.radars.iter().enumerate();
        radars.filter(|(_, radar)| self.is_fit(&radar.name)).map(|(radar, _)| radar)
    }

    /// The cameras that look where it is known.
    pub(super) fn cameras(&self) -> impl Iterator<Item = usize> + use<'_> {
        let cameras = self.sequence.rig.cameras.iter().enumerate();
        cameras.filter(|(_, camera)| self.is_fit(&camera.name)).map(|(camera, _)| camera)
    }

    fn is_fit(&self, name: &str) -> bool {
        self.unfit.iter().all(|unfit| unfit != name)
    }

    /// Nothing else is asked of a radar whose positions can't be used, and that no setting puts right.
    pub(super) fn leave_out(&mut self, radar: usize) {
        self.unfit.push(self.name(radar).to_owned());
    }

    pub(super) fn name(&self, radar: usize) -> &'a str {
        &self.sequence.rig.radars[radar].name
    }

    /// A radar's mounting with what was found.
    pub(super) fn mount(&self, radar: usize) -> Transform {
        self.radar_changes[radar].mount(&self.sequence.rig.radars[radar].vehicle_from_radar)
    }

    /// How a radar's range rates go with a motion and a mounting, where this can be judged.
    pub(super) fn doppler(
        &self,
        radar: usize,
        motion: &EgoMotion,
        mount: &Transform,
    ) -> Option<DopplerFigures> {
        compare(&self.fits[radar], motion, mount).filter(is_trusted)
    }

    /// A radar's overlap with the LiDARs under a change, besides those that were found.
    pub(super) fn overlap(&self, radar: usize, change: &SensorChange, measure: Measure) -> Tally {
        let change = self.radar_changes[radar].and(change);
        overlap(&self.setup(), radar, &self.sample.radars[radar], &change, measure)
    }

    /// The same where the radar looks at something else.
    pub(super) fn elsewhere(&self, radar: usize) -> Tally {
        let turned = elsewhere().map(|turn| self.overlap(radar, &turn, Measure::Beside));
        turned.fold(Tally::default(), Tally::joined)
    }

    pub(super) fn setup(&self) -> Setup<'_> {
        Setup {
            rig: &self.sequence.rig,
            motion: &self.motion,
            lidars: &self.lidars,
            lidar_changes: &self.lidar_changes,
        }
    }

    /// The motion first, then the sensors in the order of the rig.
    pub(super) fn rank(&self, subject: &str) -> usize {
        let mut names = ["motion"].into_iter().chain(self.sequence.rig.names());
        names.position(|name| name == subject).unwrap_or(usize::MAX)
    }

    /// What pictures show, as recorded.
    pub(super) fn figures(&self) -> Vec<RadarFigures> {
        let recorded = used_motion(&self.sequence.motion);
        let first = self.sequence.times.radars.iter().flatten().min().copied().unwrap_or(0);
        let one = |radar: usize| {
            let mount = self.sequence.rig.radars[radar].vehicle_from_radar;
            let velocity = |timed: &Timed| {
                let (seen, told) = (timed.fit.velocity, predicted(&recorded, &mount, timed.t_ns));
                [(timed.t_ns - first) as f64 * 1e-9, seen.x, seen.y, told.x, told.y]
            };
            let setup = Setup { motion: &recorded, lidar_changes: &[], ..self.setup() };
            let looks = &self.sample.radars[radar];
            let share =
                |change: SensorChange| overlap(&setup, radar, looks, &change, Measure::Beside).share();
            let yaws = (-10..=10).map(f64::from).map(|yaw| [yaw, share(SensorChange::yaw(yaw))]);
            let clocks = (-8..=8).map(|i| f64::from(i) * 50.0).map(|ms| [ms, share(SensorChange::clock(ms))]);
            RadarFigures {
                name: self.name(radar).to_owned(),
                velocities: self.fits[radar].iter().map(velocity).collect(),
                by_yaw: yaws.collect(),
                by_clock: clocks.collect(),
            }
        };
        (0..self.sequence.rig.radars.len()).map(one).collect()
    }
}
