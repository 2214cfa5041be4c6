//! The detections of all radars around a scan, in its frame.

use super::association::index_of;
use super::frame::Frame;
use super::located::Detection;
use crate::space::NeighborIndex;

/// All detections of a frame's `radar_window`, in the vehicle frame at the scan's time: one entry of each list per
/// detection. Those without a position are left out.
#[derive(Debug)]
pub struct NeighbouringDetections {
    /// Where it lies, m, and how well that is known.
    pub detections: Vec<Detection>,
    /// Which scan of the frame's `radar_window` it belongs to.
    pub scans: Vec<u32>,
    /// Its place in that scan.
    pub rows: Vec<u32>,
    /// How fast it recedes from its radar, without the radar's own motion, m/s; NaN where that was not measured.
    pub doppler: Vec<f64>,
    /// Of the detections' positions; an identity is a place in these lists. Horizontal where the frame's radar measures
    /// no elevation.
    pub index: NeighborIndex,
    /// Of each scan of the window: the radar that made it, as its place in the rig.
    pub radars: Vec<usize>,
    /// Of each scan of the window: whether the frame's own radar made it.
    pub own: Vec<bool>,
    /// Of each scan of the window: its time after the frame's scan, s.
    pub seconds: Vec<f64>,
}

impl NeighbouringDetections {
    /// The detections around a frame's scan.
    pub fn around(frame: &Frame) -> Self {
        let most = frame.radar_window.iter().map(|neighbour| neighbour.scan.len()).sum();
        let (mut detections, mut doppler) = (Vec::with_capacity(most), Vec::with_capacity(most));
        let (mut scans, mut rows) = (Vec::with_capacity(most), Vec::with_capacity(most));
        for (scan, neighbour) in (0u32..).zip(&frame.radar_window) {
            let radar = &frame.rig.radars[neighbour.radar];
            let rates = neighbour.scan.doppler(radar, frame.motion);
            for (row, detection) in neighbour.scan.moved(&neighbour.vehicle_from_scan).enumerate() {
                let Some(detection) = detection else { continue };
                detections.push(detection);
                scans.push(scan);
                rows.push(row as u32);
                doppler.push(rates.map_or(f64::NAN, |rates| rates.compensated[row]));
            }
        }
        let index = index_of(detections.iter().map(|detection| &detection.position), frame.radar.elevation);
        let own = frame.radar_window.iter().map(|neighbour| frame.is_own(neighbour.radar)).collect();
        let radars = frame.radar_window.iter().map(|neighbour| neighbour.radar).collect();
        let after = |t_ns: i64| (t_ns - frame.scan.t_ns()) as f64 * 1e-9;
        let seconds = frame.radar_window.iter().map(|neighbour| after(neighbour.scan.t_ns())).collect();
        Self { detections, scans, rows, doppler, index, radars, own, seconds }
    }

    /// How many detections.
    pub fn len(&self) -> usize {
        self.detections.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.detections.is_empty()
    }
}
