//! The range rate of radars that tell the components of a velocity.

/// `(vx x + vy y) / sqrt(x^2 + y^2)`: the part of a velocity along the ray, positive when receding.
pub(crate) fn radial(x: &[f32], y: &[f32], vx: &[f32], vy: &[f32]) -> Vec<f32> {
    let along = |row: usize| {
        let [x, y, vx, vy] = [x[row], y[row], vx[row], vy[row]].map(f64::from);
        ((vx * x + vy * y) / x.hypot(y)) as f32
    };
    (0..x.len()).map(along).collect()
}

/// `v . p / |p|`: the same of a radar that measures elevation. Not a number where a detection has no place.
pub(crate) fn radial_3d(place: [&[f32]; 3], velocity: [&[f32]; 3]) -> Vec<f32> {
    let along = |row: usize| {
        let [place, velocity] = [place, velocity].map(|vector| vector.map(|axis| f64::from(axis[row])));
        let product: f64 = place.iter().zip(&velocity).map(|(p, v)| p * v).sum();
        let range = place.iter().map(|p| p * p).sum::<f64>().sqrt();
        (product / range) as f32
    };
    (0..place[0].len()).map(along).collect()
}
