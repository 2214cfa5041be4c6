//! Images, as they lie there.

use crate::app::{App, measurement};
use crate::http::{Answer, ApiError, content};
use axum::http::{HeaderValue, header};
use ralf_data::{DataError, png};
use ralf_files::Kind;
use std::path::{Component, Path};

/// What files of these kinds begin with.
const KINDS: [(&[u8], &str); 2] = [(b"\xFF\xD8\xFF", "image/jpeg"), (b"\x89PNG\r\n\x1A\n", "image/png")];

/// An image of a camera: its file, or a PNG of one that lies within a larger file.
pub(crate) fn image(app: &App, sequence: &str, camera: &str, image: usize) -> Answer {
    let (_, reader) = app.sequence(sequence)?;
    let known = reader.sequence();
    let names = known.rig.cameras.iter().map(|camera| camera.name.as_str());
    let (index, _) = measurement("camera", names, &known.times.cameras, camera, image)?;
    let (kind, bytes) = match reader.image_file(index, image) {
        Some(file) => of_file(&app.recording.path, &file)?,
        None => ("image/png", png(&reader.image(index, image)?).map_err(ApiError::Broken)?),
    };
    let mut response = content(kind, bytes);
    response.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("private, max-age=86400"));
    Ok(response)
}

/// A file of a recording, and what it is.
fn of_file(recording: &Path, file: &Path) -> Result<(&'static str, Vec<u8>), ApiError> {
    if !lies_in(recording, file) {
        let file = file.display();
        return Err(ApiError::Forbidden(format!(
            "{file}: expected a file of the recording, found one elsewhere"
        )));
    }
    let bytes = ralf_files::read(file, Kind::Measurement).map_err(DataError::io(file))?;
    let kind = KINDS
        .iter()
        .find(|(begin, _)| bytes.starts_with(begin))
        .ok_or_else(|| DataError::content(file, "first bytes", "those of a JPEG or PNG image", "others"))?;
    Ok((kind.1, bytes))
}

/// Whether a file lies below a folder: a recording's tables may name any file.
fn lies_in(folder: &Path, file: &Path) -> bool {
    let below = file.strip_prefix(folder).ok();
    below.is_some_and(|path| path.components().all(|part| matches!(part, Component::Normal(_))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_images_of_the_recording_are_sent() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.png");
        std::fs::write(&file, b"\x89PNG\r\n\x1A\n and more").unwrap();
        assert_eq!(of_file(folder.path(), &file).unwrap().0, "image/png");
        assert!(matches!(of_file(&folder.path().join("recording"), &file), Err(ApiError::Forbidden(_))));
        std::fs::write(&file, "root:x:0:0").unwrap();
        assert!(matches!(of_file(folder.path(), &file), Err(ApiError::Broken(_))));
    }

    #[test]
    fn files_elsewhere_are_told_from_those_below() {
        let lies = |file: &str| lies_in(Path::new("data/town"), Path::new(file));
        assert!(lies("data/town/sequences/00/camera/000000.jpg"));
        for elsewhere in
            ["data/town/../secret.png", "data/towns/a.png", "/etc/passwd", "data/town/a/../../../b"]
        {
            assert!(!lies(elsewhere), "{elsewhere}");
        }
    }
}
