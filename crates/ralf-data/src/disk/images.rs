//! Camera images: JPEG and PNG files to pixels, and pixels to PNG.

use crate::disk::files;
use crate::error::DataError;
use image::{ColorType, ImageFormat, ImageReader};
use ralf::sensors::{Camera, CameraImage, ImageSizeError, SourceError};
use std::io::{BufReader, Cursor};
use std::path::Path;

/// How the names of image files end that can be read.
pub(crate) const EXTENSIONS: [&str; 3] = ["jpg", "jpeg", "png"];

/// An image file as 8-bit colour, refused unless it has the camera's size in pixels. The file's header tells its size:
/// a small file may hold an image of any.
pub(crate) fn read(file: &Path, camera: &Camera) -> Result<CameraImage, SourceError> {
    let bytes = files::read(file)?;
    check_size(&bytes, camera, |place, expected, found| DataError::content(file, place, expected, found))?;
    Ok(decode(&bytes).map_err(|found| unreadable(file, found))?)
}

/// Refuses an image of another size than the camera's, with an error as `error` makes it. What is no image is not known
/// by its size.
pub(crate) fn check_size(
    bytes: &[u8],
    camera: &Camera,
    error: impl FnOnce(&'static str, String, String) -> DataError,
) -> Result<(), ImageSizeError> {
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format();
    let Some((width, height)) = reader.ok().and_then(|reader| reader.into_dimensions().ok()) else {
        return Ok(());
    };
    size_error([width as usize, height as usize], camera, error).map_or(Ok(()), Err)
}

/// The error of an image of this size, px, unless it is the camera's.
pub(crate) fn size_error(
    found: [usize; 2],
    camera: &Camera,
    error: impl FnOnce(&'static str, String, String) -> DataError,
) -> Option<ImageSizeError> {
    let told = |[width, height]: [usize; 2]| format!("{width} x {height} px");
    let own = [camera.width, camera.height];
    (found != own).then(|| {
        let reason = error("image size", told(own) + ", as the camera has", told(found)).to_string();
        ImageSizeError { found, reason }
    })
}

/// Width and height in pixels, without decoding.
pub(crate) fn size(file: &Path) -> Result<[usize; 2], DataError> {
    let bytes = BufReader::new(files::open(file)?);
    let reader = ImageReader::new(bytes).with_guessed_format().map_err(DataError::io(file))?;
    let (width, height) = reader.into_dimensions().map_err(|error| unreadable(file, error.to_string()))?;
    Ok([width as usize, height as usize])
}

/// The bytes of a JPEG or PNG as they are, refused unless the header is one: a name, or a link, may lead to anything.
pub(crate) fn read_bytes(file: &Path) -> Result<Vec<u8>, DataError> {
    let bytes = files::read(file)?;
    let reader = ImageReader::new(Cursor::new(&bytes)).with_guessed_format().map_err(DataError::io(file))?;
    match reader.into_dimensions() {
        Ok(_) => Ok(bytes),
        Err(error) => Err(unreadable(file, error.to_string())),
    }
}

fn unreadable(file: &Path, found: String) -> DataError {
    DataError::content(file, "content", "a whole JPEG or PNG image", found)
}

/// Pixels from the bytes of a JPEG or PNG; the error says what is wrong with them.
pub(crate) fn decode(bytes: &[u8]) -> Result<CameraImage, String> {
    let reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|e| e.to_string())?;
    if reader.format() == Some(ImageFormat::Jpeg) && !is_whole_jpeg(bytes) {
        return Err("a JPEG without its end".to_owned());
    }
    let image = reader.decode().map_err(|error| error.to_string())?.into_rgb8();
    let (width, height) = (image.width() as usize, image.height() as usize);
    Ok(CameraImage { width, height, rgb: image.into_raw().as_chunks::<3>().0.to_vec() })
}

/// The bytes of a PNG file: what any reader turns back into the same pixels. The error says what is wrong with the
/// image.
pub fn png(image: &CameraImage) -> Result<Vec<u8>, String> {
    let mut bytes = Cursor::new(Vec::new());
    let size = |pixels: usize| u32::try_from(pixels).map_err(|error| error.to_string());
    let (width, height) = (size(image.width)?, size(image.height)?);
    if image.rgb.len() != image.width * image.height {
        return Err(format!("{} pixels in an image of {width} x {height}", image.rgb.len()));
    }
    let pixels = image.rgb.as_flattened();
    image::write_buffer_with_format(&mut bytes, pixels, width, height, ColorType::Rgb8, ImageFormat::Png)
        .map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Whether an end-of-image marker follows the last start of a scan. Decoders fill what a cut file lacks with grey, and
/// the thumbnail in a file's header has an end of its own.
fn is_whole_jpeg(bytes: &[u8]) -> bool {
    let last = |marker: [u8; 2]| bytes.windows(2).rposition(|pair| pair == marker);
    last([0xFF, 0xDA]).is_some_and(|scan| last([0xFF, 0xD9]).is_some_and(|end| end > scan))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::sensors::Intrinsics;
    use ralf::space::Transform;

    fn image() -> CameraImage {
        let rgb = (0..64u8 * 2).map(|i| [i, 255 - i, i / 2]).collect();
        CameraImage { width: 16, height: 8, rgb }
    }

    fn jpeg() -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let pixels: Vec<u8> = image().rgb.concat();
        image::write_buffer_with_format(&mut bytes, &pixels, 16, 8, ColorType::Rgb8, ImageFormat::Jpeg)
            .unwrap();
        bytes.into_inner()
    }

    #[test]
    fn png_keeps_every_pixel() {
        assert_eq!(decode(&png(&image()).unwrap()).unwrap(), image());
        assert!(png(&CameraImage { width: 3, ..image() }).is_err());
    }

    #[test]
    fn an_image_of_another_size_is_not_decoded() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("000000.png");
        // A header that asks for a gigabyte.
        let mut claims = png(&image()).unwrap();
        claims[16..24].copy_from_slice(&[0, 0, 0x40, 0, 0, 0, 0x40, 0]);
        let sum = crc32fast::hash(&claims[12..29]);
        claims[29..33].copy_from_slice(&sum.to_be_bytes());
        std::fs::write(&file, &claims).unwrap();
        let camera = Camera {
            name: "eye".into(),
            vehicle_from_camera: Transform::identity(),
            width: 16,
            height: 8,
            intrinsics: Intrinsics::Pinhole { focal: [9.0; 2], center: [7.5, 3.5], distortion: [0.0; 5] },
            views: vec![],
        };
        let error = read(&file, &camera).unwrap_err();
        let size = error.downcast_ref::<ImageSizeError>().unwrap();
        assert_eq!(size.found, [16384, 16384]);
        let told = "000000.png: image size: expected 16 x 8 px, as the camera has, found 16384 x 16384 px";
        assert!(error.to_string().ends_with(told), "{error}");
        std::fs::write(&file, png(&image()).unwrap()).unwrap();
        assert_eq!(read(&file, &camera).unwrap(), image());
    }

    #[test]
    fn cut_files_and_other_bytes_are_refused() {
        let whole = jpeg();
        assert_eq!(decode(&whole).unwrap().rgb.len(), 128);
        for length in 0..whole.len() {
            assert!(decode(&whole[..length]).is_err(), "JPEG cut to {length} of {} bytes", whole.len());
        }
        let whole = png(&image()).unwrap();
        // The last 12 bytes are the end marker, which decoders don't wait for.
        for length in 0..whole.len() - 12 {
            assert!(decode(&whole[..length]).is_err(), "PNG cut to {length} of {} bytes", whole.len());
        }
        assert!(decode(b"GIF89a").is_err());
    }
}
