//! Whether the LiDARs see as far as a detection lies. Where they do, that nothing is there says something; beyond,
//! nobody but the radar can tell.

use super::columns::unobserved;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::LidarView;
use crate::space::Point;

pub(super) const PIECE: Piece = Piece {
    features: &[Feature {
        name: "lidar_reach",
        unit: "1",
        group: "LiDAR rays",
        meaning: "distance from the LiDAR as a share of how far its scan sees, which is as far as its tenth farthest \
                  return; of the LiDAR scans around the least",
    }],
    observe,
};

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    let Some(window) = &frame.lidar_window else { return columns };
    let lidars = lidars(&window.window.views);
    for (value, probe) in columns[0].iter_mut().zip(surroundings.probes()) {
        let Some(probe) = probe else { continue };
        let position = probe.detection.position;
        let shares = lidars.iter().map(|lidar| (position - lidar.place).norm() / lidar.reach);
        *value = shares.min_by(f64::total_cmp).filter(|share| share.is_finite());
    }
    columns
}

/// A LiDAR in one of its scans.
struct Placed {
    /// In the frame of the window, m.
    place: Point,
    /// How far it sees, m.
    reach: f64,
}

/// Each LiDAR in each of these scans.
fn lidars(views: &[LidarView]) -> Vec<Placed> {
    let mut lidars = Vec::new();
    for view in views {
        for sweep in view.moment.sweeps() {
            let place = view.vehicle_from_moment * sweep.moment_from_lidar * Point::origin();
            lidars.push(Placed { place, reach: f64::from(sweep.rays().reach()) });
        }
    }
    lidars
}
