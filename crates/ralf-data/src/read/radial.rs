//! The range rate of radars that tell the two components of a velocity.

/// `(vx x + vy y) / sqrt(x^2 + y^2)`: the part of a velocity along the ray, positive when receding.
pub(crate) fn radial(x: &[f32], y: &[f32], vx: &[f32], vy: &[f32]) -> Vec<f32> {
    let along = |row: usize| {
        let [x, y, vx, vy] = [x[row], y[row], vx[row], vy[row]].map(f64::from);
        ((vx * x + vy * y) / x.hypot(y)) as f32
    };
    (0..x.len()).map(along).collect()
}
