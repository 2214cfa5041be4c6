//! The usual ranges, from which families differ. Where a range comes from stands beside it; *chosen* is nobody's
//! measurement, but wide enough for what is said of such sensors and places.
//!
//! Measured means: on the recordings that the readers' tests use (nuScenes scene-0061, a frame of View-of-Delft, 20
//! frames of aiMotive).

use super::mounts::{CORNERS, ROOF_32, ROOF_40, ROOF_64, SIDES};
use super::ranges::{CalibrationRanges, LidarRanges, MotionRanges, RadarRanges, WaveRanges};
use crate::world::radar::Keeps;
use crate::world::span::span;

/// A 4D radar with a wide view, as in the paper: some 300 detections in a scan.
pub(super) const RADARS: RadarRanges = RadarRanges {
    layouts: &[SIDES, CORNERS],
    elevation: 1.0,
    // 160 degrees in the paper's kind; View-of-Delft's detections reach from -32 to 47 (5 to 95 %).
    fov_azimuth: span(120.0, 160.0),
    // Measured, View-of-Delft: 5 to 95 % of the elevations lie in -8 .. 7 degrees.
    fov_elevation: span(16.0, 30.0),
    // 13 Hz in nuScenes and View-of-Delft, 18 in aiMotive, 20 in the paper.
    rate: span(12.0, 20.0),
    // A car of 10 dBsm is seen up to so far (data sheets: corner radars 70 to 100 m, mid-range ones 160 m, imaging ones
    // 250 m and more).
    car_range: span(80.0, 200.0),
    max_range: span(60.0, 130.0),
    // c / (2 B): 0.15 m at 1 GHz, 0.5 m at 300 MHz.
    range_cell: span(0.15, 0.5),
    // Data sheets of imaging radars: 1 to 2 degrees; of corner radars 3 to 6.
    azimuth_cell: span(1.2, 3.5),
    elevation_cell: span(3.0, 7.0),
    // Wavelength / (2 T): 0.1 m/s for a burst of 20 ms.
    doppler_cell: span(0.08, 0.25),
    // A Hann window widens a peak to 1.5 to 2 cells (Harris 1978); radars keep peaks alone, or most of what rises.
    grouping: span(1.0, 2.5),
    // Cramer-Rao: cell / sqrt(SNR) or so, and no better than a tenth.
    accuracy: span(0.15, 0.35),
    // Measured, aiMotive: the least SNR is 14.2 dB. Data sheets of radar chips: 10 to 15.
    threshold: span(10.0, 15.0),
    // Wider than any closing speed: chirps of several repetition times.
    doppler_interval: span(80.0, 140.0),
    doppler_failure: span(0.0, 0.05),
    // The pattern of a virtual array, there and back: 13 dB if it is filled evenly, 20 to 30 if it is tapered (Harris
    // 1978); errors of calibration raise the latter.
    side_lobe: span(13.0, 25.0),
    // Chosen: who builds a radar knows its lobes, and takes for another thing in the same cell of range and range rate
    // what stands above them.
    accepted: span(1.0, 7.0),
    angle_failure: span(0.02, 0.15),
    // 1,216 in four radars in the paper's recordings.
    room: span(250.0, 500.0),
    // Measured, nuScenes, View-of-Delft and aiMotive: the smallest cross-sections of a scan are the same within 5 dB
    // from 15 m to 80 m and beyond, as if the largest were kept. How many radars do otherwise is chosen.
    keeps: &[(Keeps::Clearest, 0.25), (Keeps::Nearest, 0.1), (Keeps::Largest, 0.65)],
    // Measured, View-of-Delft: 5 % lie below -24 dBsm from 15 to 60 m, and below -42 nearer than 10 m; nuScenes: -4.5.
    least_rcs: span(-36.0, -6.0),
    // Measured, nuScenes, View-of-Delft and aiMotive (`scripts/false_alarms.py`): 1 to 3 detections of a scan move, lie
    // far from the LiDAR's points, are weak and never seen again: 1 to 2 % of all. Radars that hand on what a low
    // threshold lets pass have more: how many is chosen.
    false_alarms: span(0.5, 150.0),
};

/// Waves in a town.
pub(super) const WAVES: WaveRanges = WaveRanges {
    // W-band backscatter of asphalt at 5 to 20 degrees of grazing: -30 to -15 dB (Ulaby and Dobson 1989; Sarabandi et
    // al. 1997).
    asphalt: span(-30.0, -18.0),
    // K-distributed and worse near the ground: chosen.
    texture: span(4.0, 7.5),
    // Manholes, gratings, joints, studs: one in 20 to 200 square metres; -15 to 0 dBsm (chosen).
    lumps: span(0.005, 0.05),
    lump_strength: span(10.0, 22.0),
    // Measured above the sensor's threshold, where what stands still lies far from every LiDAR point: nuScenes -17 dB
    // (some 40 detections of a scan, 2 to 7 dBsm in a sector of 5,000 square metres), aiMotive -31 (3 of 5 dBsm in
    // 10,000). How much more lies below the threshold, and nearer than where LiDAR sees nothing else, is chosen: up to
    // what leaves a fifth of the detections plausible, as in the paper's recordings, and down to hardly any.
    spike_mean: span(-40.0, -1.0),
    spike_scale: span(-7.0, 6.0),
    // Measured: what lies far from every LiDAR point is seen again in .11 (aiMotive) to .46 (nuScenes) of the scans.
    spikes_stay: span(0.0, 0.8),
    // What is left falls with the range as the grazing angle does: the lower a wave comes, the more lies in shadow
    // (Billingsley 2002). From where on is chosen: from a rough road to a smooth one with studs and joints.
    spikes_shadow: span(15.0, 90.0),
    // Blades are many in a cell, and even out; stalks, stones and tufts don't (chosen).
    spikes_on_grass: span(0.02, 0.4),
    // Grass is rough for waves of 4 mm (Ulaby and Dobson 1989), the more the higher and wetter it is.
    grass: span(4.0, 14.0),
    // Reflection of facades at 77 GHz: glass and metal 0 to 3 dB, plaster and brick 5 to 12 (chosen).
    mirror_loss: span(1.0, 8.0),
    // Chosen: from panes and paint everywhere to what is usual.
    mirror_heights: span(0.1, 1.2),
    // Ships lose 5 to 15 dB, some tens of degrees from the way back on (Ewell and Zehner 1980; Willis 1991); what is
    // round loses nothing.
    aside: span(0.0, 15.0),
    // Chosen: from a bumper of plastic to a plate of a square metre that looks ahead.
    own_front: span(3.0, 15.0),
    // Kopp et al. 2021 name it first of three causes of clutter on roads; how often is chosen.
    floor: span(0.1, 0.6),
    floor_way: span(1.5, 5.0),
    // Measured, View-of-Delft: 18 % of the detections lie below the road.
    road_mirror: span(0.0, 0.12),
    // Plain glass at 77 GHz takes 1 to 5 dB one-way, insulating glass up to 10, coated panes up to 30 (chosen).
    window_loss: span(0.0, 18.0),
    // Foliage at millimetre waves: 1 to 3 dB per metre one-way in full leaf (ITU-R P.833).
    leaf_loss: span(1.5, 6.0),
    // Chosen: the absolute calibration of a sensor's cross-sections is off by some dB.
    strength: span(-4.0, 4.0),
    interference: span(0.01, 0.1),
    bumper: span(0.0, 3.0),
    rain: 0.1,
};

/// A roof LiDAR.
pub(super) const LIDARS: LidarRanges = LidarRanges {
    layouts: &[ROOF_40, ROOF_64, ROOF_32],
    rate: span(10.0, 10.0),
    // Data sheets: 2 to 3 cm.
    sigma: span(0.01, 0.04),
    lost: span(0.0, 0.05),
    rolling: 0.5,
    // Uncoated glass passes some 90 % of 905 nm at right angles; sun protection less than half (chosen).
    glass: span(0.3, 0.9),
};

/// Town traffic.
pub(super) const MOTION: MotionRanges = MotionRanges {
    speed: span(0.5, 1.2),
    standing: 0.1,
    reversing: 0.05,
    traffic: span(0.3, 1.8),
    // Measured, View-of-Delft: nine people within 25 m ahead, 300 on a kilometre; how much fewer elsewhere is chosen.
    crowd: span(0.3, 5.0),
    slope: span(0.0, 3.0),
};

/// A careful workshop.
pub(super) const CALIBRATION: CalibrationRanges = CalibrationRanges {
    angle: span(0.05, 0.5),
    place: span(0.01, 0.05),
    clock: span(0.0, 20.0),
    sigmas: span(-0.2, 0.3),
    wheels: span(-0.01, 0.01),
    poses: 0.3,
    drift: span(0.0, 0.01),
};
