//! What a radar scan gives, with what surrounds it.

use super::Quantity;
use super::free_space::{Heights, RayFan};
use super::values::Values;
use ralf::scene::{Association, Detection, Frame, Strength, index_of};
use ralf::sensors::Elevation;
use ralf::space::{NeighborIndex, Point};

/// Neighbouring scans to each side that are asked whether a detection persists.
pub(super) const NEIGHBOURS: usize = 5;
/// Fewer of them, to both sides, say nothing.
const ENOUGH_NEIGHBOURS: usize = 4;
/// Detections of a scan that are looked at, evenly over its rows.
const DETECTIONS: usize = 2048;
/// Distances are cut here: what is farther is nowhere near, m.
const FARTHEST: f64 = 20.0;
/// A detection is there again within this, m, or within this share of its range.
const AGAIN: (f64, f64) = (1.0, 0.02);
/// Residuals below this may belong to what stands, m/s, and so many are needed.
const STANDING: (f64, usize) = (1.0, 8);
/// Heights above the ground at which a radar without elevation sees most of what it sees, m.
const USUAL_HEIGHTS: (f64, f64) = (0.3, 1.5);

/// The values of one scan.
pub(super) fn values(frame: &Frame) -> Values {
    let mut values = Values::default();
    values.push(Quantity::Detections, frame.scan.len() as f64);
    if frame.motion.is_known() {
        values.push(Quantity::Speed, frame.motion.twist(frame.scan.t_ns()).0.norm());
    }
    let rows: Vec<usize> =
        (0..frame.scan.len()).step_by(frame.scan.len().div_ceil(DETECTIONS).max(1)).collect();
    coordinates(frame, &rows, &mut values);
    amplitudes(frame, &rows, &mut values);
    range_rates(frame, &rows, &mut values);
    let located: Vec<&Detection> =
        rows.iter().filter_map(|row| frame.scan.detections[*row].as_ref()).collect();
    crowding(frame, &located, &mut values);
    let persistence = persistence(frame, &located);
    for share in persistence.iter().flatten() {
        values.push(Quantity::Persistence, *share);
    }
    surroundings(frame, &located, &persistence, &mut values);
    values
}

fn coordinates(frame: &Frame, rows: &[usize], values: &mut Values) {
    let measured = frame.radar.elevation == Elevation::Measured;
    for &row in rows {
        let found = &frame.scan.measured.spherical[row];
        values.push(Quantity::Range, found.range);
        values.push(Quantity::Azimuth, found.azimuth.to_degrees());
        if measured {
            values.push(Quantity::Elevation, found.elevation.to_degrees());
        }
        let located = frame.scan.detections[row].as_ref().filter(|_| measured);
        if let (Some(detection), Some(ground)) = (located, &frame.ground) {
            values.push(Quantity::Height, ground.height(&detection.position));
        }
    }
}

fn amplitudes(frame: &Frame, rows: &[usize], values: &mut Values) {
    let Some(strength) = Strength::new(frame.radar, &frame.scan.measured) else { return };
    let levels: Vec<f64> = rows.iter().map(|row| strength.cross_section[*row]).collect();
    let Some(median) = median(levels.clone()) else { return };
    for level in levels {
        values.push(Quantity::Amplitude, level - median);
    }
}

fn range_rates(frame: &Frame, rows: &[usize], values: &mut Values) {
    let told = frame.motion.is_known() || frame.radar.column("doppler_compensated").is_some();
    let Some(doppler) = frame.doppler().filter(|_| told) else { return };
    let residuals: Vec<f64> = rows.iter().map(|row| doppler.compensated[*row]).collect();
    for residual in &residuals {
        values.push(Quantity::DopplerResidual, *residual);
    }
    let small: Vec<f64> = residuals.iter().map(|rate| rate.abs()).filter(|rate| *rate < STANDING.0).collect();
    if small.len() >= STANDING.1 {
        values.push(Quantity::DopplerSpread, 1.4826 * median(small).unwrap_or(f64::NAN));
    }
}

/// The middle value of those that are numbers.
fn median(mut values: Vec<f64>) -> Option<f64> {
    values.retain(|value| value.is_finite());
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// How near the next detection of the scan is.
fn crowding(frame: &Frame, located: &[&Detection], values: &mut Values) {
    let index = index_of(located.iter().map(|detection| &detection.position), frame.radar.elevation);
    let mut association = Association::new(&index, frame.radar.elevation, 2);
    for detection in located {
        // The nearest is the detection itself.
        if let [_, next] = association.nearest(&detection.position) {
            values.push(Quantity::NearestDetection, f64::from(next.distance_squared).sqrt().min(FARTHEST));
        }
    }
}

/// The share of neighbouring scans with a detection where each one is; `None` where there are too few.
fn persistence(frame: &Frame, located: &[&Detection]) -> Vec<Option<f64>> {
    let steps = frame.steps_within(NEIGHBOURS);
    if steps.len() < ENOUGH_NEIGHBOURS || !frame.motion.is_known() {
        return vec![None; located.len()];
    }
    let mut again = vec![0_usize; located.len()];
    for step in steps {
        let to_here = step.own.vehicle_from_scan;
        let places: Vec<Point> =
            step.own.scan.detections.iter().flatten().map(|detection| to_here * detection.position).collect();
        let index: NeighborIndex = index_of(places.iter(), frame.radar.elevation);
        let mut association = Association::new(&index, frame.radar.elevation, 1);
        let radar = frame.radar.vehicle_from_radar.translation.vector;
        for (count, detection) in again.iter_mut().zip(located) {
            let reach = AGAIN.0.max(AGAIN.1 * (detection.position.coords - radar).norm());
            let nearest = association.nearest(&detection.position).first();
            *count += usize::from(nearest.is_some_and(|n| f64::from(n.distance_squared) <= reach * reach));
        }
    }
    again.into_iter().map(|count| Some(count as f64 / steps.len() as f64)).collect()
}

/// What the LiDAR sees where the detections are.
fn surroundings(frame: &Frame, located: &[&Detection], persistence: &[Option<f64>], values: &mut Values) {
    let Some((view, cloud)) = frame.lidar.as_ref().zip(frame.lidar_cloud()) else { return };
    let mut association = cloud.association(1);
    for detection in located {
        if let Some(nearest) = cloud.nearest(&mut association, detection).first() {
            let mut away = detection.position - nearest.position;
            if frame.radar.elevation == Elevation::None {
                away.z = 0.0;
            }
            values.push(Quantity::NearestLidar, away.norm().min(FARTHEST));
        }
    }
    let Some(fan) = RayFan::new(view) else { return };
    let (mut free, mut reached) = (0, 0);
    for (detection, persistence) in located.iter().zip(persistence) {
        let Some(is_free) = fan.is_free(&detection.position, &heights(frame, detection)) else { continue };
        reached += 1;
        free += usize::from(is_free);
        if let Some(share) = persistence.filter(|_| is_free) {
            values.push(Quantity::FreePersistence, share);
        }
    }
    if reached > 0 {
        values.push(Quantity::FreeSpace, f64::from(free as u32) / f64::from(reached as u32));
    }
}

/// The heights of the vehicle frame at which a detection may be.
fn heights(frame: &Frame, detection: &Detection) -> Heights {
    if frame.radar.elevation == Elevation::Measured {
        return Heights::About(detection.position.z);
    }
    let level = Point::new(detection.position.x, detection.position.y, 0.0);
    let floor = frame.ground.as_ref().map_or(0.0, |ground| -ground.height(&level));
    Heights::Between(floor + USUAL_HEIGHTS.0, floor + USUAL_HEIGHTS.1)
}
