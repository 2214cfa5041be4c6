//! How near a pixel is to an edge of the image: small, so that a question costs one look.

use ralf::sensors::{Camera, CameraImage};

/// Images are brought to at most this width, px: finer than what a LiDAR tells.
const WIDTH: usize = 560;
/// An edge counts half this far from it, degrees.
const HALF_DEG: f64 = 0.75;
/// The gradient that counts in full: so many of a hundred are weaker.
const STRONG: f64 = 0.95;
/// Weaker gradients are noise, of 255.
const FAINTEST: f32 = 4.0;

/// Nearness of edges that run up and down, and of those that run sideways: 1 on a strong one.
#[derive(Debug, Clone)]
pub(crate) struct EdgeMap {
    step: usize,
    width: usize,
    height: usize,
    upright: Vec<f32>,
    level: Vec<f32>,
}

impl EdgeMap {
    pub(super) fn new(camera: &Camera, image: &CameraImage) -> Option<Self> {
        let step = image.width.div_ceil(WIDTH).max(1);
        let (width, height) = (image.width / step, image.height / step);
        if width < 16 || height < 16 || image.rgb.len() < image.width * image.height {
            return None;
        }
        let grey = smaller(image, step, width, height);
        let degrees = camera.intrinsics.focal_on_axis().to_radians() / step as f64;
        let decay = 0.5_f64.powf(1.0 / (HALF_DEG * degrees).max(1.0)) as f32;
        let mut map = Self { step, width, height, upright: vec![], level: vec![] };
        map.upright = map.nearness(&grey, [1, width], width, height, decay);
        map.level = map.nearness(&grey, [width, 1], height, width, decay);
        Some(map)
    }

    /// Gradients along lines of `length` pixels `along` apart, spread along the lines.
    fn nearness(
        &self,
        grey: &[f32],
        [along, across]: [usize; 2],
        length: usize,
        lines: usize,
        decay: f32,
    ) -> Vec<f32> {
        let mut found = vec![0.0_f32; self.width * self.height];
        for line in 0..lines {
            for i in 1..length - 1 {
                let at = line * across + i * along;
                found[at] = (grey[at + along] - grey[at - along]).abs();
            }
        }
        let mut sorted = found.clone();
        sorted.sort_by(f32::total_cmp);
        let strong = sorted[(sorted.len() as f64 * STRONG) as usize].max(FAINTEST);
        found.iter_mut().for_each(|value| *value = (*value / strong).min(1.0));
        for line in 0..lines {
            let at = |i: usize| line * across + i * along;
            for i in 1..length {
                found[at(i)] = found[at(i)].max(decay * found[at(i - 1)]);
            }
            for i in (1..length).rev() {
                found[at(i - 1)] = found[at(i - 1)].max(decay * found[at(i)]);
            }
        }
        found
    }

    /// Nearness at a pixel of the whole image; `None` outside of it.
    pub(crate) fn at(&self, [u, v]: [f64; 2], is_top: bool) -> Option<f64> {
        let [column, row] = [u, v].map(|value| (value + 0.5) / self.step as f64);
        let inside = column >= 0.0 && row >= 0.0 && column < self.width as f64 && row < self.height as f64;
        let map = if is_top { &self.level } else { &self.upright };
        inside.then(|| f64::from(map[row as usize * self.width + column as usize]))
    }
}

/// Mean brightness of squares of `step` pixels.
fn smaller(image: &CameraImage, step: usize, width: usize, height: usize) -> Vec<f32> {
    let mut grey = Vec::with_capacity(width * height);
    for row in 0..height {
        for column in 0..width {
            let mut sum = 0_u32;
            for y in row * step..(row + 1) * step {
                let from = y * image.width + column * step;
                sum += image.rgb[from..from + step].iter().flatten().map(|v| u32::from(*v)).sum::<u32>();
            }
            grey.push(sum as f32 / (3 * step * step) as f32);
        }
    }
    grey
}
