//! Images from messages.

use super::messages::Messages;
use crate::disk::images;
use ralf::sensors::{Camera, CameraImage, SourceError};
use ralf_ros::container::MessageRef;
use ralf_ros::message::{CompressedImage, Image, Message};

/// An image of a camera as 8-bit colour, refused unless it has the camera's size.
pub(super) fn image(
    messages: &Messages,
    message: &MessageRef,
    camera: &Camera,
) -> Result<CameraImage, SourceError> {
    let odd_size = |place: &'static str, expected, found| messages.error(message, place, expected, found);
    if CompressedImage::DEFINITION.is(&messages.topic(message).type_name) {
        let image: CompressedImage = messages.decode(message)?;
        let expected = format!("a whole JPEG or PNG image, as `{}` says", image.format);
        images::check_size(&image.data, camera, odd_size)?;
        let decoded = images::decode(&image.data);
        return Ok(decoded.map_err(|found| messages.error(message, "data", expected, found))?);
    }
    let image: Image = messages.decode(message)?;
    if let Some(error) = images::size_error([image.width as usize, image.height as usize], camera, odd_size) {
        return Err(error.into());
    }
    Ok(raw(&image).map_err(|(expected, found)| messages.error(message, "data", expected, found))?)
}

/// Rows of pixels as they lie, with what each encoding makes of its bytes.
fn raw(image: &Image) -> Result<CameraImage, (String, String)> {
    let (bytes, order): (usize, [usize; 3]) = match image.encoding.as_str() {
        "rgb8" => (3, [0, 1, 2]),
        "bgr8" => (3, [2, 1, 0]),
        "rgba8" => (4, [0, 1, 2]),
        "bgra8" => (4, [2, 1, 0]),
        "mono8" => (1, [0, 0, 0]),
        other => {
            let expected = "the encoding rgb8, bgr8, rgba8, bgra8 or mono8";
            return Err((expected.to_owned(), format!("`{other}`")));
        }
    };
    let [width, height, step] = [image.width, image.height, image.step].map(|value| value as usize);
    let fits = width.checked_mul(bytes).is_some_and(|row| row <= step)
        && step.checked_mul(height) == Some(image.data.len());
    if !fits {
        let expected = format!("{height} rows of {step} bytes with {width} pixels of {bytes}");
        return Err((expected, format!("{} bytes", image.data.len())));
    }
    let rows = image.data.chunks_exact(step.max(1));
    let pixels = rows.flat_map(|row| row[..width * bytes].chunks_exact(bytes));
    Ok(CameraImage { width, height, rgb: pixels.map(|pixel| order.map(|channel| pixel[channel])).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_without_their_padding() {
        let data = vec![1, 2, 3, 4, 5, 6, 0xee, 7, 8, 9, 10, 11, 12, 0xee];
        let image =
            Image { width: 2, height: 2, step: 7, encoding: "bgr8".to_owned(), data, ..Image::default() };
        let read = raw(&image).unwrap();
        assert_eq!(read.rgb, [[3, 2, 1], [6, 5, 4], [9, 8, 7], [12, 11, 10]]);
        assert!(raw(&Image { step: 5, ..image.clone() }).is_err());
        assert!(raw(&Image { height: u32::MAX, ..image.clone() }).is_err());
        assert!(raw(&Image { encoding: "bayer_rggb8".to_owned(), ..image }).unwrap_err().0.contains("mono8"));
    }

    #[test]
    fn grey_is_grey() {
        let image = Image {
            width: 2,
            height: 1,
            step: 2,
            encoding: "mono8".to_owned(),
            data: vec![5, 6],
            ..Image::default()
        };
        assert_eq!(raw(&image).unwrap().rgb, [[5; 3], [6; 3]]);
    }
}
