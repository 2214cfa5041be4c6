//! Mirror images: facades and car sides are smooth for waves of 4 mm, and show real scatterers where none are. The
//! images stay in their place as the vehicle moves, just as real things do.

use super::{Echo, View, distance_loss_db};
use crate::kind::Kind;
use crate::random::Random;
use crate::scatterer::Scatterer;
use crate::shape::Shape;
use crate::site::Site;
use crate::truth::Truth;
use nalgebra::Isometry3;
use ralf::label::Cause;
use ralf::space::{Point, Vector};

/// A scatterer weaker than this has no image, dBsm.
const LEAST_STRENGTH_DB: f64 = 4.0;
/// What the reflection takes, dB.
const LOSS_DB: f64 = 6.0;
/// Farther mirrors, and objects farther from a mirror, are left out, m.
const REACH: f64 = 30.0;

/// An upright rectangle that reflects, in the frame of its object.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Mirror {
    object: usize,
    center: Point,
    normal: Vector,
    /// Half its width and height.
    half: [f64; 2],
}

impl Mirror {
    /// The four sides of every building and of every car's body.
    pub(crate) fn all(site: &Site) -> Vec<Self> {
        let objects = site.objects.iter().enumerate();
        let smooth =
            objects.filter(|(_, object)| matches!(object.kind, Kind::Building | Kind::Garage | Kind::Car));
        let sides = smooth.flat_map(|(index, object)| {
            // A garage reflects with each of its walls; a car with its body.
            let bodies = if object.kind == Kind::Garage { 3 } else { 1 };
            object.bodies.iter().take(bodies).flat_map(move |(shape, center)| sides(index, shape, center))
        });
        sides.collect()
    }
}

fn sides(object: usize, shape: &Shape, center: &Vector) -> impl Iterator<Item = Mirror> + use<> {
    let half = shape.half_size();
    let center = Point::from(*center);
    [Vector::x(), -Vector::x(), Vector::y(), -Vector::y()].into_iter().map(move |normal| {
        let along = if normal.x == 0.0 { half.x } else { half.y };
        let center = center + normal.component_mul(&half);
        Mirror { object, center, normal, half: [along, half.z] }
    })
}

/// A mirror in its place that faces the radar.
struct Placed {
    object: usize,
    center: Point,
    normal: Vector,
    half: [f64; 2],
    /// How far the radar is before it, m.
    distance: f64,
}

impl Placed {
    fn new(view: &View<'_>, mirror: &Mirror, pose: &Isometry3<f64>) -> Option<Self> {
        let (center, normal) = (pose * mirror.center, pose.rotation * mirror.normal);
        let to_radar = view.origin() - center;
        let distance = normal.dot(&to_radar);
        let near = to_radar.norm() < REACH + mirror.half[0];
        (near && distance > 0.4).then_some(Self {
            object: mirror.object,
            center,
            normal,
            half: mirror.half,
            distance,
        })
    }

    /// Where the wave to the image of `p` is reflected.
    fn point_of_reflection(&self, origin: &Point, p: &Point) -> Option<Point> {
        let before = self.normal.dot(&(p - self.center));
        if before < 0.3 {
            return None;
        }
        let image = self.image(p);
        let at = origin + (image - origin) * (self.distance / (self.distance + before));
        let offset = at - self.center;
        let along = self.normal.x * offset.y - self.normal.y * offset.x;
        (along.abs() <= self.half[0] && offset.z.abs() <= self.half[1]).then_some(at)
    }

    fn image(&self, p: &Point) -> Point {
        p - self.normal * (2.0 * self.normal.dot(&(p - self.center)))
    }
}

/// The images of all strong scatterers in all mirrors.
pub(super) fn echoes(view: &View<'_>, mirrors: &[Mirror], random: &mut Random) -> Vec<Echo> {
    let (objects, poses) = (&view.scene.site.objects, &view.scene.poses);
    let mut found = Vec::new();
    for placed in mirrors.iter().filter_map(|mirror| Placed::new(view, mirror, &poses[mirror.object])) {
        for (index, object) in objects.iter().enumerate().filter(|(index, _)| *index != placed.object) {
            let foot = Point::from(poses[index].translation.vector);
            if (foot - placed.center).norm() > REACH + placed.half[0] {
                continue;
            }
            let strong = |scatterer: &&Scatterer| {
                scatterer.strength_db > LEAST_STRENGTH_DB && !scatterer.behind_facade
            };
            for scatterer in object.scatterers.iter().filter(strong) {
                let p = poses[index] * scatterer.position;
                let image = image(view, &placed, index, &p, scatterer.strength_db);
                found.extend(image.map(|echo| Echo {
                    level_db: echo.level_db + random.normal(scatterer.flicker_db),
                    ..echo
                }));
            }
        }
    }
    found
}

/// The image of a scatterer of an object, which is at `p`.
fn image(view: &View<'_>, placed: &Placed, object: usize, p: &Point, strength_db: f64) -> Option<Echo> {
    let at = placed.point_of_reflection(&view.origin(), p)?;
    let position = placed.image(p);
    let range = view.range_in_view(&position)?;
    let there_db = view.scene.radar_loss_db(&view.origin(), &at, Some(placed.object))?;
    let on_db = view.scene.radar_loss_db(&(at + placed.normal * 0.02), p, Some(object))?;
    let [original, mirror] = [object, placed.object].map(|object| view.scene.velocities[object]);
    let mirrored = original - placed.normal * (2.0 * placed.normal.dot(&(original - mirror)));
    Some(Echo {
        position,
        range_rate: view.range_rate(&position, &mirrored),
        level_db: strength_db - LOSS_DB - there_db - on_db - distance_loss_db(range),
        truth: Truth::artifact(Cause::Mirror),
    })
}
