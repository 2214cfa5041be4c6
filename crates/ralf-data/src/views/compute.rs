//! Running a network over the straight views of a sequence's images.

use super::folder::ViewFolder;
use super::image_files::ImageFiles;
use super::stored_view::StoredView;
use crate::disk::files;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::hash_file;
use ralf::sensors::{Camera, CameraImage, SourceError, StraightView, UndistortMap};
use ralf_files::Kind;
use ralf_jobs::side_by_side;
use std::path::Path;
use std::sync::OnceLock;

/// How the file ends that tells what another of the same name was made of.
const ORIGIN: &str = "from";

/// A network: what it says of a view with a focal length, px; or why it says nothing.
pub type Estimate<'a, T> = dyn Fn(&CameraImage, f64) -> Result<T, String> + Sync + 'a;

/// Is told how the computation gets on, from several threads.
pub type ViewObserver<'a> = dyn Fn() + Sync + 'a;

/// A camera's views with the maps that straighten its images, made when they are first needed.
struct Straightening<'a> {
    camera: &'a Camera,
    views: OnceLock<Vec<(StraightView, UndistortMap)>>,
}

/// What came of a computation.
#[derive(Debug, Default)]
pub struct Computed {
    /// The images of which the network says nothing for a reason of their own, which is named, in their order.
    pub without: Vec<DataError>,
    /// Of so many images the store held something that was made of another image or of other views, or of which isn't
    /// known what it was made of: what they show now took its place.
    pub again: usize,
}

/// Computes and stores what a network says of the images (camera, number) that the store doesn't hold yet, several at a
/// time. Beside each file lies what it was made of (`000000.from`): what was made of something else is made again.
///
/// What can't be stored is an error, and so is another process that writes to the store.
pub(super) fn compute_views<V: StoredView>(
    reader: &dyn SequenceReader,
    images: &[(usize, usize)],
    store: &ViewFolder,
    estimate: &Estimate<V>,
    jobs: usize,
    observer: &ViewObserver,
) -> Result<Computed, DataError> {
    let files = ImageFiles::new(store, reader)?;
    let _lock = files.lock()?;
    let cameras = reader.sequence().rig.cameras.iter();
    let cameras: Vec<_> = cameras.map(|camera| Straightening { camera, views: OnceLock::new() }).collect();
    let done = side_by_side(images, jobs, |&(camera, image)| {
        let missing = || DataError::NoMeasurement { kind: "camera", sensor: camera, index: image };
        let file = files.file(reader, camera, image).ok_or_else(missing)?;
        let straightening = &cameras[camera];
        let came_of_it = straightening.fill::<V>(reader, (camera, image), &file, estimate)?;
        observer();
        Ok::<_, DataError>(((camera, image), came_of_it))
    })?;
    let mut computed = Computed::default();
    let mut without = Vec::new();
    for (key, came_of_it) in done {
        match came_of_it {
            Ok(again) => computed.again += usize::from(again),
            Err(error) => without.push((key, error)),
        }
    }
    without.sort_by_key(|(image, _)| *image);
    computed.without = without.into_iter().map(|(_, error)| error).collect();
    Ok(computed)
}

impl Straightening<'_> {
    /// Makes an image's file, unless it was made of this image and of these views. Returns whether it took the place of
    /// another; or why nothing can be said of the image.
    fn fill<V: StoredView>(
        &self,
        reader: &dyn SequenceReader,
        (camera, image): (usize, usize),
        file: &Path,
        estimate: &Estimate<V>,
    ) -> Result<Result<bool, DataError>, DataError> {
        let unusable =
            |error| DataError::Measurement { sensor: self.camera.name.clone(), index: image, error };
        let origin = match self.origin(reader, (camera, image)) {
            Ok(origin) => origin,
            Err(error) => return Ok(Err(unusable(error))),
        };
        let note = file.with_extension(ORIGIN);
        let is_there = files::exists(file)?;
        if is_there && files::read_text(&note, Kind::Settings).is_ok_and(|known| known == origin) {
            return Ok(Ok(false));
        }
        // Should the work end in between, nobody takes the one for made of the other.
        files::remove(&note)?;
        match self.estimated(reader, (camera, image), estimate) {
            Ok(views) => {
                V::write(file, &views)?;
                files::write_whole(&note, origin.as_bytes())?;
                Ok(Ok(is_there))
            }
            Err(error) => files::remove(file).map(|()| Err(unusable(error))),
        }
    }

    /// What the views of an image are made of, in short: equal where the image and how it is seen are.
    fn origin(
        &self,
        reader: &dyn SequenceReader,
        (camera, image): (usize, usize),
    ) -> Result<String, SourceError> {
        let Camera { intrinsics, width, height, .. } = self.camera;
        let mut hasher = blake3::Hasher::new();
        // Debug shows every digit.
        hasher.update(
            format!("{intrinsics:?} {width} {height} {:?}\n", self.camera.straight_views()).as_bytes(),
        );
        match reader.image_file(camera, image) {
            Some(file) => hasher.update(hash_file(&file, &|_| {})?.blake3.as_bytes()),
            None => {
                let CameraImage { width, height, rgb } = reader.image(camera, image)?;
                hasher.update(format!("{width} {height}\n").as_bytes()).update(rgb.as_flattened())
            }
        };
        Ok(format!("{}\n", hasher.finalize().to_hex()))
    }

    fn estimated<T>(
        &self,
        reader: &dyn SequenceReader,
        (camera, image): (usize, usize),
        estimate: &Estimate<T>,
    ) -> Result<Vec<T>, SourceError> {
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
