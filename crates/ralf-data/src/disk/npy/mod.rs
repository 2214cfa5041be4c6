//! Depth images as NumPy stores them: `.npy` of float32, little-endian, in C order, (H, W) or (views, H, W). Tables of
//! named columns are read by [`records`].
//!
//! The file has a short Python dict as its header (NEP 1); anything but this one kind of array is refused, and so is a
//! shape that isn't the size of the file, before memory is asked for.

pub(crate) mod records;

use crate::disk::files;
use crate::error::DataError;
use ralf::sensors::DepthImage;
use std::path::Path;

const MAGIC: &[u8] = b"\x93NUMPY";

/// The depth images in a file.
pub(crate) fn read_depth(file: &Path) -> Result<Vec<DepthImage>, DataError> {
    let bytes = files::read(file)?;
    let (header, data) = split(&bytes).ok_or_else(|| {
        DataError::content(file, "byte 0", "a NumPy file with its header", "something else")
    })?;
    let wrong = |key: &str, expected: &str, found: &str| DataError::content(file, key, expected, found);
    let descr = value(header, "descr").unwrap_or("nothing");
    if !descr.starts_with("'<f4'") {
        return Err(wrong("descr", "'<f4' (little-endian float32)", until_comma(descr)));
    }
    let order = value(header, "fortran_order").unwrap_or("nothing");
    if !order.starts_with("False") {
        return Err(wrong("fortran_order", "False (C order)", until_comma(order)));
    }
    let [views, height, width] = value(header, "shape")
        .and_then(shape)
        .ok_or_else(|| wrong("shape", "(H, W) or (views, H, W), none of them 0", header.trim()))?;
    let pixels = height.checked_mul(width);
    let size = pixels.and_then(|n| n.checked_mul(views)).and_then(|n| n.checked_mul(size_of::<f32>()));
    let (Some(pixels), true) = (pixels, size == Some(data.len())) else {
        let expected = format!("{views} x {height} x {width} float32, as the header says");
        return Err(wrong("data", &expected, &format!("{} bytes", data.len())));
    };
    let values = data.as_chunks::<4>().0.chunks_exact(pixels);
    let image = |view: &[[u8; 4]]| view.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    Ok(values.map(|view| DepthImage { width, height, values: image(view) }).collect())
}

/// The bytes of a file that holds these images: (H, W) of one, (views, H, W) of several. `None` if there is none, or if
/// they differ in size, which such a file can't hold.
pub(crate) fn depth_bytes(images: &[DepthImage]) -> Option<Vec<u8>> {
    let DepthImage { width, height, .. } = images.first()?;
    if images.iter().any(|image| (image.width, image.height) != (*width, *height)) {
        return None;
    }
    let views = if images.len() > 1 { format!("{}, ", images.len()) } else { String::new() };
    let mut bytes = header("<f4", &format!("{views}{height}, {width}"));
    for image in images {
        bytes.extend(files::f32_bytes(image.values.iter().copied()));
    }
    Some(bytes)
}

/// All that comes before the values of an array in C order: `descr` is NumPy's name of their type, `shape` what stands
/// between the brackets.
pub(crate) fn header(descr: &str, shape: &str) -> Vec<u8> {
    let dict = format!("{{'descr': '{descr}', 'fortran_order': False, 'shape': ({shape}), }}");
    // Data starts at a multiple of 64 bytes: magic, version and length take 10, the line end 1.
    let length = (dict.len() + 11).next_multiple_of(64) - 10;
    let dict = format!("{dict:<width$}\n", width = length - 1);
    [MAGIC, &[1, 0], &(length as u16).to_le_bytes(), dict.as_bytes()].concat()
}

/// Header and data. Versions differ in how many bytes the header's length takes.
fn split(bytes: &[u8]) -> Option<(&str, &[u8])> {
    let rest = bytes.strip_prefix(MAGIC)?;
    let (version, rest) = rest.split_first_chunk::<2>()?;
    let (length, rest) = match version[0] {
        1 => {
            rest.split_first_chunk().map(|(length, rest)| (usize::from(u16::from_le_bytes(*length)), rest))?
        }
        2 | 3 => {
            let (length, rest) = rest.split_first_chunk()?;
            (usize::try_from(u32::from_le_bytes(*length)).ok()?, rest)
        }
        _ => return None,
    };
    let (header, data) = rest.split_at_checked(length)?;
    Some((str::from_utf8(header).ok()?, data))
}

/// What follows a key of the header.
fn value<'a>(header: &'a str, key: &str) -> Option<&'a str> {
    let (_, after) = header.split_once(&format!("'{key}':"))?;
    Some(after.trim_start())
}

fn until_comma(value: &str) -> &str {
    value.split(',').next().unwrap_or(value)
}

/// Views, height and width of a shape's text; no array is empty.
fn shape(text: &str) -> Option<[usize; 3]> {
    let (inside, _) = text.strip_prefix('(')?.split_once(')')?;
    let sizes: Vec<usize> =
        inside.split(',').map(|size| size.trim().parse()).collect::<Result<_, _>>().ok()?;
    let shape = match *sizes {
        [height, width] => [1, height, width],
        [views, height, width] => [views, height, width],
        _ => return None,
    };
    (!shape.contains(&0)).then_some(shape)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(bytes: &[u8]) -> Result<Vec<DepthImage>, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        read_depth(file.path()).map_err(|error| error.to_string())
    }

    fn npy(header: &str, data: &[u8]) -> Vec<u8> {
        let length = u16::try_from(header.len()).unwrap().to_le_bytes();
        [MAGIC, &[1, 0], &length, header.as_bytes(), data].concat()
    }

    #[test]
    fn written_is_read_back() {
        let image = |first: f32| DepthImage { width: 3, height: 1, values: vec![first, -0.0, 1e-40] };
        for images in [vec![image(1.0)], vec![image(1.0), image(2.0)]] {
            let bytes = depth_bytes(&images).unwrap();
            assert_eq!((bytes.len() - 12 * images.len()) % 64, 0);
            assert_eq!(read(&bytes).unwrap(), images);
        }
        assert!(depth_bytes(&[]).is_none());
        assert!(
            depth_bytes(&[image(1.0), DepthImage { width: 1, height: 3, values: vec![0.0; 3] }]).is_none()
        );
    }

    #[test]
    fn what_numpy_itself_writes_is_read() {
        // np.save of np.array([[1, 2]], "<f4"), as NumPy 2 pads it.
        let header = format!("{:<117}\n", "{'descr': '<f4', 'fortran_order': False, 'shape': (1, 2), }");
        let data: Vec<u8> = [1.0f32, 2.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        assert_eq!(read(&npy(&header, &data)).unwrap()[0].values, [1.0, 2.0]);
    }

    #[test]
    fn other_arrays_and_absurd_shapes_are_refused() {
        let header = |descr: &str, order: &str, shape: &str| {
            npy(&format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}"), &[0; 8])
        };
        for (bytes, part) in [
            (header("'<f8'", "False", "(1, 1)"), "descr: expected '<f4'"),
            (header("'>f4'", "False", "(1, 2)"), "found '>f4'"),
            (header("'<f4'", "True", "(1, 2)"), "fortran_order: expected False"),
            (header("'<f4'", "False", "(2,)"), "shape: expected (H, W)"),
            (header("'<f4'", "False", "(0, 2)"), "shape: expected (H, W)"),
            (header("'<f4'", "False", "(-1, 2)"), "shape: expected (H, W)"),
            (header("'<f4'", "False", "(1, 3)"), "data: expected 1 x 1 x 3 float32"),
            (header("'<f4'", "False", "(4294967296, 4294967296, 4294967296)"), "data: expected"),
            (header("'<f4'", "False", "(9999999999, 1000000000)"), "data: expected"),
            (b"\x93NUMPY\x02\x00\xff\xff\xff\xff{}".to_vec(), "a NumPy file"),
            (b"PK".to_vec(), "a NumPy file"),
        ] {
            let error = read(&bytes).unwrap_err();
            assert!(error.contains(part), "{error} lacks {part}");
        }
    }
}
