//! Reading settings from TOML.

use super::error::{ConfigError, in_words};
use super::{Complete, Config, page};
use serde::Deserialize;
use serde::de::DeserializeOwned;
use toml::de::{DeTable, Deserializer};
use toml::{Spanned, Table, Value};

/// The table that has no defaults, for it is named after sensors.
const OF_SENSORS: &str = "sensors";

impl Config {
    /// Settings from a TOML text and assignments `key=value` that win over it; what neither names has its default.
    ///
    /// ```
    /// use ralf::config::Config;
    /// let config = Config::from_toml("[fusion]\nalpha = 0.7", &["lidar.beta=0.5", "ground.model=none"]).unwrap();
    /// assert_eq!((config.fusion.alpha, config.lidar.beta), (0.7, 0.5));
    /// assert!(Config::from_toml("", &["lidar.betta=0.5"]).unwrap_err().to_string().contains("betta"));
    /// ```
    pub fn from_toml(text: &str, assignments: &[&str]) -> Result<Self, ConfigError> {
        Self::from_toml_beside(&[], text, assignments)
    }

    /// [`Self::from_toml`] for a file that holds other tables besides: those of these names are left to whom they
    /// belong to.
    pub fn from_toml_beside(others: &[&str], text: &str, assignments: &[&str]) -> Result<Self, ConfigError> {
        refuse_unknown_in(text, others)?;
        // The text by itself first: its errors then point into its own lines.
        let mut config = spanned(text, |mut table| {
            for name in others {
                table.get_mut().remove(*name);
            }
            page::complete_text(table.get_mut());
            Complete::deserialize(Deserializer::from(table)).map(Self::from)
        })?;
        if !assignments.is_empty() {
            let mut table = assigned(text, assignments)?;
            if let Some(unknown) = table.keys().find(|name| !is_known(name, others)) {
                return Err(unknown_key(unknown, others));
            }
            for name in others {
                table.remove(*name);
            }
            config = completed(table)?;
        }
        config.check()?;
        Ok(config)
    }

    /// Refuses numbers out of the ranges that `config/default.toml` gives: what was read is in them, what a program has
    /// put together may not be.
    ///
    /// # Errors
    /// [`ConfigError::Value`] names the first such setting, its range and what was found.
    pub fn check(&self) -> Result<(), ConfigError> {
        page::check(self)
    }

    /// Whether the LiDAR, the cameras or tracking are asked: without any of them the paper's method calls every
    /// detection an artifact.
    pub fn has_branch(&self) -> bool {
        self.lidar.enabled || self.camera.enabled || self.tracking.enabled
    }

    /// All settings as TOML.
    pub fn to_toml(&self) -> Result<String, ConfigError> {
        toml::to_string(self).map_err(|error| ConfigError::Parse(error.to_string()))
    }
}

impl TryFrom<Table> for Config {
    type Error = ConfigError;

    /// What the table lacks has its default; numbers out of their ranges are refused.
    fn try_from(table: Table) -> Result<Self, ConfigError> {
        let config = completed(table)?;
        config.check()?;
        Ok(config)
    }
}

/// Settings of a table, and the default of what it lacks. Ranges are not looked at.
fn completed(mut table: Table) -> Result<Config, ConfigError> {
    page::complete(&mut table);
    table.try_into().map(|complete: Complete| complete.into()).map_err(|error| parse_error(&error))
}

/// Reads another part of a settings file: whatever a text and the assignments that win over it hold of `T`.
pub fn read_toml<T: DeserializeOwned>(text: &str, assignments: &[&str]) -> Result<T, ConfigError> {
    let read = spanned(text, |table| T::deserialize(Deserializer::from(table)))?;
    if assignments.is_empty() {
        return Ok(read);
    }
    assigned(text, assignments)?.try_into().map_err(|error| parse_error(&error))
}

/// Reads a text's tables, whose values know their places; an error then shows the line.
fn spanned<'a, T>(
    text: &'a str,
    read: impl FnOnce(Spanned<DeTable<'a>>) -> Result<T, toml::de::Error>,
) -> Result<T, ConfigError> {
    DeTable::parse(text).and_then(read).map_err(|mut error| {
        error.set_input(Some(text));
        parse_error(&error)
    })
}

/// Refuses keys of a text that are neither settings nor tables of others. A parser would leave those out of its list.
fn refuse_unknown_in(text: &str, others: &[&str]) -> Result<(), ConfigError> {
    let tables = spanned(text, Ok)?;
    let Some(unknown) = tables.get_ref().keys().find(|name| !is_known(name.get_ref(), others)) else {
        return Ok(());
    };
    let line = text[..unknown.span().start].matches('\n').count() + 1;
    Err(ConfigError::Parse(format!("line {line}: {}", unknown_key(unknown.get_ref(), others))))
}

fn is_known(name: &str, others: &[&str]) -> bool {
    page::DEFAULTS.contains_key(name) || name == OF_SENSORS || others.contains(&name)
}

fn unknown_key(name: &str, others: &[&str]) -> ConfigError {
    let known = page::DEFAULTS.keys().map(String::as_str).chain([OF_SENSORS]).chain(others.iter().copied());
    let known: Vec<String> = known.map(|name| format!("`{name}`")).collect();
    ConfigError::Parse(format!("unknown field `{name}`, expected one of {}", known.join(", ")))
}

fn parse_error(error: &toml::de::Error) -> ConfigError {
    ConfigError::Parse(in_words(&error.to_string()))
}

/// A text's tables with the assignments in them.
fn assigned(text: &str, assignments: &[&str]) -> Result<Table, ConfigError> {
    let mut table = text.parse().map_err(|error| parse_error(&error))?;
    for assignment in assignments {
        assign(&mut table, assignment)?;
    }
    Ok(table)
}

/// Puts `key=value` into the table. The value is TOML, or a number such as `.5`; what is neither is a string, so that
/// quotes may be left out.
fn assign(table: &mut Table, assignment: &str) -> Result<(), ConfigError> {
    let refused = || ConfigError::Assignment(assignment.replace('\n', "\\n").replace('\r', "\\r"));
    // Of several lines only the first would count.
    if assignment.contains(['\n', '\r']) {
        return Err(refused());
    }
    let (key, text) = assignment.split_once('=').ok_or_else(refused)?;
    let value = format!("value = {text}").parse::<Table>().ok().and_then(|mut parsed| parsed.remove("value"));
    let value = value.or_else(|| bare_number(text.trim()).map(Value::Float));
    let value = value.unwrap_or_else(|| Value::String(text.trim().to_owned()));
    let mut names = names_of(key);
    let last = names.pop().filter(|name| !name.is_empty()).ok_or_else(refused)?;
    let mut place = table;
    for name in names {
        let next = place.entry(name).or_insert_with(|| Value::Table(Table::new()));
        place = next.as_table_mut().ok_or_else(refused)?;
    }
    place.insert(last, value);
    Ok(())
}

/// The names in a key. A name that holds a dot stands in quotes, as TOML has it; any other needs none.
fn names_of(key: &str) -> Vec<String> {
    let quoted = Some(key).filter(|key| key.contains(['"', '\'']));
    let parsed = quoted.and_then(|key| format!("{key} = 0").parse::<Table>().ok());
    let Some(parsed) = parsed else { return key.split('.').map(|name| name.trim().to_owned()).collect() };
    let (mut names, mut value) = (Vec::new(), Value::Table(parsed));
    while let Value::Table(table) = value {
        let Some((name, below)) = table.into_iter().next() else { break };
        names.push(name);
        value = below;
    }
    names
}

/// A number that begins or ends with its point, which TOML doesn't know.
fn bare_number(text: &str) -> Option<f64> {
    let is_plain = text.chars().all(|character| character.is_ascii_digit() || "+-.".contains(character));
    if is_plain { text.parse().ok() } else { None }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(text: &str, assignments: &[&str]) -> String {
        Config::from_toml(text, assignments).unwrap_err().to_string()
    }

    #[test]
    fn unknown_keys_are_named() {
        assert!(refusal("[lidar]\nbetta = 1.0", &[]).contains("betta"));
        assert!(refusal("[lidarr]\nbeta = 1.0", &[]).contains("lidarr"));
        assert!(refusal("", &["fusion.aplha=1.0"]).contains("aplha"));
    }

    #[test]
    fn tables_of_others_are_told_and_those_of_the_method_by_their_names() {
        let beside = |text: &str, assignments: &[&str]| {
            Config::from_toml_beside(&["topics"], text, assignments).unwrap_err().to_string()
        };
        for told in [beside("seed = 1\n[lidarr]", &[]), beside("", &["lidarr.beta=1"])] {
            assert!(
                told.contains("unknown field `lidarr`") && told.ends_with("`sensors`, `topics`"),
                "{told}"
            );
        }
        assert!(beside("seed = 1\n[lidarr]", &[]).starts_with("line 2: "));
        assert!(refusal("topics = 1", &[]).ends_with("`sensors`"));
        assert!(refusal("lidar = 3", &[]).contains("expected a table `lidar`"));
        assert!(refusal("", &["ground.model=3"]).contains("expected a name"));
        assert!(refusal("", &["sensors.front=3"]).contains("expected a table"));
    }

    #[test]
    fn values_out_of_range_are_named() {
        assert!(refusal("[fusion]\nalpha = 1.5", &[]).contains("fusion.alpha"));
        assert!(refusal("", &["lidar.neighbours=0"]).contains("lidar.neighbours"));
        assert!(refusal("", &["lidar.beta=nan"]).contains("lidar.beta"));
        assert!(refusal("", &["lidar.beta"]).contains("KEY=VALUE"));
        assert!(refusal("", &["seed=3\nlidar.beta=0.1"]).ends_with("found `seed=3\\nlidar.beta=0.1`"));
        assert!(refusal("", &["ground.model=round"]).contains("round"));
    }

    #[test]
    fn whole_numbers_are_decimals_where_those_are_wanted() {
        assert_eq!(Config::from_toml("[lidar]\nbeta = 1", &["tracking.beta=2"]).unwrap().tracking.beta, 2.0);
        assert_eq!(Config::from_toml("", &["fusion.alpha= .5"]).unwrap().fusion.alpha, 0.5);
        assert!(refusal("", &["fusion.alpha=1.2.3"]).contains("1.2.3"));
    }

    #[test]
    fn a_name_with_a_dot_stands_in_quotes() {
        let range = |key: &str, name: &str| {
            let assignment = format!("sensors.{key}.sigma_range_m=0.2");
            Config::from_toml("", &[&assignment]).unwrap().sensors[name].sigma_range_m
        };
        for key in ["\"radar.front\"", " 'radar.front' "] {
            assert_eq!(range(key, "radar.front"), Some(0.2));
        }
        for name in ["Radar vorn", "it's"] {
            assert_eq!(range(name, name), Some(0.2));
        }
        assert!(refusal("", &["sensors.radar.front.sigma_range_m=0.2"]).contains("front"));
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut config = Config::from_toml("seed = 7", &["sensors.front.sigma_range_m=0.2"]).unwrap();
        config.fusion.alpha = 0.1 + 0.2;
        assert_eq!(Config::from_toml(&config.to_toml().unwrap(), &[]).unwrap(), config);
    }
}
