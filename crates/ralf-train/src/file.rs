//! Tuned settings as a settings file.

use super::TunedSettings;
use ralf::config::ConfigError;
use serde::Serialize;
use toml::{Table, Value};

/// A settings file: the comment, each line of it behind a `#`, then all tuned settings and whatever else differs from
/// the built-in defaults. Reading it back gives the same settings: a [`Config`](ralf::config::Config), or one with
/// tables besides.
pub fn settings_file<T: Serialize + Default>(comment: &str, settings: &T) -> Result<String, ConfigError> {
    let refused = |error: &dyn std::fmt::Display| ConfigError::Parse(error.to_string());
    let all = Table::try_from(settings).map_err(|error| refused(&error))?;
    let defaults = Table::try_from(T::default()).map_err(|error| refused(&error))?;
    let selected = select("", &all, &defaults);
    let text = toml::to_string(&selected).map_err(|error| refused(&error))?;
    let comment: String =
        comment.lines().map(|line| format!("# {line}").trim_end().to_owned() + "\n").collect();
    Ok(format!("{comment}\n{text}"))
}

/// What is tuned, or differs from the defaults.
fn select(section: &str, all: &Table, defaults: &Table) -> Table {
    let mut selected = Table::new();
    for (name, value) in all {
        let key = if section.is_empty() { name.clone() } else { format!("{section}.{name}") };
        let default = defaults.get(name);
        match (value, default) {
            (Value::Table(values), Some(Value::Table(defaults))) => {
                let values = select(&key, values, defaults);
                if !values.is_empty() {
                    selected.insert(name.clone(), Value::Table(values));
                }
            }
            _ if default != Some(value) || TunedSettings::KEYS.contains(&key.as_str()) => {
                selected.insert(name.clone(), value.clone());
            }
            _ => {}
        }
    }
    selected
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::config::Config;

    #[test]
    fn only_what_matters_is_written_and_read_back() {
        let assignments = [
            "seed=7",
            "ground.model=flat",
            "sensors.front.sigma_range_m=0.2",
            "fusion.alpha=0.5",
            "fusion.threshold=0.315",
            "camera.beta=0.2",
            "tracking.beta=0.2",
            "lidar.enabled=true",
        ];
        let config = Config::from_toml("", &assignments).unwrap();
        let text = settings_file("tuned\n\non \"00\"", &config).unwrap();
        let expected = "\
# tuned
#
# on \"00\"

seed = 7

[camera]
beta = 0.2

[fusion]
alpha = 0.5
threshold = 0.315

[ground]
model = \"flat\"

[lidar]
beta = 0.2
neighbours = 3

[sensors.front]
sigma_range_m = 0.2

[tracking]
beta = 0.2
scans = 5
";
        assert_eq!(text, expected, "{text}");
        assert_eq!(Config::from_toml(&text, &[]).unwrap(), config);
    }
}
