//! Mirror images: radar waves that a wall turns back show what stands before it as if it stood behind.

use super::columns::{set, unobserved};
use super::distance::{Spot, chi_within};
use super::wall::Line;
use super::way::TALL;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Detection, StaticMap};
use crate::sensors::Elevation;
use crate::space::{Point, Vector};
use nalgebra::Matrix3;

pub(super) const PIECE: Piece = Piece {
    features: &[Feature {
        name: "context_mirror",
        unit: "sigma",
        group: "Context",
        meaning: "distance of its mirror image, in the wall that stands first in the radar's way to it, from the \
                  nearest detection of the scan that has a larger cross-section; null where there is no such wall, or \
                  no such detection within 5 m of the image",
    }],
    observe,
};

/// A wall is told from the columns within this, m.
const AROUND: f64 = 1.5;
/// And from no fewer of them.
const COLUMNS: usize = 6;
/// The columns of a wall scatter across it by no more than this share of how they scatter along it.
const THIN: f64 = 0.25;
/// What was mirrored is looked for within this, m.
const REACH: f64 = 5.0;

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    let (Some(lidar), Some(strength)) = (&frame.lidar_window, frame.strength()) else { return columns };
    let map = lidar.window.map();
    let window_from_vehicle = lidar.vehicle_from_window.inverse();
    let radar = window_from_vehicle * Point::from(frame.radar.vehicle_from_radar.translation.vector);
    let level = frame.radar.elevation == Elevation::None;
    let spots: Vec<Option<Spot>> =
        frame.scan.detections.iter().map(|detection| detection.as_ref().map(Spot::new)).collect();
    let mut near = Vec::new();
    for (i, detection) in surroundings.rows_by_place() {
        let moved = detection.moved(&window_from_vehicle);
        let behind = surroundings.ways()[i].map_or(0.0, |way| way.behind_first_tall);
        let Some(mirror) = Mirror::before(map, &radar, &moved.position, behind) else { continue };
        let image = mirror.reflect(&moved).moved(&lidar.vehicle_from_window);
        let image_spot = Spot::new(&image);
        surroundings.beside(&image, REACH, &mut near);
        let mut least: Option<f64> = None;
        for other in near.iter().map(|other| *other as usize) {
            let stronger = strength.cross_section[other] > strength.cross_section[i];
            if let Some(partner) = spots[other].as_ref().filter(|_| stronger) {
                let known = least.unwrap_or(f64::INFINITY);
                least = Some(chi_within(known, &image_spot, partner, level).unwrap_or(known));
            }
        }
        set(&mut columns, i, [least]);
    }
    columns
}

/// A vertical plane that turns waves back.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Mirror {
    /// A point of it, m.
    point: Vector,
    /// Of unit length, horizontal.
    normal: Vector,
}

impl Mirror {
    /// The wall that something tall in the radar's way to a place belongs to, which lies so far behind it, m; `None`
    /// where the place lies behind nothing, or behind nothing flat.
    fn before(map: &StaticMap, radar: &Point, place: &Point, behind: f64) -> Option<Self> {
        if behind == 0.0 {
            return None;
        }
        let along = Vector::new(place.x - radar.x, place.y - radar.y, 0.0).try_normalize(1e-6)?;
        let met = place - along * behind;
        let columns = map.columns.around(met.x, met.y, AROUND).filter(|(_, column)| column.top >= TALL);
        let places: Vec<[f64; 2]> = columns.map(|(place, _)| place).collect();
        if places.len() < COLUMNS {
            return None;
        }
        let Line { middle: [x, y], normal: [across_x, across_y], .. } =
            Some(Line::through(&places)).filter(|line| line.is_thin(THIN))?;
        Some(Self {
            point: met.coords + Vector::new(x, y, 0.0),
            normal: Vector::new(across_x, across_y, 0.0),
        })
    }

    /// A detection as it lies on the wall's other side.
    fn reflect(&self, detection: &Detection) -> Detection {
        let reflection = Matrix3::identity() - 2.0 * self.normal * self.normal.transpose();
        let position = self.point + reflection * (detection.position.coords - self.point);
        Detection { position: Point::from(position), axes: reflection * detection.axes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reflection_is_its_own_inverse_and_keeps_the_wall() {
        let mirror = Mirror { point: Vector::new(0.0, 5.0, 0.0), normal: Vector::y() };
        let detection = Detection { position: Point::new(10.0, 8.0, 1.0), axes: Matrix3::identity() };
        let image = mirror.reflect(&detection);
        assert_eq!(image.position, Point::new(10.0, 2.0, 1.0));
        assert_eq!(mirror.reflect(&image).position, detection.position);
        assert_eq!(image.axes[(1, 1)], -1.0);
    }
}
