//! Running a network over the straight views of a sequence's images.

use super::folder::ViewFolder;
use super::image_files::ImageFiles;
use super::stored_view::StoredView;
use crate::disk::files;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::view_origin::{note_of, of_file, of_pixels};
use crate::result::WriterLock;
use ralf::sensors::{Camera, CameraImage, SourceError, StraightView, UndistortMap};
use ralf_files::Kind;
use ralf_jobs::side_by_side;
use std::fmt;
use std::path::Path;
use std::sync::{Mutex, OnceLock, PoisonError};

/// A network: what it says of a view with a focal length, px; or why it says nothing.
pub type Estimate<'a, T> = dyn Fn(&CameraImage, f64) -> Result<T, String> + Sync + 'a;

/// Is told how the computation gets on, from several threads.
pub type ViewObserver<'a> = dyn Fn() + Sync + 'a;

/// A camera's views with the maps that straighten its images, made when they are first needed.
struct Straightening<'a> {
    camera: &'a Camera,
    views: OnceLock<Vec<(StraightView, UndistortMap)>>,
}

/// An image of which a network says nothing.
#[derive(Debug)]
pub struct Unusable {
    /// The camera's place in the rig.
    pub camera: usize,
    /// The image's place in the camera's timeline.
    pub image: usize,
    /// The camera's name.
    pub name: String,
    /// Why.
    pub error: SourceError,
}

impl fmt::Display for Unusable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, measurement {}: {}", self.name, self.image, self.error)
    }
}

/// What came of a computation.
#[derive(Debug, Default)]
pub struct Computed {
    /// The images of which the network says nothing for a reason of their own, in their order.
    pub without: Vec<Unusable>,
    /// Of so many images the store held something that was damaged, or made of another image or of other views, or of
    /// which isn't known what it was made of: what they show now took its place.
    pub again: usize,
}

/// Computes and stores what a network says of the images (camera, number) that the store doesn't hold yet, several at a
/// time. Beside each file lies what it was made of (`000000.from`): what was made of something else is made again, and
/// so is what is damaged.
///
/// What can't be stored is an error, and so is another process that writes to the store. The store becomes the
/// network's with the first image of which it says something.
pub(super) fn compute_views<V: StoredView>(
    reader: &dyn SequenceReader,
    images: &[(usize, usize)],
    (store, card): (&ViewFolder, &V::Card),
    estimate: &Estimate<V>,
    jobs: usize,
    observer: &ViewObserver,
) -> Result<Computed, DataError> {
    let files = ImageFiles::new(store, reader)?;
    refuse_unlike_views::<V>(reader, images, &files)?;
    let right = RightToWrite::new(&files)?;
    let is_claimed = Mutex::new(false);
    let claim_once = || {
        let mut is_claimed = is_claimed.lock().unwrap_or_else(PoisonError::into_inner);
        if !*is_claimed {
            store.claim(card, V::network)?;
            *is_claimed = true;
        }
        Ok(())
    };
    let cameras = reader.sequence().rig.cameras.iter();
    let cameras: Vec<_> = cameras.map(|camera| Straightening { camera, views: OnceLock::new() }).collect();
    let done = side_by_side(images, jobs, |&(camera, image)| {
        let missing = || DataError::NoMeasurement { kind: "camera", sensor: camera, index: image };
        let file = files.file(reader, camera, image).ok_or_else(missing)?;
        let straightening = &cameras[camera];
        let filling = Filling { estimate, right: &right, claim: &claim_once };
        let came_of_it = straightening.fill::<V>(reader, (camera, image), &file, &filling)?;
        observer();
        Ok::<_, DataError>(((camera, image), came_of_it))
    })?;
    let mut computed = Computed::default();
    for ((camera, image), came_of_it) in done {
        let name = || cameras[camera].camera.name.clone();
        match came_of_it {
            Ok(again) => computed.again += usize::from(again),
            Err(error) => computed.without.push(Unusable { camera, image, name: name(), error }),
        }
    }
    computed.without.sort_by_key(|found| (found.camera, found.image));
    Ok(computed)
}

/// The right to write to a store. Where the system grants none, that is an error only once there is something to write:
/// a store that can only be read may be complete.
struct RightToWrite<'a> {
    files: &'a ImageFiles,
    lock: Mutex<Option<WriterLock>>,
}

impl<'a> RightToWrite<'a> {
    fn new(files: &'a ImageFiles) -> Result<Self, DataError> {
        let lock = match files.lock() {
            Err(refused) if refused.is_of_permission() => None,
            lock => Some(lock?),
        };
        Ok(Self { files, lock: Mutex::new(lock) })
    }

    fn take(&self) -> Result<(), DataError> {
        let mut lock = self.lock.lock().unwrap_or_else(PoisonError::into_inner);
        if lock.is_none() {
            *lock = Some(self.files.lock()?);
        }
        Ok(())
    }
}

/// What an image's file is made with.
struct Filling<'a, V> {
    estimate: &'a Estimate<'a, V>,
    right: &'a RightToWrite<'a>,
    /// Makes the store the network's.
    claim: &'a dyn Fn() -> Result<(), DataError>,
}

/// Views that one file can't hold: asked before a network works on the first of them.
fn refuse_unlike_views<V: StoredView>(
    reader: &dyn SequenceReader,
    images: &[(usize, usize)],
    files: &ImageFiles,
) -> Result<(), DataError> {
    for (place, camera) in reader.sequence().rig.cameras.iter().enumerate() {
        let Some(first) = images.iter().find(|(camera, _)| *camera == place) else { continue };
        let views = camera.straight_views();
        let sizes: Vec<[usize; 2]> = views.iter().map(|view| V::stacked([view.width, view.height])).collect();
        if let Some(other) = sizes.iter().find(|size| **size != sizes[0]) {
            let file = files.file(reader, place, first.1).unwrap_or_default();
            let [a, b] = [sizes[0], *other].map(|[width, height]| format!("{width} x {height}"));
            let expected = format!("views of {} that are alike, for one file holds them", camera.name);
            return Err(DataError::content(&file, "views", expected, format!("{a} and {b} px")));
        }
    }
    Ok(())
}

impl Straightening<'_> {
    /// Makes an image's file, unless a whole one was made of this image and of these views. Returns whether it took the
    /// place of another; or why nothing can be said of the image.
    fn fill<V: StoredView>(
        &self,
        reader: &dyn SequenceReader,
        (camera, image): (usize, usize),
        file: &Path,
        filling: &Filling<V>,
    ) -> Result<Result<bool, SourceError>, DataError> {
        let origin = match origin(self.camera, reader, (camera, image)) {
            Ok(origin) => origin,
            Err(error) => return Ok(Err(error)),
        };
        let note = note_of(file);
        let is_there = files::exists(file)?;
        let is_of_this = || files::read_text(&note, Kind::Settings).is_ok_and(|known| known == origin);
        if is_there && is_of_this() && V::is_whole(file) {
            return Ok(Ok(false));
        }
        if is_there || files::exists(&note)? {
            filling.right.take()?;
            // Should the work end in between, nobody takes the one for made of the other.
            files::remove(&note)?;
        }
        match self.estimated(reader, (camera, image), filling.estimate) {
            Ok(views) => {
                filling.right.take()?;
                (filling.claim)()?;
                V::write(file, &views)?;
                files::write_whole(&note, origin.as_bytes())?;
                Ok(Ok(is_there))
            }
            Err(error) if is_there => files::remove(file).map(|()| Err(error)),
            Err(error) => Ok(Err(error)),
        }
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

/// What the views of an image are made of. Where images have no files of their own, it is decoded.
fn origin(
    camera: &Camera,
    reader: &dyn SequenceReader,
    (place, image): (usize, usize),
) -> Result<String, SourceError> {
    match reader.image_file(place, image) {
        Some(file) => Ok(of_file(camera, &file)?),
        None => Ok(of_pixels(camera, &reader.image(place, image)?)),
    }
}
