//! Images as `sensor_msgs/CompressedImage`, calibrations as `sensor_msgs/CameraInfo`.

use crate::disk::images;
use crate::read::SequenceReader;
use ralf::sensors::{Camera, Intrinsics, SourceError};
use ralf_ros::message::{CameraInfo, CompressedImage, Header};

/// A camera's image as its file is, or as PNG where it has none.
pub(super) fn image(
    header: Header,
    reader: &dyn SequenceReader,
    camera: usize,
    image: usize,
) -> Result<CompressedImage, SourceError> {
    let Some(file) = reader.image_file(camera, image) else {
        let data = images::png(&reader.image(camera, image)?)?;
        return Ok(CompressedImage { header, format: "png".to_owned(), data });
    };
    let extension = file.extension().unwrap_or_default().to_ascii_lowercase();
    let format = if extension == "png" { "png" } else { "jpeg" };
    Ok(CompressedImage { header, format: format.to_owned(), data: images::read_bytes(&file)? })
}

/// A camera's calibration; `None` of a model that ROS doesn't have.
pub(super) fn camera_info(header: Header, camera: &Camera) -> Option<CameraInfo> {
    let (model, focal, center, d) = match &camera.intrinsics {
        Intrinsics::Pinhole { focal, center, distortion } => {
            ("plumb_bob", focal, center, distortion.to_vec())
        }
        Intrinsics::KannalaBrandt { focal, center, distortion } => {
            ("equidistant", focal, center, distortion.to_vec())
        }
        Intrinsics::Scaramuzza { .. } => return None,
    };
    let ([fx, fy], [cx, cy]) = (*focal, *center);
    Some(CameraInfo {
        header,
        height: camera.height as u32,
        width: camera.width as u32,
        distortion_model: model.to_owned(),
        d,
        k: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        r: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        p: [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        ..CameraInfo::default()
    })
}
