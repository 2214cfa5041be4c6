//! Images, as they lie there.

use crate::app::{App, measurement};
use crate::http::{Answer, ApiError, content};
use axum::http::{HeaderValue, header};
use ralf_data::DataError;
use std::path::{Component, Path};

/// What files of these kinds begin with.
const KINDS: [(&[u8], &str); 2] = [(b"\xFF\xD8\xFF", "image/jpeg"), (b"\x89PNG\r\n\x1A\n", "image/png")];

/// An image of a camera.
pub(crate) fn image(app: &App, sequence: &str, camera: &str, image: usize) -> Answer {
    let (_, reader) = app.sequence(sequence)?;
    let known = reader.sequence();
    let names = known.rig.cameras.iter().map(|camera| camera.name.as_str());
    let (index, _) = measurement("camera", names, &known.times.cameras, camera, image)?;
    let no_file = || ApiError::unknown(camera, "none", &format!("a file of image {image}"));
    let file = reader.image_file(index, image).ok_or_else(no_file)?;
    if !lies_in(&app.recording.path, &file) {
        let file = file.display();
        return Err(ApiError::Forbidden(format!(
            "{file}: expected a file of the recording, found one elsewhere"
        )));
    }
    let bytes = std::fs::read(&file).map_err(DataError::io(&file))?;
    let kind = KINDS
        .iter()
        .find(|(begin, _)| bytes.starts_with(begin))
        .ok_or_else(|| DataError::content(&file, "first bytes", "those of a JPEG or PNG image", "others"))?;
    let mut response = content(kind.1, bytes);
    response.headers_mut().insert(header::CACHE_CONTROL, HeaderValue::from_static("private, max-age=86400"));
    Ok(response)
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
