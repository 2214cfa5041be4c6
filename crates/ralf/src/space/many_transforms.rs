//! One point in many frames at once, to single precision: enough to tell what is surely near and what is surely far.

use super::{Point, Transform, Vector};
use wide::f32x8;

/// Frames that a point is moved into together.
pub(crate) const LANES: usize = 8;
/// What is moved is off by less than this share of the sum of all coordinates that go into it.
const ROUNDING: f64 = 1e-6;

/// Many transforms from one frame.
#[derive(Debug, Clone)]
pub(crate) struct ManyTransforms {
    /// Some at a time: the rows of their rotations, each with the translation's coordinate.
    rows: Vec<[[f32x8; 4]; 3]>,
    /// Their times, s.
    seconds: Vec<f32x8>,
    /// No translation is longer, m.
    longest: f64,
    /// No time is farther from the first frame's, s.
    latest: f64,
}

impl ManyTransforms {
    /// Each with its time after the frame that they come from, s.
    pub(crate) fn new(transforms: &[Transform], seconds: &[f64]) -> Self {
        let longest =
            transforms.iter().map(|transform| transform.translation.vector.norm()).fold(0.0, f64::max);
        Self {
            rows: transforms.chunks(LANES).map(rows_of).collect(),
            seconds: seconds.chunks(LANES).map(lanes_of).collect(),
            longest,
            latest: seconds.iter().fold(0.0, |latest, seconds| seconds.abs().max(latest)),
        }
    }

    /// A point in each of the frames, [`LANES`] at a time; behind the last one follow some that stand for nothing. It
    /// moves at a velocity, m/s, and is taken where it is at the frame's own time.
    pub(crate) fn of(&self, p: &Point, velocity: &Vector) -> impl Iterator<Item = [f32x8; 3]> {
        let [p, velocity] =
            [p.coords, *velocity].map(|v| [v.x, v.y, v.z].map(|coordinate| f32x8::splat(coordinate as f32)));
        self.rows.iter().zip(&self.seconds).map(move |(rows, seconds)| {
            let [x, y, z] = [0, 1, 2].map(|axis| p[axis] + velocity[axis] * *seconds);
            rows.map(|[by_x, by_y, by_z, offset]| by_x * x + by_y * y + by_z * z + offset)
        })
    }

    /// No coordinate of a point is off by as much, m.
    pub(crate) fn slack(&self, p: &Point, velocity: &Vector) -> f64 {
        let farthest = p.coords.abs() + velocity.abs() * self.latest;
        ROUNDING * (farthest.sum() + self.longest)
    }
}

fn lanes_of(numbers: &[f64]) -> f32x8 {
    let mut lanes = [0.0; LANES];
    lanes.iter_mut().zip(numbers).for_each(|(lane, number)| *lane = *number as f32);
    f32x8::new(lanes)
}

fn rows_of(transforms: &[Transform]) -> [[f32x8; 4]; 3] {
    let mut lanes = [[[0.0; LANES]; 4]; 3];
    for (lane, transform) in transforms.iter().enumerate() {
        let (rotation, offset) = (transform.rotation.to_rotation_matrix(), transform.translation.vector);
        for (axis, row) in lanes.iter_mut().enumerate() {
            for (column, numbers) in row.iter_mut().enumerate().take(3) {
                numbers[lane] = rotation[(axis, column)] as f32;
            }
            row[3][lane] = offset[axis] as f32;
        }
    }
    lanes.map(|row| row.map(f32x8::new))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_point_is_where_each_transform_takes_it(
            frames in prop::collection::vec(
                (prop::array::uniform3(-90f64..90.0), prop::array::uniform3(-3f64..3.0), -1f64..1.0), 0..20,
            ),
            p in prop::array::uniform3(-400f64..400.0), velocity in prop::array::uniform3(-70f64..70.0),
        ) {
            let (transforms, seconds): (Vec<Transform>, Vec<f64>) = frames
                .into_iter()
                .map(|(offset, turn, seconds)| (Transform::new(Vector::from(offset), Vector::from(turn)), seconds))
                .unzip();
            let (p, velocity) = (Point::from(p), Vector::from(velocity));
            let many = ManyTransforms::new(&transforms, &seconds);
            let moved: Vec<[[f32; LANES]; 3]> =
                many.of(&p, &velocity).map(|axes| axes.map(|axis| axis.to_array())).collect();
            prop_assert_eq!(moved.len(), transforms.len().div_ceil(LANES));
            for (i, transform) in transforms.iter().enumerate() {
                let exact = transform * (p + velocity * seconds[i]);
                for axis in 0..3 {
                    let off = f64::from(moved[i / LANES][axis][i % LANES]) - exact[axis];
                    prop_assert!(off.abs() < many.slack(&p, &velocity), "{off} of {}", many.slack(&p, &velocity));
                }
            }
        }
    }
}
