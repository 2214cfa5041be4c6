//! Camera images: JPEG and PNG, decoded.

use crate::DataError;
use image::{ImageError, ImageReader};
use ralf::camera::CameraImage;
use std::path::Path;

/// The image, with three channels of 8 bits. Refused unless it is `[width, height]` pixels large.
pub(crate) fn read(file: &Path, [width, height]: [usize; 2]) -> Result<CameraImage, DataError> {
    let decoded = open(file)?.decode().map_err(|error| undecodable(file, error))?.into_rgb8();
    let found = [decoded.width() as usize, decoded.height() as usize];
    if found != [width, height] {
        let [found_width, found_height] = found;
        return Err(DataError::content(
            file,
            "image size",
            format!("{width} x {height} px, as the camera has"),
            format!("{found_width} x {found_height} px"),
        ));
    }
    Ok(CameraImage { width, height, rgb: decoded.pixels().map(|pixel| pixel.0).collect() })
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
