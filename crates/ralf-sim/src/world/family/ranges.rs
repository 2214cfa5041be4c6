//! What a family says of its worlds.

use crate::world::lidar::Pattern;
use crate::world::radar::Keeps;
use crate::world::span::Span;

/// A family of worlds: ranges of everything that differs between recordings.
#[derive(Debug)]
pub struct Family {
    /// For the command line.
    pub name: &'static str,
    /// In one sentence.
    pub about: &'static str,
    pub(crate) radars: RadarRanges,
    pub(crate) waves: WaveRanges,
    pub(crate) lidars: LidarRanges,
    /// With how likely each is.
    pub(crate) places: &'static [(PlaceKind, f64)],
    pub(crate) motion: MotionRanges,
    pub(crate) calibration: CalibrationRanges,
}

/// Where a sensor sits.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mount {
    pub(crate) name: &'static str,
    /// In the vehicle's frame, m.
    pub(crate) place: [f64; 3],
    /// About the vertical, degrees.
    pub(crate) yaw_deg: f64,
}

/// A sensor of this name at a place in the vehicle's frame (m), turned by a yaw (degrees).
pub(crate) const fn mount(name: &'static str, place: [f64; 3], yaw_deg: f64) -> Mount {
    Mount { name, place, yaw_deg }
}

/// A LiDAR in its place.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MountedLidar {
    pub(crate) mount: Mount,
    pub(crate) pattern: Pattern,
}

/// Radars.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RadarRanges {
    /// Sets of mountings.
    pub(crate) layouts: &'static [&'static [Mount]],
    /// How likely they measure elevation.
    pub(crate) elevation: f64,
    /// Full field of view, degrees.
    pub(crate) fov_azimuth: Span,
    /// Full field of view, degrees.
    pub(crate) fov_elevation: Span,
    /// Scans per second.
    pub(crate) rate: Span,
    /// Where 10 dBsm on boresight are 13 dB above noise, m.
    pub(crate) car_range: Span,
    /// Farthest range that is processed, m.
    pub(crate) max_range: Span,
    /// Size of a resolution cell: m.
    pub(crate) range_cell: Span,
    /// Degrees.
    pub(crate) azimuth_cell: Span,
    /// Degrees.
    pub(crate) elevation_cell: Span,
    /// m/s.
    pub(crate) doppler_cell: Span,
    /// Within so many cells of a stronger echo there is no peak of its own.
    pub(crate) grouping: Span,
    /// Standard deviation at 20 dB, as a share of the cell.
    pub(crate) accuracy: Span,
    /// Above the floor, dB.
    pub(crate) threshold: Span,
    /// Width of the unambiguous interval of range rates, m/s.
    pub(crate) doppler_interval: Span,
    /// How often the ambiguity is resolved wrongly near the threshold.
    pub(crate) doppler_failure: Span,
    /// Level of the highest side lobe below the main one (two-way), dB.
    pub(crate) side_lobe: Span,
    /// Peaks of the angle's spectrum so far above the highest side lobe are taken for things of their own, dB.
    pub(crate) accepted: Span,
    /// How often an angle is taken for another, near the threshold.
    pub(crate) angle_failure: Span,
    /// Detections that a scan has room for.
    pub(crate) room: Span,
    /// Which are kept where there are more, with how likely each is.
    pub(crate) keeps: &'static [(Keeps, f64)],
    /// Smaller cross-sections are left out, dBsm.
    pub(crate) least_rcs: Span,
    /// False alarms in a scan.
    pub(crate) false_alarms: Span,
}

/// How waves meet the world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct WaveRanges {
    /// Backscatter of asphalt at 10 degrees of grazing, dB (m2 per m2).
    pub(crate) asphalt: Span,
    /// Spread of the ground's backscatter from place to place, dB.
    pub(crate) texture: Span,
    /// How often a square metre of road has a manhole, a joint or a stud in it.
    pub(crate) lumps: Span,
    /// What that is worth, dB.
    pub(crate) lump_strength: Span,
    /// What spikes add to the ground's backscatter, dB (m2 per m2).
    pub(crate) spike_mean: Span,
    /// Cross-section of a spike, dBsm: the larger, the fewer there are.
    pub(crate) spike_scale: Span,
    /// Share of the spikes that belong to the place.
    pub(crate) spikes_stay: Span,
    /// From here on unevenness hides some of them, m.
    pub(crate) spikes_shadow: Span,
    /// Share of the spikes that are left on grass.
    pub(crate) spikes_on_grass: Span,
    /// Backscatter of grass beyond asphalt's, dB.
    pub(crate) grass: Span,
    /// What a facade takes from a mirrored wave, one way, dB.
    pub(crate) mirror_loss: Span,
    /// Heights of mirrors, as a share of what is usual of their material.
    pub(crate) mirror_heights: Span,
    /// What corners and edges send aside less than back, dB.
    pub(crate) aside: Span,
    /// Cross-section of the own front to a wave that comes back, dBsm.
    pub(crate) own_front: Span,
    /// How often a low part of a vehicle sends a wave under the floor.
    pub(crate) floor: Span,
    /// How much longer the way is there on average, m.
    pub(crate) floor_way: Span,
    /// How often a thing is seen mirrored in the road.
    pub(crate) road_mirror: Span,
    /// What a window or door takes, there and back, dB.
    pub(crate) window_loss: Span,
    /// What leaves take per metre, there and back, dB.
    pub(crate) leaf_loss: Span,
    /// Added to every cross-section, dB.
    pub(crate) strength: Span,
    /// Share of scans with a burst of interference.
    pub(crate) interference: Span,
    /// Returns of the own bumper.
    pub(crate) bumper: Span,
    /// How likely a sequence is driven in rain.
    pub(crate) rain: f64,
}

/// LiDARs.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LidarRanges {
    /// Sets of LiDARs.
    pub(crate) layouts: &'static [&'static [MountedLidar]],
    /// Revolutions per second.
    pub(crate) rate: Span,
    /// Standard deviation of a range, m.
    pub(crate) sigma: Span,
    /// Share of rays that are lost for no reason.
    pub(crate) lost: Span,
    /// How likely points are moved to the scan's time as if the world stood still; else they are at it.
    pub(crate) rolling: f64,
    /// Share of glass that lets a ray through.
    pub(crate) glass: Span,
}

/// Where a sequence is driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum PlaceKind {
    Street,
    Crossing,
    Residential,
    CarPark,
    Industrial,
    Motorway,
    Tunnel,
    Country,
}

/// The own vehicle and others.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MotionRanges {
    /// Share of what is usual for the place.
    pub(crate) speed: Span,
    /// How likely the vehicle stands for the whole sequence.
    pub(crate) standing: f64,
    /// How likely it reverses.
    pub(crate) reversing: f64,
    /// Share of the usual number of moving things.
    pub(crate) traffic: Span,
    /// People on foot and on bicycles, of what is usual for the place.
    pub(crate) crowd: Span,
    /// Steepest slope, degrees.
    pub(crate) slope: Span,
}

/// What the recording says wrongly.
#[derive(Debug, Clone, Copy)]
pub(crate) struct CalibrationRanges {
    /// Largest error of each angle of a mounting, degrees.
    pub(crate) angle: Span,
    /// Largest error along each axis, m.
    pub(crate) place: Span,
    /// Largest error of a radar's clock, ms.
    pub(crate) clock: Span,
    /// Relative error of the declared standard deviations.
    pub(crate) sigmas: Span,
    /// Relative error of the wheels' speed.
    pub(crate) wheels: Span,
    /// How likely there are 6-DoF poses beside odometry.
    pub(crate) poses: f64,
    /// Their drift per metre.
    pub(crate) drift: Span,
}
