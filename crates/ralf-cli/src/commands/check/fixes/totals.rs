//! What is proposed and what was given, as one.

use ralf::config::{ConfigError, SensorOverride};
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
pub(super) const TOLD: &str = "# ";
/// What is said of a value of which nothing is proposed.
const AS_GIVEN: &str = "    # as given";

/// Lines that say all: what is proposed besides what was given is put together with it, and what was given and nothing
/// is proposed of is said again.
pub(super) fn totals(lines: Lines, given: &Settings) -> Result<Lines, ConfigError> {
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

fn together(open: &Lines, given: &Settings) -> Result<Lines, ConfigError> {
    let text: String = open.iter().map(|(key, line)| format!("{key} = {}\n", line.value)).collect();
    let proposed = Settings::from_toml(&text, &[])?;
    let mut all = Lines::new();
    for name in given.corrections.keys().chain(proposed.corrections.keys()) {
        let of = |settings: &Settings| settings.corrections.get(name).copied().unwrap_or_default();
        let (given, proposed) = (of(given), of(&proposed));
        let prefix = format!("corrections.{}", ralf_check::toml_key(name));
        put(&mut all, open, &prefix, [&SensorCorrection::default(), &given, &given.then(&proposed)])?;
    }
    // Where the motion comes from is no correction of it.
    let usual = MotionSettings::default();
    let given_motion = usual.then(&given.motion);
    put(&mut all, open, "motion", [&usual, &given_motion, &given_motion.then(&proposed.motion)])?;
    for (name, sensor) in &given.method.sensors {
        let prefix = format!("sensors.{}", ralf_check::toml_key(name));
        put(&mut all, open, &prefix, [&SensorOverride::default(), sensor, sensor])?;
    }
    let others =
        open.iter().filter(|(key, _)| !["corrections.", "motion."].iter().any(|own| key.starts_with(own)));
    all.extend(
        others.map(|(key, line)| (key.clone(), Line { value: line.value.clone(), note: line.note.clone() })),
    );
    Ok(all)
}

/// All values of a table that are not as they are by default, or were not: what takes back what was given is told, for
/// a file that was given before says otherwise.
fn put<T: Serialize>(
    all: &mut Lines,
    open: &Lines,
    prefix: &str,
    [usual, given, total]: [&T; 3],
) -> Result<(), ConfigError> {
    let table = |values: &T| Table::try_from(values).map_err(|error| ConfigError::Parse(error.to_string()));
    let (usual, given) = (table(usual)?, table(given)?);
    for (key, value) in table(total)? {
        let value = rounded(value);
        let was = given.get(&key).cloned().map(rounded);
        let is_usual = |value: &Option<Value>| usual.get(&key) == value.as_ref();
        if is_usual(&was) && is_usual(&Some(value.clone())) {
            continue;
        }
        let as_given = if was.as_ref() == Some(&value) { AS_GIVEN } else { "" };
        let full = format!("{prefix}.{key}");
        let note = open.get(&full).map_or(as_given, |line| &line.note).to_owned();
        all.insert(full, Line { value: value.to_string(), note });
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
