//! What is proposed and what was given, as one.

use ralf::config::ConfigError;
use ralf_data::{MotionSettings, SensorCorrection, Settings};
use serde::Serialize;
use std::collections::BTreeMap;
use toml::{Table, Value};

/// A value as TOML, and a comment after it.
pub(super) struct Line {
    pub(super) value: String,
    pub(super) note: String,
}

/// By dotted key; keys of what is only told begin with `# `.
pub(super) type Lines = BTreeMap<String, Line>;

/// How settings that are only told begin.
const TOLD: &str = "# ";

/// Settings with what was given.
pub(super) struct Totals;

impl Totals {
    /// Lines that say all: what is proposed besides what was given is put together with it, and what was given and
    /// nothing is proposed of is said again.
    pub(super) fn of(lines: Lines, given: &Settings) -> Result<Lines, ConfigError> {
        let (told, open): (Lines, Lines) = lines.into_iter().partition(|(key, _)| key.starts_with(TOLD));
        let mut all = together(&open, given)?;
        for (key, line) in told {
            let own = key[TOLD.len()..].to_owned();
            let alone = Lines::from([(own.clone(), Line { value: line.value, note: String::new() })]);
            if let Some(total) = together(&alone, given)?.remove(&own) {
                all.insert(key, Line { note: line.note, ..total });
            }
        }
        Ok(all)
    }
}

fn together(open: &Lines, given: &Settings) -> Result<Lines, ConfigError> {
    let text: String = open.iter().map(|(key, line)| format!("{key} = {}\n", line.value)).collect();
    let proposed = Settings::from_toml(&text, &[])?;
    let mut all = Lines::new();
    for name in given.corrections.keys().chain(proposed.corrections.keys()) {
        let of = |settings: &Settings| settings.corrections.get(name).copied().unwrap_or_default();
        let total = of(given).then(&of(&proposed));
        let prefix = format!("corrections.{}", ralf_check::toml_key(name));
        put(&mut all, open, &prefix, &total, &SensorCorrection::default())?;
    }
    // Where the motion comes from is no correction of it.
    let motion = MotionSettings::default().then(&given.motion).then(&proposed.motion);
    put(&mut all, open, "motion", &motion, &MotionSettings::default())?;
    let others =
        open.iter().filter(|(key, _)| !["corrections.", "motion."].iter().any(|own| key.starts_with(own)));
    all.extend(
        others.map(|(key, line)| (key.clone(), Line { value: line.value.clone(), note: line.note.clone() })),
    );
    Ok(all)
}

/// All values of a table that are not as they are by default.
fn put<T: Serialize>(
    all: &mut Lines,
    open: &Lines,
    prefix: &str,
    total: &T,
    usual: &T,
) -> Result<(), ConfigError> {
    let table = |values: &T| Table::try_from(values).map_err(|error| ConfigError::Parse(error.to_string()));
    let usual = table(usual)?;
    for (key, value) in table(total)? {
        let value = rounded(value);
        if usual.get(&key) != Some(&value) {
            let key = format!("{prefix}.{key}");
            let note = open.get(&key).map_or("    # as given", |line| &line.note).to_owned();
            all.insert(key, Line { value: value.to_string(), note });
        }
    }
    Ok(())
}

/// Numbers to what anybody notices: sums end in odd digits.
fn rounded(value: Value) -> Value {
    match value {
        Value::Float(number) => Value::Float((number * 1e6).round() / 1e6 + 0.0),
        Value::Array(values) => Value::Array(values.into_iter().map(rounded).collect()),
        other => other,
    }
}
