//! The segmentations of the images around a radar scan.

use super::super::camera::{ImageId, SegmentedImage, SegmentedView};
use super::super::frame::{SensorKind, Unreadable};
use super::super::lidar::LidarView;
use super::{FrameWindow, Key};
use std::sync::Arc;

/// An image's segmentation if it has one, and the reason where it can't be read.
pub(super) type Segmented = Result<Option<Arc<SegmentedImage>>, String>;

impl FrameWindow<'_> {
    /// The images nearest to a time with their segmentations; those without one are absent, and those whose can't be
    /// read are named.
    pub(super) fn segmented(&mut self, t_ns: i64, unreadable: &mut Vec<Unreadable>) -> Vec<SegmentedView> {
        let mut views = Vec::new();
        let nearest = if self.config.camera.enabled { self.nearest_images(t_ns) } else { Vec::new() };
        for (camera, image) in nearest {
            match self.segmentation((camera, image)) {
                Ok(Some(moment)) => {
                    let vehicle_from_image = self.source.sequence().motion.between(t_ns, moment.id.t_ns);
                    views.push(SegmentedView { moment, vehicle_from_image });
                }
                Ok(None) => {}
                Err(reason) => {
                    let sensor = self.rig.cameras[camera].name.clone();
                    unreadable.push(Unreadable { sensor, index: image, reason });
                }
            }
        }
        views
    }

    fn segmentation(&mut self, key: Key) -> Segmented {
        let known = self.segmented.get(&key);
        let found = known.unwrap_or_else(|| {
            let found = self.noting(|window| window.read_segmentation(key).map(|found| found.map(Arc::new)));
            self.segmented.insert(key, found.clone());
            found
        });
        self.noted(found)
    }

    fn read_segmentation(&mut self, (camera, image): Key) -> Result<Option<SegmentedImage>, String> {
        let classes = self.source.classes(camera, image).map_err(|error| error.to_string());
        let classes = classes.inspect_err(|reason| self.note(SensorKind::Camera, (camera, image), reason))?;
        let Some(classes) = classes else { return Ok(None) };
        let t_ns = self.source.sequence().times.cameras[camera][image];
        let points = self.near_lidars(t_ns).view.as_ref().map(LidarView::all_points).unwrap_or_default();
        let calibrated = self.image(camera, image);
        let id = ImageId { camera, image, t_ns };
        let segmented = SegmentedImage::new(
            &self.rig.cameras[camera],
            id,
            &classes,
            &points,
            calibrated.as_deref(),
            &self.config.camera,
        );
        segmented.map(Some)
    }
}
