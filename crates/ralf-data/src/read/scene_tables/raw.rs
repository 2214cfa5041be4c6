//! The tables as they lie on disk: JSON arrays of rows, read row by row, for `sample_data.json` of the whole data set
//! is larger than most memories hold as JSON values. Keys that aren't needed are skipped.

use crate::disk::files;
use crate::disk::json;
use crate::error::DataError;
use serde::de::{DeserializeOwned, DeserializeSeed, Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use std::io::BufReader;
use std::marker::PhantomData;
use std::path::Path;

/// A row's key: 32 hex digits, or any shorter text (padded with zero bytes). Millions of them are held while joining.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Token([u8; 32]);

impl<'de> Deserialize<'de> for Token {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Text;
        impl Visitor<'_> for Text {
            type Value = Token;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a token of at most 32 characters")
            }

            fn visit_str<E: Error>(self, text: &str) -> Result<Token, E> {
                let mut bytes = [0; 32];
                let place =
                    bytes.get_mut(..text.len()).ok_or_else(|| E::invalid_length(text.len(), &self))?;
                place.copy_from_slice(text.as_bytes());
                Ok(Token(bytes))
            }
        }
        deserializer.deserialize_str(Text)
    }
}

impl fmt::Display for Token {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(String::from_utf8_lossy(&self.0).trim_end_matches('\0'))
    }
}

/// What a sensor is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Modality {
    Radar,
    Lidar,
    Camera,
    /// Inertial ones and whatever else a vehicle carries.
    #[serde(other)]
    Other,
}

/// `sensor.json`
#[derive(Deserialize)]
pub(crate) struct SensorRow {
    pub(crate) token: Token,
    pub(crate) channel: String,
    pub(crate) modality: Modality,
}

/// `calibrated_sensor.json`: the sensor in the ego frame.
#[derive(Deserialize)]
pub(crate) struct CalibratedSensorRow {
    pub(crate) token: Token,
    pub(crate) sensor_token: Token,
    /// m
    pub(crate) translation: [f64; 3],
    /// w x y z
    pub(crate) rotation: [f64; 4],
    /// Three rows for a camera, else none.
    pub(crate) camera_intrinsic: Vec<[f64; 3]>,
}

/// `scene.json`
#[derive(Deserialize)]
pub(crate) struct SceneRow {
    pub(crate) token: Token,
    pub(crate) log_token: Token,
    pub(crate) name: String,
    pub(crate) description: String,
}

/// `sample.json`
#[derive(Deserialize)]
pub(crate) struct SampleRow {
    pub(crate) token: Token,
    pub(crate) scene_token: Token,
}

/// `sample_data.json`: one measurement of one sensor.
#[derive(Deserialize)]
pub(crate) struct SampleDataRow {
    pub(crate) token: Token,
    pub(crate) sample_token: Token,
    pub(crate) ego_pose_token: Token,
    pub(crate) calibrated_sensor_token: Token,
    #[serde(rename = "timestamp", deserialize_with = "nanoseconds")]
    pub(crate) t_ns: i64,
    /// Relative to the data set's folder.
    pub(crate) filename: Box<str>,
    /// px, of cameras.
    pub(crate) width: usize,
    /// px, of cameras.
    pub(crate) height: usize,
}

/// `ego_pose.json`: the ego frame in the global frame.
#[derive(Deserialize)]
pub(crate) struct EgoPoseRow {
    pub(crate) token: Token,
    #[serde(rename = "timestamp", deserialize_with = "nanoseconds")]
    pub(crate) t_ns: i64,
    /// m
    pub(crate) translation: [f64; 3],
    /// w x y z
    pub(crate) rotation: [f64; 4],
}

/// Microseconds on disk.
pub(crate) fn nanoseconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<i64, D::Error> {
    let microseconds = i64::deserialize(deserializer)?;
    microseconds
        .checked_mul(1000)
        .ok_or_else(|| D::Error::custom(format!("time of {microseconds} us out of range")))
}

/// Hands the rows of a table over, one by one. What `take` refuses becomes an error at the row's place in the file.
pub(crate) fn for_each_row<T: DeserializeOwned>(
    file: &Path,
    take: impl FnMut(T) -> Result<(), String>,
) -> Result<(), DataError> {
    let open = files::open(file)?;
    let mut deserializer = serde_json::Deserializer::from_reader(BufReader::with_capacity(1 << 16, open));
    let rows = Rows { take, row: PhantomData };
    rows.deserialize(&mut deserializer)
        .and_then(|()| deserializer.end())
        .map_err(|error| unreadable(file, error))
}

fn unreadable(file: &Path, error: serde_json::Error) -> DataError {
    if error.is_io() {
        return DataError::Io { file: file.to_owned(), error: error.into() };
    }
    json::unreadable(file, "a table of rows, joined to the others by its tokens", &error)
}

/// A JSON array, taken row by row.
struct Rows<T, F> {
    take: F,
    row: PhantomData<T>,
}

impl<'de, T: DeserializeOwned, F: FnMut(T) -> Result<(), String>> DeserializeSeed<'de> for Rows<T, F> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        deserializer.deserialize_seq(self)
    }
}

impl<'de, T: DeserializeOwned, F: FnMut(T) -> Result<(), String>> Visitor<'de> for Rows<T, F> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an array of rows")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut rows: A) -> Result<(), A::Error> {
        while let Some(row) = rows.next_element()? {
            (self.take)(row).map_err(A::Error::custom)?;
        }
        Ok(())
    }
}
