//! A settings file: the method's settings, and which topic of a ROS recording is which sensor.

use crate::disk::files;
use crate::error::DataError;
use crate::read::ros::{Topics, check_topics};
use crate::read::{MotionSettings, Recording, SensorCorrection, corrected, idle};
use ralf::config::{Config, ConfigError, read_toml};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};
use toml::{Table, Value};

/// Tables that readers of recordings know, and the method does not.
const OF_READERS: [&str; 3] = ["topics", "corrections", "motion"];

/// All that a settings file may hold. Every key is optional, and unknown keys are refused.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(try_from = "toml::Table")]
pub struct Settings {
    /// The method's.
    #[serde(flatten)]
    pub method: Config,
    /// `topics`.
    #[serde(skip_serializing_if = "Topics::is_empty")]
    pub topics: Topics,
    /// `corrections`: by sensor name, what is added to what the recording says of it.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub corrections: BTreeMap<String, SensorCorrection>,
    /// `motion`: where the vehicle's motion comes from.
    #[serde(skip_serializing_if = "is_default")]
    pub motion: MotionSettings,
}

fn is_default(motion: &MotionSettings) -> bool {
    *motion == MotionSettings::default()
}

/// The readers' tables alone, whatever else a file holds.
#[derive(Deserialize)]
struct OfReaders {
    #[serde(default)]
    topics: Topics,
    #[serde(default)]
    corrections: BTreeMap<String, SensorCorrection>,
    #[serde(default)]
    motion: MotionSettings,
}

impl Settings {
    /// Settings from a TOML text and assignments `key=value` that win over it.
    pub fn from_toml(text: &str, assignments: &[&str]) -> Result<Self, ConfigError> {
        let method = Config::from_toml_beside(&OF_READERS, text, assignments)?;
        let OfReaders { topics, corrections, motion } = read_toml(text, assignments)?;
        check_topics(&topics)?;
        check_numbers(&corrections, &motion)?;
        Ok(Self { method, topics, corrections, motion })
    }

    /// A recording as the tables `sensors`, `corrections` and `motion` have it. Where it knows no motion, that is taken
    /// from the radars' range rates, else from a LiDAR's scans. Refused: names that no sensor has, files that hold no
    /// poses, and one such file for several sequences. A sequence whose motion nobody knows is refused if it was named,
    /// or if there is no other; else it is [left out](Recording::incomplete). Refused as well: what changes nothing of
    /// the recording (`trajectory_frame` and `trajectory_order` without a trajectory, `tick_ms` without `period_ms`,
    /// `yaw_rate_factor` of poses).
    pub fn correct(&self, recording: Recording) -> Result<Recording, DataError> {
        idle::refuse_alone(&recording.path, &self.corrections, &self.motion)?;
        let corrected = self.correct_labelled(recording, |_| true)?;
        idle::refuse_yaw_rate_factor(&corrected, &self.motion)?;
        Ok(corrected)
    }

    /// The same with a recording of which these sequences were labelled with these settings. A trajectory was theirs,
    /// and says nothing of others: those stay as they are.
    pub fn correct_labelled(
        &self,
        recording: Recording,
        is_labelled: impl Fn(&str) -> bool,
    ) -> Result<Recording, DataError> {
        let is_concerned = |name: &str| self.motion.trajectory.is_none() || is_labelled(name);
        corrected(recording, &self.method, &self.corrections, &self.motion, &is_concerned)
    }

    /// The same, with paths that lead to the same files from every folder.
    pub(crate) fn anywhere(&self) -> Self {
        let mut settings = self.clone();
        settings.motion.trajectory = self.motion.trajectory.as_deref().map(plain);
        settings
    }

    /// The text of several settings files as that of one: a later file wins over an earlier one, key by key. A single
    /// text stays as it is.
    pub fn joined(texts: &[String]) -> Result<String, ConfigError> {
        let refused = |error: &dyn std::fmt::Display| ConfigError::Parse(error.to_string());
        match texts {
            [] => Ok(String::new()),
            [text] => Ok(text.clone()),
            texts => {
                let mut table = Table::new();
                for text in texts {
                    put_over(&mut table, text.parse().map_err(|error| refused(&error))?);
                }
                toml::to_string(&table).map_err(|error| refused(&error))
            }
        }
    }

    /// All settings as TOML.
    pub fn to_toml(&self) -> Result<String, ConfigError> {
        toml::to_string(self).map_err(|error| ConfigError::Parse(error.to_string()))
    }
}

/// A path that leads to the same file from every folder, the same wherever it was typed: without `..`, unless these go
/// through links. Links stay, for they may lead elsewhere on other machines.
fn plain(file: &Path) -> PathBuf {
    let whole = files::whole(file);
    let mut plain = PathBuf::new();
    for part in whole.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            part => plain.push(part),
        }
    }
    let is_same =
        matches!((plain.canonicalize(), whole.canonicalize()), (Ok(one), Ok(other)) if one == other);
    if is_same { plain } else { whole }
}

impl TryFrom<Table> for Settings {
    type Error = ConfigError;

    fn try_from(mut table: Table) -> Result<Self, ConfigError> {
        let mut own = Table::new();
        for name in OF_READERS {
            own.extend(table.remove_entry(name));
        }
        let own = Value::Table(own).try_into::<OfReaders>();
        let OfReaders { topics, corrections, motion } =
            own.map_err(|error| ConfigError::Parse(error.to_string()))?;
        check_numbers(&corrections, &motion)?;
        Ok(Self { method: Config::try_from(table)?, topics, corrections, motion })
    }
}

/// Puts one table's keys over those of another, table by table.
fn put_over(below: &mut Table, above: Table) {
    for (key, value) in above {
        match (below.get_mut(&key), value) {
            (Some(Value::Table(below)), Value::Table(above)) => put_over(below, above),
            (_, value) => drop(below.insert(key, value)),
        }
    }
}

/// Refuses what is no number, or none that anything can be corrected by.
fn check_numbers(
    corrections: &BTreeMap<String, SensorCorrection>,
    motion: &MotionSettings,
) -> Result<(), ConfigError> {
    let refused = |key, expected: &str, found| ConfigError::Value {
        key,
        expected: format!("{expected}, found {found:e}"),
    };
    let of_sensors = corrections.iter().flat_map(|(name, correction)| {
        correction.numbers().map(move |(key, value)| (format!("corrections.{name}.{key}"), value))
    });
    let of_motion = motion.numbers().map(|(key, value)| (format!("motion.{key}"), value));
    if let Some((key, found)) =
        of_sensors.chain(of_motion).find(|(_, value)| value.abs() > MOST || value.is_nan())
    {
        return Err(refused(key, &format!("a number from -{MOST:e} to {MOST:e}"), found));
    }
    for (name, SensorCorrection { position_factor, doppler_factor, .. }) in corrections {
        let key = |key: &str| format!("corrections.{name}.{key}");
        if *position_factor <= 0.0 {
            return Err(refused(key("position_factor"), "a number above 0", *position_factor));
        }
        if *doppler_factor == 0.0 {
            return Err(refused(key("doppler_factor"), "a number other than 0", *doppler_factor));
        }
    }
    Ok(())
}

/// Nothing larger is in any use: a clock can be off by no more milliseconds, for times are told in nanoseconds.
const MOST: f64 = 9e12;

#[cfg(test)]
mod tests {
    use super::*;

    const BOTH: &str =
        "seed = 7\n[topics.odom]\ntopic = \"/odom\"\nkind = \"odometry\"\n[fusion]\nalpha = 0.25\n";

    #[test]
    fn the_method_and_the_topics_stand_in_one_file() {
        let settings = Settings::from_toml(BOTH, &["topics.odom.topic=/wheels", "lidar.beta=0.5"]).unwrap();
        assert_eq!(
            (settings.method.seed, settings.method.fusion.alpha, settings.method.lidar.beta),
            (7, 0.25, 0.5)
        );
        assert_eq!(settings.topics["odom"].topic, "/wheels");
        assert_eq!(Settings::from_toml(&settings.to_toml().unwrap(), &[]).unwrap(), settings);
        let json = serde_json::to_string(&settings).unwrap();
        assert_eq!(serde_json::from_str::<Settings>(&json).unwrap(), settings);
    }

    #[test]
    fn a_later_file_wins_key_by_key() {
        let texts = [BOTH, "[fusion]\nthreshold = 0.5\n[topics.odom]\ntopic = \"/wheels\"\n", "seed = 9\n"];
        let joined = Settings::joined(&texts.map(str::to_owned)).unwrap();
        let settings = Settings::from_toml(&joined, &[]).unwrap();
        let Config { seed, fusion, .. } = settings.method;
        assert_eq!((seed, fusion.alpha, fusion.threshold), (9, 0.25, 0.5));
        assert_eq!(settings.topics["odom"].topic, "/wheels");
        assert_eq!(Settings::joined(&[BOTH.to_owned()]).unwrap(), BOTH);
        assert_eq!(Settings::joined(&[]).unwrap(), "");
    }

    #[test]
    fn a_trajectory_is_the_same_from_wherever_it_was_typed() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("poses.tum");
        std::fs::write(&file, "").unwrap();
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        let typed = |path: &str| {
            let mut settings = Settings::default();
            settings.motion.trajectory = Some(folder.path().join(path));
            settings.anywhere().motion.trajectory.unwrap()
        };
        assert_eq!(typed("sub/../poses.tum"), file);
        assert_eq!(typed("sub/.././poses.tum"), file);
        assert!(typed("gone/../nothing.tum").ends_with("gone/../nothing.tum"));
    }

    #[test]
    fn what_is_no_number_corrects_nothing() {
        for key in ["corrections.front.add_yaw_deg", "corrections.front.period_ms", "motion.speed_factor"] {
            for value in ["nan", "inf", "-1e300"] {
                let refused = Settings::from_toml("", &[&format!("{key}={value}")]).unwrap_err().to_string();
                assert!(refused.contains(key) && refused.contains("found"), "{refused}");
            }
        }
        for factor in ["position_factor=0", "position_factor=-1", "doppler_factor=0"] {
            let refused = Settings::from_toml("", &[&format!("corrections.front.{factor}")]).unwrap_err();
            assert!(refused.to_string().contains("_factor`: expected a number "), "{refused}");
        }
        assert!(Settings::from_toml("", &["corrections.front.doppler_factor=-1"]).is_ok(), "another sign");
        let place = "corrections.front.add_translation=[0, nan, 0]";
        assert!(Settings::from_toml("", &[place]).is_err());
        assert!(Settings::from_toml("", &["corrections.front.tick_ms=1.7e12"]).is_ok(), "since 1970");
    }

    #[test]
    fn unknown_keys_are_refused_with_their_line() {
        let refusal = |text: &str| Settings::from_toml(text, &[]).unwrap_err().to_string();
        for (text, key, line) in [
            (format!("{BOTH}aplha = 1.0"), "aplha", "line 7"),
            (format!("{BOTH}[lidarr]"), "lidarr", "line 7"),
            (BOTH.replace("topic =", "topik ="), "topik", "line 3"),
        ] {
            let found = refusal(&text);
            assert!(found.contains(key) && found.contains(line), "{found}");
        }
        assert!(
            serde_json::from_str::<Settings>("{\"lidarr\": {}}").unwrap_err().to_string().contains("lidarr")
        );
    }
}
