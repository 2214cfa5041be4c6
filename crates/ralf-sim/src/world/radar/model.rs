//! A radar as it really is, and how waves meet the world.

use crate::world::terrain::Surface;
use ralf::space::Transform;

/// A radar.
#[derive(Debug, Clone)]
pub(crate) struct RadarModel {
    pub(crate) name: String,
    /// Where it really sits.
    pub(crate) vehicle_from_radar: Transform,
    /// Whether it measures elevation.
    pub(crate) elevation: bool,
    /// Full fields of view in azimuth and elevation, rad.
    pub(crate) fov: [f64; 2],
    /// Between scans, ns.
    pub(crate) period_ns: i64,
    /// The first scan after the start, ns.
    pub(crate) first_ns: i64,
    /// What its clock is ahead of the true time, ns.
    pub(crate) clock_ns: i64,
    /// Signal to noise of 0 dBsm at 10 m on boresight, dB.
    pub(crate) sensitivity_db: f64,
    /// m.
    pub(crate) max_range: f64,
    pub(crate) cell: Cell,
    /// Within so many cells of a stronger echo there is no peak of its own.
    pub(crate) grouping: f64,
    /// Standard deviation at 20 dB as a share of the cell.
    pub(crate) accuracy: f64,
    /// Above the floor, dB.
    pub(crate) threshold_db: f64,
    /// Width of the unambiguous interval of range rates, m/s.
    pub(crate) doppler_interval: f64,
    /// How often the next interval is taken near the threshold.
    pub(crate) doppler_failure: f64,
    /// Side lobes lie so far below the main one, dB.
    pub(crate) side_lobe_db: f64,
    /// Peaks of the angle's spectrum down to so far below the highest are taken for things of their own, dB.
    pub(crate) accepted_db: f64,
    /// How often an angle is taken for another near the threshold.
    pub(crate) angle_failure: f64,
    /// By how much its sine is off then.
    pub(crate) ambiguity: f64,
    /// Detections that a scan has room for.
    pub(crate) room: usize,
    /// Which are kept where there are more.
    pub(crate) keeps: Keeps,
    /// Smaller cross-sections are left out, dBsm.
    pub(crate) least_rcs_db: f64,
    /// False alarms in a scan.
    pub(crate) false_alarms: f64,
    /// What its cross-sections are off, dB.
    pub(crate) rcs_offset_db: f64,
    /// Names of the columns that follow x, y, z.
    pub(crate) amplitudes: Vec<Amplitude>,
}

/// Which detections a radar keeps that finds more than it has room for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Keeps {
    /// Those that rise highest above the floor.
    Clearest,
    /// The list is filled from the nearest on.
    Nearest,
    /// Those of the largest cross-section.
    Largest,
}

/// What a radar tells of an echo's strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Amplitude {
    /// dBsm.
    Rcs,
    /// Above noise, dB.
    Snr,
    /// dB of something.
    Power,
}

impl Amplitude {
    /// The column's name.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Rcs => "rcs",
            Self::Snr => "snr",
            Self::Power => "power",
        }
    }
}

/// What a radar can't tell apart.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell {
    /// m.
    pub(crate) range: f64,
    /// rad.
    pub(crate) azimuth: f64,
    /// rad.
    pub(crate) elevation: f64,
    /// m/s.
    pub(crate) doppler: f64,
}

/// How spiky the ground of a world is.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Spikiness {
    /// What they add to the ground's backscatter, dB (m2 per m2).
    pub(crate) mean_db: f64,
    /// Scale of their texture's gamma distribution, dBsm.
    pub(crate) scale_db: f64,
    /// Share that belongs to the place.
    pub(crate) staying: f64,
    /// From here on unevenness hides some of them, m.
    pub(crate) shadow: f64,
    /// Share that is left on grass.
    pub(crate) on_grass: f64,
}

/// How waves meet a world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Waves {
    /// Backscatter of asphalt at 10 degrees of grazing, dB.
    pub(crate) asphalt_db: f64,
    /// Backscatter of grass beyond asphalt's, dB.
    pub(crate) grass_db: f64,
    /// Spread of the ground's backscatter from place to place, dB.
    pub(crate) texture_db: f64,
    /// How often a square metre of road has a manhole, a joint or a stud in it, and what that is worth, dB.
    pub(crate) lumps: [f64; 2],
    /// What is heard of the ground seldom and strongly.
    pub(crate) spikes: Spikiness,
    /// What a facade takes from a mirrored wave, one way, dB.
    pub(crate) mirror_loss_db: f64,
    /// Heights of mirrors, as a share of what is usual of their material.
    pub(crate) mirror_heights: f64,
    /// What corners and edges send aside less than back, dB.
    pub(crate) aside_db: f64,
    /// Cross-section of the own front to a wave that comes back, dBsm.
    pub(crate) own_front_db: f64,
    /// How often a low part of a vehicle sends a wave under the floor.
    pub(crate) floor: f64,
    /// How much longer the way is there on average, m.
    pub(crate) floor_way: f64,
    /// How often a thing is seen mirrored in the road.
    pub(crate) road_mirror: f64,
    /// What a window takes, there and back, dB.
    pub(crate) window_loss_db: f64,
    /// What leaves take per metre, there and back, dB.
    pub(crate) leaf_loss_db: f64,
    /// Added to every cross-section, dB.
    pub(crate) strength_db: f64,
    /// Share of scans with a burst of interference.
    pub(crate) interference: f64,
    /// Returns of the own bumper.
    pub(crate) bumper: usize,
    /// Whether it rains.
    pub(crate) rain: bool,
}

impl Waves {
    /// Backscatter of a surface beyond asphalt's, dB. Gravel is rough for waves of 4 mm (Ulaby and Dobson 1989).
    pub(super) fn roughness_db(&self, surface: Surface) -> f64 {
        match surface {
            Surface::Asphalt => 0.0,
            Surface::Pavement => 3.0,
            Surface::Gravel => 8.0,
            Surface::Grass => self.grass_db,
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::world::radar::sensitivity_db;

    /// A radar without any chance in it.
    pub(in crate::world::radar) fn radar() -> RadarModel {
        RadarModel {
            name: "radar_front".into(),
            vehicle_from_radar: Transform::translation(3.6, 0.0, 0.5),
            elevation: true,
            fov: [2.6, 0.5],
            period_ns: 50_000_000,
            first_ns: 0,
            clock_ns: 0,
            sensitivity_db: sensitivity_db(100.0),
            max_range: 100.0,
            cell: Cell { range: 0.3, azimuth: 0.03, elevation: 0.08, doppler: 0.1 },
            grouping: 1.0,
            accuracy: 0.2,
            threshold_db: 12.0,
            doppler_interval: 100.0,
            doppler_failure: 0.0,
            side_lobe_db: 20.0,
            accepted_db: 15.0,
            angle_failure: 0.0,
            ambiguity: 0.4,
            room: 500,
            keeps: Keeps::Clearest,
            least_rcs_db: -99.0,
            false_alarms: 0.0,
            rcs_offset_db: 0.0,
            amplitudes: vec![Amplitude::Rcs],
        }
    }

    /// Waves of a usual world.
    pub(in crate::world::radar) fn waves() -> Waves {
        Waves {
            asphalt_db: -25.0,
            texture_db: 5.0,
            lumps: [0.01, 14.0],
            spikes: Spikiness { mean_db: -99.0, scale_db: -10.0, staying: 0.5, shadow: 25.0, on_grass: 0.1 },
            grass_db: 7.0,
            mirror_loss_db: 4.0,
            mirror_heights: 1.0,
            aside_db: 12.0,
            own_front_db: 8.0,
            floor: 0.0,
            floor_way: 2.0,
            road_mirror: 0.0,
            window_loss_db: 8.0,
            leaf_loss_db: 3.0,
            strength_db: 0.0,
            interference: 0.0,
            bumper: 0,
            rain: false,
        }
    }
}
