//! The smooth sides of things: they flash at right angles, and are mirrors.

use super::sides;
use crate::kind::Kind;
use crate::random::Random;
use ralf::space::{Point, Vector};

/// An upright rectangle that is smooth for waves of 4 mm.
#[derive(Debug, Clone, Copy)]
pub(in crate::world) struct Wall {
    /// In the thing's frame.
    pub(in crate::world) center: Point,
    pub(in crate::world) normal: Vector,
    /// Half its width and height.
    pub(in crate::world) half: [f64; 2],
    /// What it takes beyond a facade, dB; below 0 it reflects better.
    pub(in crate::world) loss_db: f64,
    /// Standard deviation of its heights, m.
    pub(in crate::world) roughness: f64,
    /// How it is bent outward along and upward, 1/m; 0 is flat.
    pub(in crate::world) bulge: [f64; 2],
    /// What roughness leaves of the flash at right angles, dB.
    pub(in crate::world) flash_db: f64,
}

/// The smooth upright sides of a thing.
pub(in crate::world) fn walls(kind: Kind, size: Vector, random: &mut Random) -> Vec<Wall> {
    let [l, w] = [size.x / 2.0, size.y / 2.0];
    // From where to where it is smooth, what it takes more than a facade, what is left of a flash.
    let ([low, high], loss_db, flash_db) = match kind {
        Kind::Building | Kind::Garage => ([0.3, size.z], random.normal(1.5), random.between(-32.0, -18.0)),
        // A third of a corrugated sheet lies in its outer plane: half of its amplitude.
        Kind::Container => ([0.1, size.z], 6.0, random.between(-22.0, -10.0)),
        Kind::Truck => ([0.9, size.z], 0.0, random.between(-24.0, -12.0)),
        Kind::Car => ([0.25, 0.58 * size.z], 1.0, random.between(-30.0, -20.0)),
        Kind::Wall => ([0.0, size.z], 2.0, random.between(-34.0, -22.0)),
        Kind::Rail => ([size.z - 0.31, size.z], 1.0, random.between(-26.0, -16.0)),
        // Wires and posts fill a tenth of it.
        Kind::Fence => ([0.1, size.z], 10.0, random.between(-40.0, -28.0)),
        _ => return Vec::new(),
    };
    let (roughness, bulge) = (roughness(kind, random), bulge(kind, random));
    let wall = |(normal, distance, half): (Vector, f64, f64)| Wall {
        center: Point::from(normal * distance + Vector::z() * low.midpoint(high)),
        normal,
        half: [half, (high - low) / 2.0],
        loss_db,
        roughness,
        bulge,
        flash_db,
    };
    sides(l, w).into_iter().filter(|(_, _, half)| *half > 0.4).map(wall).collect()
}

/// Standard deviation of a wall's heights, m (chosen): glass and sheet metal 0.05 mm, plaster and concrete 0.2 to 1,
/// bricks with their joints more.
fn roughness(kind: Kind, random: &mut Random) -> f64 {
    let [smooth, rough]: [f64; 2] = match kind {
        Kind::Building | Kind::Garage => [0.05e-3, 2e-3],
        Kind::Wall => [0.2e-3, 2e-3],
        Kind::Truck => [0.05e-3, 0.4e-3],
        _ => [0.05e-3, 0.1e-3],
    };
    random.between(smooth.ln(), rough.ln()).exp()
}

/// How a wall is bent outward along and upward, 1/m (chosen): a car's side as a circle of 8 to 30 m seen from above and
/// of 1.5 to 6 m seen from ahead, a lorry's curtain five times as much, a wave of a guard rail as a tube of 10 cm.
fn bulge(kind: Kind, random: &mut Random) -> [f64; 2] {
    let bent = [random.between(1.0 / 30.0, 1.0 / 8.0), random.between(1.0 / 6.0, 1.0 / 1.5)];
    match kind {
        Kind::Car => bent,
        Kind::Truck => bent.map(|bend| bend / 5.0),
        Kind::Rail => [0.0, 10.0],
        _ => [0.0; 2],
    }
}
