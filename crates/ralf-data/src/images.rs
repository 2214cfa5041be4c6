//! Camera images: JPEG and PNG, decoded.

use crate::DataError;
use image::{ImageError, ImageReader};
use ralf::camera::CameraImage;
use std::path::Path;

/// An image file as 8-bit colour.
pub(crate) fn read(file: &Path) -> Result<CameraImage, DataError> {
    let decoded = open(file)?.decode().map_err(|error| undecodable(file, error))?.into_rgb8();
    let [width, height] = [decoded.width(), decoded.height()].map(|pixels| pixels as usize);
    Ok(CameraImage { width, height, rgb: decoded.into_raw().as_chunks::<3>().0.to_vec() })
}

/// The same, refused unless it has the camera's size in pixels.
pub(crate) fn read_of_size(file: &Path, width: usize, height: usize) -> Result<CameraImage, DataError> {
    let image = read(file)?;
    if (image.width, image.height) == (width, height) {
        return Ok(image);
    }
    let expected = format!("{width} x {height} px, as the camera has");
    let found = format!("{} x {} px", image.width, image.height);
    Err(DataError::content(file, "image size", expected, found))
}

/// Width and height in pixels, without decoding.
pub(crate) fn size(file: &Path) -> Result<[usize; 2], DataError> {
    let (width, height) = open(file)?.into_dimensions().map_err(|error| undecodable(file, error))?;
    Ok([width as usize, height as usize])
}

fn open(file: &Path) -> Result<ImageReader<std::io::BufReader<std::fs::File>>, DataError> {
    let reader = ImageReader::open(file).map_err(DataError::io(file))?;
    reader.with_guessed_format().map_err(DataError::io(file))
}

fn undecodable(file: &Path, error: ImageError) -> DataError {
    match error {
        // A file that ends early is a damaged image, not a refusal of the system.
        ImageError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            DataError::Io { file: file.to_owned(), error }
        }
        error => DataError::content(file, "image data", "a JPEG or PNG image", error.to_string()),
    }
}
