//! Solid bodies and where rays meet them.

use nalgebra::Vector3;
use ralf::space::{Point, Vector};

/// A ray; its direction has unit length.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ray {
    pub(super) origin: Point,
    pub(super) direction: Vector,
}

impl Ray {
    /// Whether it passes a ball; one behind its origin isn't passed.
    pub(super) fn passes(&self, center: &Point, radius: f64) -> bool {
        let way = center - self.origin;
        let along = way.dot(&self.direction);
        along > -radius && way.norm_squared() - along * along < radius * radius
    }
}

/// Where a ray enters and leaves a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// Distance of the entry, m, at least 0: the ray starts outside.
    pub(super) enter: f64,
    /// Distance of the exit, m.
    pub(super) leave: f64,
    /// Outward, at the entry.
    pub(super) normal: Vector,
}

/// A body about its own centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Shape {
    /// Half its length, width and height.
    Box(Vector),
    /// Half its axes.
    Ellipsoid(Vector),
    /// Upright: radius and half its height.
    Cylinder(f64, f64),
}

impl Shape {
    /// Half the size of the axis-parallel box around the body.
    pub(super) fn half_size(&self) -> Vector {
        match *self {
            Self::Box(half) | Self::Ellipsoid(half) => half,
            Self::Cylinder(radius, half_height) => Vector::new(radius, radius, half_height),
        }
    }

    /// Where a ray (in the body's frame) crosses the body. A ray from within doesn't.
    pub(super) fn crossing(&self, ray: &Ray) -> Option<Crossing> {
        match *self {
            Self::Box(half) => box_crossing(ray, half),
            Self::Ellipsoid(half) => ellipsoid_crossing(ray, half),
            Self::Cylinder(radius, half_height) => cylinder_crossing(ray, radius, half_height),
        }
        .filter(|crossing| crossing.enter >= 0.0)
    }
}

/// The slab method.
fn box_crossing(ray: &Ray, half: Vector) -> Option<Crossing> {
    let (mut enter, mut leave) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut entered_along = None;
    for axis in 0..3 {
        let (from, along) = (ray.origin[axis], ray.direction[axis]);
        if along == 0.0 {
            if from.abs() > half[axis] {
                return None;
            }
            continue;
        }
        let (a, b) = ((-half[axis] - from) / along, (half[axis] - from) / along);
        let (near, far) = if a <= b { (a, b) } else { (b, a) };
        if near > enter {
            enter = near;
            entered_along = Some(axis);
        }
        leave = leave.min(far);
        // Most boxes that a ray is asked about are missed.
        if enter > leave {
            return None;
        }
    }
    let mut normal = Vector::zeros();
    if let Some(axis) = entered_along {
        normal[axis] = -ray.direction[axis].signum();
    }
    (enter <= leave).then_some(Crossing { enter, leave, normal })
}

fn ellipsoid_crossing(ray: &Ray, half: Vector) -> Option<Crossing> {
    let origin = ray.origin.coords.component_div(&half);
    let direction = ray.direction.component_div(&half);
    let (a, b) = (direction.norm_squared(), origin.dot(&direction));
    let (enter, leave) = roots(a, b, origin.norm_squared() - 1.0)?;
    let p = ray.origin.coords + ray.direction * enter;
    let normal = p.component_div(&half.component_mul(&half)).normalize();
    Some(Crossing { enter, leave, normal })
}

fn cylinder_crossing(ray: &Ray, radius: f64, half_height: f64) -> Option<Crossing> {
    let cap = box_crossing(ray, Vector3::new(f64::INFINITY, f64::INFINITY, half_height))?;
    let (o, d) = (ray.origin.coords.xy(), ray.direction.xy());
    let outside = o.norm_squared() - radius * radius;
    let (a, b) = (d.norm_squared(), o.dot(&d));
    if a < 1e-18 {
        return (outside <= 0.0).then_some(cap);
    }
    let (enter, leave) = roots(a, b, outside)?;
    let leave = leave.min(cap.leave);
    let side = o + d * enter;
    let (enter, normal) = if cap.enter > enter {
        (cap.enter, cap.normal)
    } else {
        (enter, Vector::new(side.x, side.y, 0.0) / radius)
    };
    (enter <= leave).then_some(Crossing { enter, leave, normal })
}

/// Both solutions of `a t^2 + 2 b t + c = 0`, ascending.
fn roots(a: f64, b: f64, c: f64) -> Option<(f64, f64)> {
    let discriminant = b * b - a * c;
    let root = (discriminant >= 0.0).then(|| discriminant.sqrt())?;
    Some(((-b - root) / a, (-b + root) / a))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn inside(shape: &Shape, p: Vector, slack: f64) -> bool {
        match *shape {
            Shape::Box(half) => (0..3).all(|axis| p[axis].abs() <= half[axis] + slack),
            Shape::Ellipsoid(half) => p.component_div(&half).norm() <= 1.0 + slack,
            Shape::Cylinder(radius, half) => p.xy().norm() <= radius + slack && p.z.abs() <= half + slack,
        }
    }

    fn shapes() -> [Shape; 3] {
        [
            Shape::Box(Vector::new(1.0, 2.0, 0.5)),
            Shape::Ellipsoid(Vector::new(1.0, 2.0, 0.5)),
            Shape::Cylinder(0.7, 1.5),
        ]
    }

    proptest! {
        #[test]
        fn a_ray_is_inside_between_its_crossings_and_nowhere_else(
            x in -6.0..6.0, y in -6.0..6.0, z in -4.0..4.0, dx in -1.0..1.0, dy in -1.0..1.0, dz in -1.0..1.0,
        ) {
            let (origin, direction) = (Point::new(x, y, z), Vector::new(dx, dy, dz));
            prop_assume!(direction.norm() > 0.01);
            let ray = Ray { origin, direction: direction.normalize() };
            for shape in shapes() {
                prop_assume!(!inside(&shape, origin.coords, 1e-6));
                let crossing = shape.crossing(&ray);
                for step in 0..400 {
                    let t = f64::from(step) * 0.04;
                    let within = crossing.is_some_and(|c| c.enter <= t && t <= c.leave);
                    let p = origin.coords + ray.direction * t;
                    prop_assert!(!within || inside(&shape, p, 1e-6), "{:?} {}", shape, t);
                    prop_assert!(within || !inside(&shape, p, -1e-6), "{:?} {}", shape, t);
                }
                if let Some(crossing) = crossing {
                    prop_assert!(crossing.normal.dot(&ray.direction) <= 1e-9);
                    prop_assert!((crossing.normal.norm() - 1.0).abs() < 1e-9);
                }
            }
        }
    }
}
