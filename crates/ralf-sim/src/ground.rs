//! The ground: level, with ramps.

use super::scenario::Ramp;
use super::shape::Ray;
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion, Vector2};
use ralf::space::{Point, Transform, Vector};

/// Waves of 4 mm are bent over an edge of the ground that stands so high in their way, m: 10 to 20 dB are lost there.
const BENT: f64 = 0.1;

/// Height of the ground at every place.
#[derive(Debug, Clone)]
pub(super) struct Ground {
    slopes: Vec<Slope>,
}

#[derive(Debug, Clone)]
struct Slope {
    foot: Vector2<f64>,
    direction: Vector2<f64>,
    length: f64,
    tangent: f64,
}

impl Slope {
    /// How far along the ramp's direction a place lies from its foot.
    fn along(&self, x: f64, y: f64) -> f64 {
        (Vector2::new(x, y) - self.foot).dot(&self.direction)
    }
}

impl Ground {
    pub(super) fn new(ramps: &[Ramp]) -> Self {
        let slope = |ramp: &Ramp| {
            let (sin, cos) = ramp.direction_deg.to_radians().sin_cos();
            let tangent = ramp.slope_deg.to_radians().tan();
            Slope { foot: ramp.at.into(), direction: Vector2::new(cos, sin), length: ramp.length, tangent }
        };
        Self { slopes: ramps.iter().map(slope).collect() }
    }

    /// m, in the site's frame.
    pub(super) fn height(&self, x: f64, y: f64) -> f64 {
        self.slopes.iter().map(|slope| slope.tangent * slope.along(x, y).clamp(0.0, slope.length)).sum()
    }

    /// Upward, of unit length.
    pub(super) fn normal(&self, x: f64, y: f64) -> Vector {
        let on = |slope: &&Slope| (0.0..slope.length).contains(&slope.along(x, y));
        let gradient: Vector2<f64> =
            self.slopes.iter().filter(on).map(|slope| slope.direction * slope.tangent).sum();
        Vector::new(-gradient.x, -gradient.y, 1.0).normalize()
    }

    /// How much it rises per metre along x and y.
    pub(super) fn gradient(&self, x: f64, y: f64) -> [f64; 2] {
        let up = self.normal(x, y);
        [-up.x / up.z, -up.y / up.z]
    }

    /// The pose of something that stands on the ground at a place, turned by `yaw`, and leans with the slope.
    pub(super) fn pose(&self, [x, y, yaw]: [f64; 3]) -> Transform {
        let up = self.normal(x, y);
        let heading = Vector::new(yaw.cos(), yaw.sin(), 0.0);
        let left = up.cross(&heading).normalize();
        let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[left.cross(&up), left, up]));
        Transform::from_parts(
            Translation3::new(x, y, self.height(x, y)),
            UnitQuaternion::from_rotation_matrix(&rotation),
        )
    }

    /// Whether the ground lies between two places. Along the way its height is linear between the ramps' edges; a wave
    /// is bent over what stands in its way by less than [`BENT`].
    pub(super) fn hides(&self, from: &Point, to: &Point) -> bool {
        let way = to - from;
        let mut edges = self.edges(from, &way).filter(|t| (0.0..1.0).contains(t));
        edges.any(|t| {
            let p = from + way * t;
            p.z < self.height(p.x, p.y) - BENT
        })
    }

    /// Where a way from a place crosses the edges of the ramps, in lengths of `way`.
    fn edges<'a>(&'a self, from: &'a Point, way: &'a Vector) -> impl Iterator<Item = f64> + Clone + 'a {
        self.slopes.iter().flat_map(move |slope| {
            let begin = slope.along(from.x, from.y);
            let rate = way.xy().dot(&slope.direction);
            [-begin / rate, (slope.length - begin) / rate]
        })
    }

    /// The distance at which a ray from above meets the ground. Along a ray its height is linear between the ramps'
    /// edges.
    pub(super) fn hit(&self, ray: &Ray, limit: f64) -> Option<f64> {
        let above = |t: f64| {
            let p = ray.origin + ray.direction * t;
            p.z - self.height(p.x, p.y)
        };
        let edges = self.edges(&ray.origin, &ray.direction);
        let mut at = 0.0;
        let mut height = above(at);
        while at < limit {
            let next = edges.clone().filter(|t| *t > at + 1e-9).fold(limit, f64::min);
            let next_height = above(next);
            if height >= 0.0 && next_height < 0.0 {
                return Some(at + (next - at) * height / (height - next_height));
            }
            (at, height) = (next, next_height);
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Ground {
        Ground::new(&[Ramp { at: [10.0, 0.0], direction_deg: 0.0, length: 20.0, slope_deg: 5.0 }])
    }

    #[test]
    fn rays_meet_the_ground_where_its_height_is_theirs() {
        let ground = ramp();
        for (z, down) in [(2.0, 0.3), (2.0, 0.05), (6.0, 0.2), (2.5, 0.02)] {
            let direction = Vector::new(1.0, 0.4, -down).normalize();
            let ray = Ray { origin: Point::new(0.0, 0.0, z), direction };
            let p = ray.origin + direction * ground.hit(&ray, 500.0).unwrap();
            assert!((p.z - ground.height(p.x, p.y)).abs() < 1e-9, "{p}");
        }
        assert!(
            ground.hit(&Ray { origin: Point::new(0.0, 0.0, 2.0), direction: Vector::x() }, 12.0).is_none()
        );
    }

    #[test]
    fn what_lies_behind_a_crest_is_hidden() {
        let crest =
            |slope_deg: f64, x: f64| Ramp { at: [x, 0.0], direction_deg: 0.0, length: 20.0, slope_deg };
        let hill = Ground::new(&[crest(5.0, 10.0), crest(-5.0, 30.0)]);
        let from = Point::new(0.0, 0.0, 0.5);
        for (x, above, hidden) in
            [(29.0, 0.2, false), (45.0, 0.3, true), (60.0, 0.3, true), (60.0, 4.0, false)]
        {
            let to = Point::new(x, 3.0, hill.height(x, 3.0) + above);
            assert_eq!(hill.hides(&from, &to), hidden, "{to}");
            assert_eq!(hill.hides(&to, &from), hidden, "and back");
        }
        assert!(!Ground::new(&[]).hides(&from, &Point::new(50.0, 0.0, 0.0)));
    }

    #[test]
    fn a_vehicle_leans_with_the_slope() {
        let pose = ramp().pose([20.0, 3.0, 0.0]);
        let ahead = pose * Point::new(2.0, 0.0, 0.0);
        assert!((ahead.z - ramp().height(ahead.x, ahead.y)).abs() < 1e-9);
        assert!((ramp().pose([20.0, 3.0, 1.0]) * Vector::z() - pose * Vector::z()).norm() < 1e-9);
    }
}
