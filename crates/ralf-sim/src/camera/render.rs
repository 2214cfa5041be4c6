//! The raw image.

use super::paint::{Light, lit, sky};
use super::{HORIZON, Moment, Visible};
use crate::random::Random;
use crate::scenario::FailureKind;
use crate::shape::Ray;
use ralf::sensors::{Camera, CameraImage};
use ralf::space::{Point, Vector};

/// Where each pixel looks, in the optical frame, row by row; `None` where the lens shows nothing.
pub(crate) type Rays = Vec<Option<Vector>>;

/// Noise of a pixel's value.
const NOISE: f64 = 2.0;
/// What is left of the light where there is none.
const DARKNESS: f64 = 0.02;
/// Radius of a flare, as a share of the image's width.
const FLARE: f64 = 0.35;

/// Where the pixels of a camera look.
pub(crate) fn rays(camera: &Camera) -> Rays {
    let rays = camera.intrinsics.rays(camera.width, camera.height);
    rays.into_iter().map(|ray| ray.map(|ray| ray.into_inner())).collect()
}

/// What the camera sees.
pub(crate) fn image<S: Visible>(
    moment: &Moment<'_, S>,
    rays: &Rays,
    failure: Option<FailureKind>,
    random: &mut Random,
) -> CameraImage {
    let (width, height) = (moment.camera.width, moment.camera.height);
    let sun = [random.between(0.3, 0.7) * width as f64, random.between(0.3, 0.6) * height as f64];
    let light = Light::default();
    let pixel = |(index, ray): (usize, &Option<Vector>)| {
        let seen = ray.map_or([0.0; 3], |ray| seen(moment, &light, &ray));
        let [u, v] = [(index % width) as f64, (index / width) as f64];
        let glare = (1.0 - (u - sun[0]).hypot(v - sun[1]) / (FLARE * width as f64)).max(0.0);
        let grain = random.normal(NOISE);
        seen.map(|value| match failure {
            Some(FailureKind::Dark) => value * DARKNESS + 0.3 * grain,
            Some(FailureKind::Flare) => value + 400.0 * glare + grain,
            Some(FailureKind::Garbage) | None => value + grain,
        })
        .map(|value| value.round().clamp(0.0, 255.0) as u8)
    };
    CameraImage { width, height, rgb: rays.iter().enumerate().map(pixel).collect() }
}

/// The colour in a direction, 0 to 255.
fn seen<S: Visible>(moment: &Moment<'_, S>, light: &Light, own: &Vector) -> [f64; 3] {
    let origin = Point::from(moment.site_from_camera.translation.vector);
    let ray = Ray { origin, direction: moment.site_from_camera.rotation * own };
    match moment.scene.surface(&ray, HORIZON) {
        Some(surface) => lit(&moment.scene, light, &ray, &surface),
        None => sky(&ray),
    }
}
