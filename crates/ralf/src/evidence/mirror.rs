//! Mirror images: radar waves that a wall turns back show what stands before it as if it stood behind.

use super::columns::{set, unobserved};
use super::distance::{Spot, chi_within};
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
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(moved) = detection.map(|detection| detection.moved(&window_from_vehicle)) else { continue };
        let behind = surroundings.ways()[i].map_or(0.0, |way| way.behind_first_tall);
        let Some(wall) = Wall::before(map, &radar, &moved.position, behind) else { continue };
        let image = wall.reflect(&moved).moved(&lidar.vehicle_from_window);
        let image_spot = Spot::new(&image);
        surroundings.beside(&image.position, REACH, &mut near);
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

/// A vertical plane.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Wall {
    /// A point of it, m.
    point: Vector,
    /// Of unit length, horizontal.
    normal: Vector,
}

impl Wall {
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
        let (center, normal) = line_through(&places)?;
        Some(Self { point: met.coords + Vector::new(center[0], center[1], 0.0), normal })
    }

    /// A detection as it lies on the wall's other side.
    fn reflect(&self, detection: &Detection) -> Detection {
        let reflection = Matrix3::identity() - 2.0 * self.normal * self.normal.transpose();
        let position = self.point + reflection * (detection.position.coords - self.point);
        Detection { position: Point::from(position), axes: reflection * detection.axes }
    }
}

/// The line through places, as their middle and its normal; `None` of too few, and where they are no line.
fn line_through(places: &[[f64; 2]]) -> Option<([f64; 2], Vector)> {
    if places.len() < COLUMNS {
        return None;
    }
    let count = places.len() as f64;
    let middle = [0, 1].map(|axis| places.iter().map(|place| place[axis]).sum::<f64>() / count);
    let (mut xx, mut xy, mut yy) = (0.0, 0.0, 0.0);
    for place in places {
        let [x, y] = [place[0] - middle[0], place[1] - middle[1]];
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    // The principal axes of the scatter: half the trace, more and less by this.
    let (half, apart) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    if half - apart > THIN * THIN * (half + apart) {
        return None;
    }
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    Some((middle, Vector::new(-angle.sin(), angle.cos(), 0.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_by_hand() {
        let slanted: Vec<[f64; 2]> =
            (0..9).map(|k| [0.25 * f64::from(k), 1.0 + 0.25 * f64::from(k)]).collect();
        let (middle, normal) = line_through(&slanted).unwrap();
        assert!((middle[0] - 1.0).abs() < 1e-12 && (middle[1] - 2.0).abs() < 1e-12);
        assert!((normal - Vector::new(-1.0, 1.0, 0.0).normalize()).norm() < 1e-12);
        let upright: Vec<[f64; 2]> = (0..9).map(|k| [3.0, f64::from(k)]).collect();
        assert!((line_through(&upright).unwrap().1.x.abs() - 1.0).abs() < 1e-12);
        let heap: Vec<[f64; 2]> = (0..9).map(|k| [f64::from(k % 3), f64::from(k / 3)]).collect();
        assert!(line_through(&heap).is_none() && line_through(&slanted[..5]).is_none());
    }

    #[test]
    fn a_reflection_is_its_own_inverse_and_keeps_the_wall() {
        let wall = Wall { point: Vector::new(0.0, 5.0, 0.0), normal: Vector::y() };
        let detection = Detection { position: Point::new(10.0, 8.0, 1.0), axes: Matrix3::identity() };
        let image = wall.reflect(&detection);
        assert_eq!(image.position, Point::new(10.0, 2.0, 1.0));
        assert_eq!(wall.reflect(&image).position, detection.position);
        assert_eq!(image.axes[(1, 1)], -1.0);
    }
}
