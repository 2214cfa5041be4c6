//! What a faultless segmentation network would give: the class of what each pixel of a straight view shows.

use super::{HORIZON, Moment, Visible};
use crate::shape::Ray;
use ralf::label::UNLABELED;
use ralf::sensors::{ClassImage, StraightView};
use ralf::space::Point;

/// The true classes of each view; the sky has none.
pub(crate) fn true_classes<S: Visible>(moment: &Moment<'_, S>) -> Vec<ClassImage> {
    let views = moment.camera.straight_views();
    views.iter().map(|view| of_view(moment, view)).collect()
}

fn of_view<S: Visible>(moment: &Moment<'_, S>, view: &StraightView) -> ClassImage {
    let origin = Point::from(moment.site_from_camera.translation.vector);
    let site_from_view = moment.site_from_camera.rotation * view.camera_from_view;
    let (width, height) = (view.width, view.height);
    let id = |index: usize| {
        let along = view.ray([(index % width) as f64, (index / width) as f64]);
        let ray = Ray { origin, direction: (site_from_view * along).normalize() };
        let class = moment.scene.class(&ray, HORIZON).unwrap_or(UNLABELED);
        u8::try_from(class).unwrap_or(UNLABELED as u8)
    };
    ClassImage { width, height, ids: (0..width * height).map(id).collect() }
}
