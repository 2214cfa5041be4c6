//! What light does where it meets things.

use crate::kind::Kind;
use crate::random::{Random, grain};
use crate::shape::Crossing;
use crate::solid::Solid;
use crate::world::scene::{Hit, Met};
use ralf::space::Point;

/// Which of a car's bodies is the cabin.
const CABIN: usize = 1;

/// How light meets a world.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Optics {
    /// Standard deviation of a range, m.
    pub(crate) sigma: f64,
    /// Share of rays that are lost for no reason.
    pub(crate) lost: f64,
    /// Share of rays that pass through a pane.
    pub(crate) glass: f64,
    /// Full scale of the intensity, as the sensor tells it.
    pub(crate) scale: f64,
    /// Drops per metre of a ray.
    pub(crate) rain: f64,
    pub(crate) seed: u64,
}

impl Optics {
    /// How far a ray comes that meets a body; `None` where it passes through.
    pub(super) fn stop(
        &self,
        solid: &Solid,
        crossing: &Crossing,
        entry: &Point,
        random: &mut Random,
    ) -> Option<f64> {
        let depth = match solid.kind {
            Kind::Tree if solid.shape.half_size().x > 0.3 => random.exponential(0.5),
            Kind::Hedge => random.exponential(0.15),
            Kind::Fence if random.chance(0.5) => return None,
            Kind::Sign | Kind::Cyclist if random.chance(0.1) => return None,
            _ if self.is_pane(solid, entry, crossing) => return self.behind(solid, crossing, random),
            _ => 0.0,
        };
        Some(crossing.enter + depth).filter(|distance| *distance <= crossing.leave)
    }

    /// Most of a car's cabin, and windows in rows along facades.
    fn is_pane(&self, solid: &Solid, entry: &Point, crossing: &Crossing) -> bool {
        let half = solid.shape.half_size();
        match solid.kind {
            Kind::Car => solid.part == CABIN && crossing.normal.z.abs() < 0.5,
            Kind::Building if crossing.normal.z.abs() < 0.5 => {
                let own = solid.local(entry);
                let along = if half.x - own.x.abs() < 0.01 { own.y } else { own.x };
                let up = own.z + half.z;
                let cell = [solid.object as i64, (along / 2.4).floor() as i64, (up / 3.0).floor() as i64];
                let window = along.rem_euclid(2.4) < 1.3 && (0.9..2.3).contains(&up.rem_euclid(3.0));
                window && grain(self.seed, cell) < 0.85
            }
            _ => false,
        }
    }

    /// Through the pane, into what stands behind it, or out on the other side of a car.
    fn behind(&self, solid: &Solid, crossing: &Crossing, random: &mut Random) -> Option<f64> {
        if !random.chance(self.glass) {
            return Some(crossing.enter);
        }
        let room = crossing.leave - crossing.enter;
        match solid.kind {
            // Seats and headrests fill a third of the view.
            Kind::Car if random.chance(0.6) => None,
            Kind::Car => Some(crossing.enter + room * random.between(0.2, 0.95)),
            _ => Some(crossing.enter + (0.5 + random.exponential(2.5)).min(room * 0.9)),
        }
    }

    /// Range and intensity of what a ray gives back, if anything.
    pub(super) fn echo(
        &self,
        hit: &Hit<'_>,
        facing: f64,
        limit: f64,
        random: &mut Random,
    ) -> Option<(f64, f64)> {
        let reflectance = match hit.on {
            Met::Ground(ground) => ground.reflectance,
            Met::Body(solid) => reflectance(solid, self.seed),
        };
        // Glossy paint sends little back from aside; plaster and leaves follow Lambert.
        let glossy = matches!(hit.on, Met::Body(solid) if matches!(solid.kind, Kind::Car | Kind::Truck));
        let facing = facing.clamp(0.02, 1.0);
        let back = reflectance * if glossy { facing.powi(2).max(0.05) } else { facing };
        // What comes back falls with the square of the range; 10 % are stated to be seen at the farthest.
        let budget = back / 0.1 * (limit / hit.distance.max(1.0)).powi(2);
        let lost = self.lost + (1.0 - self.lost) * (-1.2 * budget).exp();
        let intensity = (back * self.scale).min(2.5 * self.scale);
        (!random.chance(lost)).then(|| (hit.distance + random.normal(self.sigma), intensity))
    }

    /// Distance of a drop that the ray meets first.
    pub(super) fn drop(&self, distance: f64, random: &mut Random) -> Option<f64> {
        if self.rain <= 0.0 {
            return None;
        }
        // Near ones fill the beam, far ones don't.
        let met = 0.8 + random.exponential(3.0);
        (met < distance && random.chance(self.rain)).then_some(met)
    }
}

/// What comes back at right angles, 0 to 1; above it from retroreflectors.
fn reflectance(solid: &Solid, seed: u64) -> f64 {
    let own = grain(seed, [solid.object as i64, 3, 3]);
    match solid.kind {
        // From black to white.
        Kind::Car | Kind::Truck => 0.05 + 0.75 * own * own,
        Kind::Building | Kind::Garage => 0.2 + 0.4 * own,
        Kind::Wall | Kind::Bridge => 0.2 + 0.2 * own,
        Kind::Container => 0.15 + 0.4 * own,
        Kind::Tree | Kind::Hedge => 0.3 + 0.25 * own,
        Kind::Pedestrian | Kind::Cyclist => 0.1 + 0.5 * own,
        Kind::Rail | Kind::Pole | Kind::Fence => 0.25 + 0.25 * own,
        // Retroreflecting foil.
        Kind::Sign => 3.0,
        Kind::Grass | Kind::Sidewalk | Kind::Road | Kind::Marking => 0.2,
    }
}
