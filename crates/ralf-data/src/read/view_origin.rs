//! What stored views were made of: beside `000000.npy` lies `000000.from`, a hash of the image and of how it is seen.

use crate::disk::files;
use crate::disk::hash::hash;
use crate::error::DataError;
use ralf::sensors::{Camera, CameraImage};
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// The file that tells what another was made of.
pub(crate) fn note_of(file: &Path) -> PathBuf {
    file.with_extension("from")
}

/// What the views of an image file are made of, in short: equal where the image and how it is seen are.
pub(crate) fn of_file(camera: &Camera, image: &Path) -> Result<String, DataError> {
    let (_, hash) = hash(image, &|_| {})?;
    Ok(hashed(camera, &[hash.as_bytes()]))
}

/// The same of an image that has no file of its own.
pub(crate) fn of_pixels(camera: &Camera, CameraImage { width, height, rgb }: &CameraImage) -> String {
    hashed(camera, &[format!("{width} {height}\n").as_bytes(), rgb.as_flattened()])
}

fn hashed(camera: &Camera, image: &[&[u8]]) -> String {
    let Camera { intrinsics, width, height, .. } = camera;
    let mut hasher = blake3::Hasher::new();
    // Debug shows every digit.
    hasher.update(format!("{intrinsics:?} {width} {height} {:?}\n", camera.straight_views()).as_bytes());
    for part in image {
        hasher.update(part);
    }
    format!("{}\n", hasher.finalize().to_hex())
}

/// Refuses stored views that were made of another image than this file, or of other views of it. Of those beside which
/// nothing tells what they were made of, nothing is known.
pub(crate) fn refuse_other(file: &Path, camera: &Camera, image: &Path) -> Result<(), DataError> {
    let Ok(known) = files::read_text(&note_of(file), Kind::Settings) else { return Ok(()) };
    same(file, &known, || of_file(camera, image), &image.display().to_string())
}

/// The same of an image that has no file of its own, and is decoded already.
pub(crate) fn refuse_other_pixels(
    file: &Path,
    camera: &Camera,
    image: &CameraImage,
) -> Result<(), DataError> {
    let Ok(known) = files::read_text(&note_of(file), Kind::Settings) else { return Ok(()) };
    same(file, &known, || Ok(of_pixels(camera, image)), "the image")
}

fn same(
    file: &Path,
    known: &str,
    now: impl FnOnce() -> Result<String, DataError>,
    image: &str,
) -> Result<(), DataError> {
    if now()? == known {
        return Ok(());
    }
    let expected = format!("what was made of {image} as it is, with the camera's views");
    Err(DataError::content(file, "origin", expected, "what was made of another image, or of other views"))
}
