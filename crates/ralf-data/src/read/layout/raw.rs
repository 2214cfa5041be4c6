//! `sequence.toml` as the file has it: degrees, plain lists, no checks but the parser's.

use crate::disk::files;
use crate::error::DataError;
use ralf::config::{exact, in_words};
use ralf::sensors::DepthOutput;
use ralf_files::Kind;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// The whole file.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct SequenceToml {
    pub(crate) format: u32,
    pub(crate) name: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) radar: Vec<RadarToml>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) lidar: Vec<LidarToml>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) camera: Vec<CameraToml>,
    #[serde(default)]
    pub(crate) depth: DepthToml,
}

/// `[[radar]]`
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct RadarToml {
    pub(crate) name: String,
    pub(crate) fields: Vec<String>,
    #[serde(deserialize_with = "exact::array")]
    pub(crate) translation: [f64; 3],
    #[serde(deserialize_with = "exact::array")]
    pub(crate) quaternion_xyzw: [f64; 4],
    pub(crate) elevation: ElevationToml,
    pub(crate) fov_azimuth_deg: f64,
    pub(crate) fov_elevation_deg: f64,
    pub(crate) sigma_range_m: f64,
    pub(crate) sigma_azimuth_deg: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) sigma_elevation_deg: Option<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "exact::rows")]
    pub(crate) reliability: Vec<[f64; 2]>,
}

/// Whether a radar measures elevation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum ElevationToml {
    Measured,
    None,
}

/// `[[lidar]]`
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct LidarToml {
    pub(crate) name: String,
    #[serde(deserialize_with = "exact::array")]
    pub(crate) translation: [f64; 3],
    #[serde(deserialize_with = "exact::array")]
    pub(crate) quaternion_xyzw: [f64; 4],
    pub(crate) sigma_range_m: f64,
    pub(crate) lowest_beam_deg: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) max_range_m: Option<f64>,
}

/// `[[camera]]`; which of the optional keys it needs depends on the model.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct CameraToml {
    pub(crate) name: String,
    #[serde(deserialize_with = "exact::array")]
    pub(crate) translation: [f64; 3],
    #[serde(deserialize_with = "exact::array")]
    pub(crate) quaternion_xyzw: [f64; 4],
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) model: ModelToml,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) fx: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) fy: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) cx: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) cy: Option<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) distortion: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) polynomial: Vec<f64>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) inverse_polynomial: Vec<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "exact::optional")]
    pub(crate) center: Option<[f64; 2]>,
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "exact::optional")]
    pub(crate) affine: Option<[f64; 3]>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(crate) view: Vec<ViewToml>,
}

/// The camera model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum ModelToml {
    Pinhole,
    KannalaBrandt,
    Scaramuzza,
}

/// `[[camera.view]]`
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct ViewToml {
    pub(crate) yaw_deg: f64,
    pub(crate) pitch_deg: f64,
    pub(crate) horizontal_fov_deg: f64,
    pub(crate) width: usize,
    pub(crate) height: usize,
}

/// `[depth]`
#[derive(Debug, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct DepthToml {
    pub(crate) output: DepthOutput,
}

impl SequenceToml {
    /// The file, and a sentence for each key in it that has no meaning.
    pub(crate) fn read(file: &Path) -> Result<(Self, Vec<String>), DataError> {
        let text = files::read_text(file, Kind::Settings)?;
        let mut warnings = Vec::new();
        let unknown = |key: serde_ignored::Path<'_>| {
            warnings.push(format!("{}: unknown key `{key}` ignored", file.display()));
        };
        let parsed = toml::Deserializer::parse(&text)
            .and_then(|parser| serde_ignored::deserialize(parser, unknown))
            .map_err(|error| parse_error(file, &text, &error))?;
        Ok((parsed, warnings))
    }
}

/// The parser's message, sorted into what was expected and found, with the line and the table that it is about.
fn parse_error(file: &Path, text: &str, error: &toml::de::Error) -> DataError {
    let before = error.span().map_or("", |span| &text[..span.start]);
    let line = before.matches('\n').count();
    let table = text.lines().take(line + 1).filter(|line| line.trim_start().starts_with('[')).last();
    let place = match table {
        Some(table) => format!("line {}, {}", line + 1, table.split('#').next().unwrap_or(table).trim()),
        None => format!("line {}", line + 1),
    };
    let message = in_words(error.message());
    if let Some(key) = message.strip_prefix("missing field ") {
        return DataError::content(file, place, format!("the key {key}"), "none");
    }
    match message.split_once(", expected ") {
        Some((found, expected)) => DataError::content(file, place, expected, found),
        None => DataError::content(file, place, "TOML", message),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<(SequenceToml, Vec<String>), String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        SequenceToml::read(file.path()).map_err(|error| error.to_string())
    }

    const LIDAR: &str = "format = 1\r\nname = \"a\"\r\n\r\n[[lidar]] # on the roof\r\nname = \"top\"\r\n\
        translation = [1, 0, 1.9]\r\nquaternion_xyzw = [0, 0, 0, 1]\r\nsigma_range_m = 0.03\r\n\
        lowest_beam_deg = 25\r\n";

    #[test]
    fn unknown_keys_are_warnings() {
        let (parsed, warnings) = read(&format!("{LIDAR}colour = 3\n[weather]\nrain = true\n")).unwrap();
        assert_eq!(parsed.lidar[0].translation, [1.0, 0.0, 1.9]);
        assert_eq!(warnings.len(), 2);
        assert!(warnings[0].ends_with(": unknown key `lidar.0.colour` ignored"), "{warnings:?}");
        assert!(warnings[1].ends_with(": unknown key `weather` ignored"), "{warnings:?}");
    }

    #[test]
    fn missing_and_wrong_keys_are_named_with_line_and_table() {
        for (from, to, expected) in [
            (
                "sigma_range_m = 0.03\r\n",
                "",
                "line 4, [[lidar]]: expected the key `sigma_range_m`, found none",
            ),
            ("0.03", "\"much\"", "line 8, [[lidar]]: expected a number, found invalid type: string \"much\""),
            (
                "[1, 0, 1.9]",
                "[1, 0]",
                "line 6, [[lidar]]: expected an array of length 3, found invalid length 2",
            ),
            (
                "[1, 0, 1.9]",
                "[1, 0, 1.9, 0]",
                "line 6, [[lidar]]: expected an array of length 3, found invalid length 4",
            ),
            ("0.03", "", "line 8, [[lidar]]: expected "),
            ("name = \"a\"", "", "expected the key `name`, found none"),
        ] {
            let error = read(&LIDAR.replacen(from, to, 1)).unwrap_err();
            assert!(error.contains(expected), "{error} lacks {expected}");
        }
    }
}
