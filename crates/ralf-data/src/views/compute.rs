//! Running a network over the straight views of a sequence's images.

use super::folder::ViewFolder;
use super::stored_view::StoredView;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::SequenceNames;
use ralf::sensors::{Camera, CameraImage, StraightView, UndistortMap};
use ralf_jobs::side_by_side;
use std::sync::OnceLock;

/// A network: what it says of a view with a focal length, px; or why it says nothing.
pub type Estimate<'a, T> = dyn Fn(&CameraImage, f64) -> Result<T, String> + Sync + 'a;

/// Is told how the computation gets on, from several threads.
pub type ViewObserver<'a> = dyn Fn() + Sync + 'a;

/// A camera's views with the maps that straighten its images, made when they are first needed.
struct Straightening<'a> {
    camera: &'a Camera,
    views: OnceLock<Vec<(StraightView, UndistortMap)>>,
}

/// Computes and stores what a network says of the images (camera, number) that the store doesn't hold yet, several at a
/// time.
///
/// Returns the images that it can say nothing of for a reason of their own, which is named, in their order. What can't
/// be stored is an error, and so is another process that writes to the store.
pub(super) fn compute_views<V: StoredView>(
    reader: &dyn SequenceReader,
    images: &[(usize, usize)],
    store: &ViewFolder,
    estimate: &Estimate<V>,
    jobs: usize,
    observer: &ViewObserver,
) -> Result<Vec<DataError>, DataError> {
    let names = SequenceNames::new(reader.sequence())?;
    let _lock = store.lock()?;
    let cameras = reader.sequence().rig.cameras.iter();
    let cameras: Vec<_> = cameras.map(|camera| Straightening { camera, views: OnceLock::new() }).collect();
    let without = side_by_side(images, jobs, |&(camera, image)| {
        let (folder, straightening) = (&names.cameras[camera], &cameras[camera]);
        let mut failed = None;
        let file = store.file(&names.sequence, folder, image);
        if !file.exists() {
            match straightening.estimated(reader, (camera, image), estimate) {
                Ok(views) => V::write(&file, &views)?,
                Err(error) => {
                    let sensor = straightening.camera.name.clone();
                    failed = Some(((camera, image), DataError::Measurement { sensor, index: image, error }));
                }
            }
        }
        observer();
        Ok::<_, DataError>(failed)
    })?;
    let mut without: Vec<_> = without.into_iter().flatten().collect();
    without.sort_by_key(|(image, _)| *image);
    Ok(without.into_iter().map(|(_, error)| error).collect())
}

impl Straightening<'_> {
    fn estimated<T>(
        &self,
        reader: &dyn SequenceReader,
        (camera, image): (usize, usize),
        estimate: &Estimate<T>,
    ) -> Result<Vec<T>, ralf::sensors::SourceError> {
        let Camera { intrinsics, width, height, .. } = self.camera;
        intrinsics.check(*width, *height).map_err(|expected| format!("expected {expected}"))?;
        let raw = reader.image(camera, image)?;
        let mut estimated = Vec::new();
        for (view, map) in self.views() {
            let straight = map.apply(&raw)?;
            estimated.push(estimate(&straight, view.focal)?);
        }
        Ok(estimated)
    }

    fn views(&self) -> &[(StraightView, UndistortMap)] {
        self.views.get_or_init(|| {
            let Camera { intrinsics, width, height, .. } = self.camera;
            let straighten = |view| (view, UndistortMap::new(intrinsics, *width, *height, &view));
            self.camera.straight_views().into_iter().map(straighten).collect()
        })
    }
}
