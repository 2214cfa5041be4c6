//! The page of settings, `config/default.toml`: the one place of defaults and ranges.

use super::error::ConfigError;
use super::{Complete, Config};
use std::fmt;
use std::sync::LazyLock;
use toml::de::{DeTable, DeValue};
use toml::{Spanned, Table, Value};

/// The page, with a comment behind each setting that begins with its range.
const PAGE: &str = include_str!("default.toml");

/// All settings as the page has them.
pub(super) static DEFAULTS: LazyLock<Table> = LazyLock::new(|| parsed("tables", PAGE.parse()));
/// The same as values with a place in the text, for what is merged with a text of its own.
static PARTS: LazyLock<Spanned<DeTable<'static>>> = LazyLock::new(|| parsed("tables", DeTable::parse(PAGE)));
/// The built-in settings.
pub(super) static CONFIG: LazyLock<Config> = LazyLock::new(|| {
    parsed("settings", DEFAULTS.clone().try_into().map(|complete: Complete| complete.into()))
});
/// Every number's range, by the setting's dotted name.
static RANGES: LazyLock<Vec<(String, Range)>> = LazyLock::new(|| ranges(PAGE));

#[expect(clippy::panic, reason = "the page is part of the program, and the tests read it")]
fn parsed<T, E: fmt::Display>(what: &str, read: Result<T, E>) -> T {
    read.unwrap_or_else(|error| panic!("config/default.toml: expected {what}: {error}"))
}

/// Adds what a table of settings lacks.
pub(super) fn complete(table: &mut Table) {
    for (name, default) in &*DEFAULTS {
        match (table.get_mut(name), default) {
            (None, _) => drop(table.insert(name.clone(), default.clone())),
            (Some(Value::Table(section)), Value::Table(defaults)) => {
                for (key, value) in defaults {
                    section.entry(key.clone()).or_insert_with(|| value.clone());
                }
            }
            _ => {}
        }
    }
}

/// Adds what a text's tables lack, and leaves the places of what it has as they are.
pub(super) fn complete_text(table: &mut DeTable<'_>) {
    for (name, default) in PARTS.get_ref() {
        match (table.get_mut(name).map(Spanned::get_mut), default.get_ref()) {
            (None, _) => drop(table.insert(name.clone(), default.clone())),
            (Some(DeValue::Table(section)), DeValue::Table(defaults)) => {
                for (key, value) in defaults {
                    section.entry(key.clone()).or_insert_with(|| value.clone());
                }
            }
            _ => {}
        }
    }
}

/// Refuses numbers out of their ranges.
pub(super) fn check(config: &Config) -> Result<(), ConfigError> {
    let table = Table::try_from(config).map_err(|error| ConfigError::Parse(error.to_string()))?;
    for (key, range) in &*RANGES {
        if let Some(found) = number(&table, key).filter(|found| !range.contains(*found)) {
            return Err(ConfigError::Value { key: key.clone(), expected: format!("{range}, found {found}") });
        }
    }
    Ok(())
}

/// The number of a dotted name.
fn number(table: &Table, key: &str) -> Option<f64> {
    let value = match key.split_once('.') {
        Some((section, key)) => table.get(section)?.get(key)?,
        None => table.get(key)?,
    };
    value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
}

/// An interval, with its upper end and mostly with its lower.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Range {
    low: f64,
    high: f64,
    /// Whether `low` is out of range itself.
    above_low: bool,
}

impl Range {
    /// The interval that a comment begins with: `[0, 1]` or `(0, 1]`.
    fn parse(comment: &str) -> Option<Self> {
        let above_low = comment.starts_with('(');
        let (interval, _) = comment.strip_prefix(['[', '('])?.split_once(']')?;
        let (low, high) = interval.split_once(',')?;
        Some(Self { low: low.trim().parse().ok()?, high: high.trim().parse().ok()?, above_low })
    }

    fn contains(&self, value: f64) -> bool {
        (self.low..=self.high).contains(&value) && !(self.above_low && value == self.low)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { low, high, above_low } = self;
        if *above_low { write!(f, "more than {low} and up to {high}") } else { write!(f, "{low} to {high}") }
    }
}

/// The ranges of a page's settings.
fn ranges(page: &str) -> Vec<(String, Range)> {
    let mut section = String::new();
    let mut ranges = Vec::new();
    for line in page.lines() {
        if let Some(name) = line.strip_prefix('[').and_then(|line| line.strip_suffix(']')) {
            section = format!("{name}.");
        } else if let Some((setting, comment)) = line.split_once('#') {
            let Some((key, _)) = setting.split_once('=') else { continue };
            if let Some(range) = Range::parse(comment.trim_start()) {
                ranges.push((format!("{section}{}", key.trim()), range));
            }
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Dotted names of all numbers on the page.
    fn numbers() -> Vec<String> {
        let mut names = Vec::new();
        for (name, value) in &*DEFAULTS {
            match value {
                Value::Table(section) => names.extend(section.keys().map(|key| format!("{name}.{key}"))),
                _ => names.push(name.clone()),
            }
        }
        names.retain(|name| number(&DEFAULTS, name).is_some());
        names
    }

    fn read(key: &str, value: &str) -> Result<Config, ConfigError> {
        Config::from_toml("", &[&format!("{key}={value}")])
    }

    #[test]
    fn the_page_has_every_setting_and_every_number_its_range() {
        assert_eq!(check(&CONFIG), Ok(()));
        assert_eq!(Table::try_from(&*CONFIG).unwrap().len(), DEFAULTS.len() + 1, "all tables but `sensors`");
        let mut ranges: Vec<_> = RANGES.iter().map(|(key, _)| key.clone()).collect();
        ranges.sort_unstable();
        let mut numbers = numbers();
        numbers.sort_unstable();
        assert_eq!(ranges, numbers);
    }

    #[test]
    fn a_page_without_a_setting_is_no_page() {
        let mut table = DEFAULTS.clone();
        table["lidar"].as_table_mut().unwrap().remove("beta");
        assert!(table.try_into::<super::super::Complete>().unwrap_err().to_string().contains("beta"));
    }

    #[test]
    fn both_ends_of_every_range_are_kept_and_what_lies_beyond_is_refused_by_name() {
        for (key, range) in &*RANGES {
            let default = match key.split_once('.') {
                Some((section, key)) => &DEFAULTS[section][key],
                None => &DEFAULTS[key.as_str()],
            };
            let whole = default.is_integer();
            let text = |value: f64| if whole { format!("{}", value as i64) } else { format!("{value:?}") };
            let inside = if range.above_low { range.low + range.high / 1e6 } else { range.low };
            for value in [inside, range.high] {
                read(key, &text(value)).unwrap_or_else(|error| panic!("{key} = {value}: {error}"));
            }
            let step = if whole { 1.0 } else { range.high.abs().max(1.0) * 1e-6 };
            let below = if range.above_low { range.low } else { range.low - step };
            for value in [below, range.high + step] {
                // A whole number of 64 bits has nothing beyond.
                if whole && value >= i64::MAX as f64 {
                    continue;
                }
                let error = read(key, &text(value)).expect_err(key).to_string();
                assert!(whole && value < 0.0 || error.contains(key.as_str()), "{key} = {value}: {error}");
            }
        }
    }

    #[test]
    fn a_range_reads_as_people_write_it() {
        let range = |text| Range::parse(text).map(|range| range.to_string());
        assert_eq!(range("[0, 1] share").as_deref(), Some("0 to 1"));
        assert_eq!(range("(0, 1e3] m").as_deref(), Some("more than 0 and up to 1000"));
        assert_eq!((range("whether"), range("[0] m"), range("\"none\" | \"flat\"")), (None, None, None));
    }

    proptest! {
        /// Whatever is typed for a number: it is read or refused, and what is read lies in its range.
        #[test]
        fn no_number_is_too_odd(
            setting in 0..1000usize,
            value in prop_oneof![
                any::<f64>().prop_map(|value| format!("{value:?}")),
                any::<i64>().prop_map(|value| value.to_string()),
                any::<i128>().prop_map(|value| value.to_string()),
                prop::sample::select(vec!["nan", "inf", "-inf", "4e9", "1e400", "0x7fffffffffffffff", "-0", ""])
                    .prop_map(str::to_owned),
            ],
        ) {
            let numbers = numbers();
            if let Ok(config) = read(&numbers[setting % numbers.len()], &value) {
                prop_assert_eq!(check(&config), Ok(()));
            }
        }
    }
}
