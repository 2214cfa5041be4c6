//! Segmentations: a PNG of 8 bits of grey per image, whose values are SemanticKITTI ids; the image's straight views
//! stand one below the other.

use super::{files, images};
use crate::error::DataError;
use image::{ColorType, DynamicImage, ImageFormat, ImageReader};
use ralf::label::class_name;
use ralf::sensors::{Camera, ClassImage};
use std::io::Cursor;
use std::path::Path;

/// The segmentations of a camera's views.
pub(crate) fn read(file: &Path, camera: &Camera) -> Result<Vec<ClassImage>, DataError> {
    let views = camera.straight_views();
    let width = views.first().map_or(0, |view| view.width);
    if views.iter().any(|view| view.width != width) {
        let found = "different ones, which one image can't hold";
        return Err(DataError::content(file, "views", "views of one width", found));
    }
    let height: usize = views.iter().map(|view| view.height).sum();
    let [found_width, found_height] = images::size(file)?;
    if [found_width, found_height] != [width, height] {
        let expected = format!("{width} x {height} px, as the camera's views have below each other");
        let found = format!("{found_width} x {found_height} px");
        return Err(DataError::content(file, "image size", expected, found));
    }
    let ids = ids(file, width)?;
    let mut rest = ids.as_slice();
    let mut cut = Vec::with_capacity(views.len());
    for view in &views {
        let (own, below) = rest.split_at(width * view.height);
        cut.push(ClassImage { width, height: view.height, ids: own.to_vec() });
        rest = below;
    }
    Ok(cut)
}

/// The bytes of the file of an image's views. The error says what was expected and found.
pub(crate) fn bytes(views: &[ClassImage]) -> Result<Vec<u8>, (&'static str, String)> {
    let width = views.first().map_or(0, |view| view.width);
    if let Some(other) = views.iter().find(|view| view.width != width) {
        return Err(("views of one width", format!("{width} and {} px", other.width)));
    }
    let wrong = |reason: String| ("an image that PNG can hold", reason);
    let rows: usize = views.iter().map(|view| view.height).sum();
    let ids: Vec<u8> = views.iter().flat_map(|view| view.ids.iter().copied()).collect();
    let size = |pixels: usize| u32::try_from(pixels).map_err(|error| wrong(error.to_string()));
    if ids.len() != width * rows {
        return Err(wrong(format!("{} ids in {width} x {rows} px", ids.len())));
    }
    let mut bytes = Cursor::new(Vec::new());
    let (width, rows) = (size(width)?, size(rows)?);
    image::write_buffer_with_format(&mut bytes, &ids, width, rows, ColorType::L8, ImageFormat::Png)
        .map_err(|error| wrong(error.to_string()))?;
    Ok(bytes.into_inner())
}

/// The ids of a PNG, row by row; each is a class of SemanticKITTI's.
fn ids(file: &Path, width: usize) -> Result<Vec<u8>, DataError> {
    let whole = |found: String| DataError::content(file, "content", "a whole PNG image", found);
    let bytes = files::read(file)?;
    let decoded = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png).decode();
    let decoded = decoded.map_err(|error| whole(error.to_string()))?;
    let DynamicImage::ImageLuma8(grey) = decoded else {
        let colour = decoded.color();
        let (channels, bits) = (colour.channel_count(), colour.bits_per_pixel());
        let found = format!("{channels} channels of {} bits", bits / u16::from(channels.max(1)));
        return Err(DataError::content(file, "pixels", "8 bits of grey, a SemanticKITTI id each", found));
    };
    let ids = grey.into_raw();
    match ids.iter().position(|id| class_name(u16::from(*id)).is_none()) {
        Some(place) => {
            let at = format!("row {}, column {}", place / width, place % width);
            Err(DataError::content(file, at, "a SemanticKITTI id", ids[place].to_string()))
        }
        None => Ok(ids),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::sensors::{Intrinsics, View};
    use ralf::space::Transform;

    fn camera() -> Camera {
        let view = |height| View { yaw: 0.0, pitch: 0.0, horizontal_fov: 1.0, width: 3, height };
        Camera {
            name: "eye".into(),
            vehicle_from_camera: Transform::identity(),
            width: 8,
            height: 8,
            intrinsics: Intrinsics::Pinhole { focal: [2.0; 2], center: [3.5; 2], distortion: [0.0; 5] },
            views: vec![view(2), view(1)],
        }
    }

    fn views() -> Vec<ClassImage> {
        let view = |height, first: u8| ClassImage { width: 3, height, ids: vec![first; 3 * height] };
        vec![view(2, 10), view(1, 252)]
    }

    #[test]
    fn what_is_written_is_read_back() {
        let file = tempfile::tempdir().unwrap().keep().join("000000.png");
        std::fs::write(&file, bytes(&views()).unwrap()).unwrap();
        assert_eq!(read(&file, &camera()).unwrap(), views());
    }

    #[test]
    fn wrong_sizes_colours_and_ids_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("000003.png");
        let says = |content: &[u8], parts: &[&str]| {
            std::fs::write(&file, content).unwrap();
            let error = read(&file, &camera()).unwrap_err().to_string();
            assert!(error.contains("000003.png") && parts.iter().all(|part| error.contains(part)), "{error}");
        };
        let short = bytes(&views()[..1]).unwrap();
        says(&short, &["image size: expected 3 x 3 px", "found 3 x 2 px"]);
        let mut unknown = views();
        unknown[1].ids[2] = 7;
        says(&bytes(&unknown).unwrap(), &["row 2, column 2: expected a SemanticKITTI id, found 7"]);
        let colour = ralf::sensors::CameraImage { width: 3, height: 3, rgb: vec![[10; 3]; 9] };
        says(
            &images::png(&colour).unwrap(),
            &["pixels: expected 8 bits of grey", "found 3 channels of 8 bits"],
        );
        let whole = bytes(&views()).unwrap();
        // The last 12 bytes are the end marker, which decoders don't wait for.
        for length in 0..whole.len() - 12 {
            std::fs::write(&file, &whole[..length]).unwrap();
            assert!(read(&file, &camera()).is_err(), "cut to {length} of {} bytes", whole.len());
        }
        assert!(bytes(&[views().remove(0), ClassImage { width: 1, height: 1, ids: vec![1] }]).is_err());
    }
}
