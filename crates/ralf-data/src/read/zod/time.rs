//! Times as texts: ISO 8601 in UTC, as `2022-02-14T13:23:32.251875Z`.

use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// ns of Unix, in a JSON file.
pub(super) fn nanoseconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<i64, D::Error> {
    let text = String::deserialize(deserializer)?;
    parse(&text).ok_or_else(|| D::Error::custom(format!("`{text}` as a time in UTC")))
}

/// ns of Unix; `None` of what is no time in UTC, or beyond the years 1700 to 2200.
fn parse(text: &str) -> Option<i64> {
    let text = text.strip_suffix('Z').or_else(|| text.strip_suffix("+00:00"))?;
    let (date, clock) = text.split_once('T')?;
    let [year, month, day] = numbers(date, '-')?;
    let (clock, fraction) = clock.split_once('.').unwrap_or((clock, "0"));
    let [hour, minute, second] = numbers(clock, ':')?;
    let is_time = (1700..2200).contains(&year)
        && (1..=12).contains(&month)
        && (1..=31).contains(&day)
        && hour < 24
        && minute < 60
        && second < 61;
    let digits = fraction.len();
    if !is_time || digits == 0 || digits > 9 || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let part: i64 = fraction.parse().ok()?;
    let seconds = ((days(year, month, day) * 24 + hour) * 60 + minute) * 60 + second;
    Some(seconds * 1_000_000_000 + part * 10i64.pow(9 - digits as u32))
}

fn numbers(text: &str, between: char) -> Option<[i64; 3]> {
    let number = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit()).then(|| part.parse().ok())?;
    let parts: Option<Vec<i64>> = text.split(between).map(number).collect();
    parts?.try_into().ok()
}

/// Days since 1970 in the Gregorian calendar: years begin in March, so that the leap day is their last.
fn days(year: i64, month: i64, day: i64) -> i64 {
    let year = if month > 2 { year } else { year - 1 };
    let month = (month + 9) % 12;
    let of_years = 365 * year + year / 4 - year / 100 + year / 400;
    of_years + (153 * month + 2) / 5 + day - 1 - 719_468
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_times() {
        for (text, expected) in [
            ("1970-01-01T00:00:00Z", 0),
            ("2022-02-14T13:23:32.251875Z", 1_644_845_012_251_875_000),
            ("2020-02-29T23:59:59.5+00:00", 1_583_020_799_500_000_000),
            ("2000-03-01T00:00:00.000000001Z", 951_868_800_000_000_001),
        ] {
            assert_eq!(parse(text), Some(expected), "{text}");
        }
        for text in [
            "",
            "2022-02-14",
            "2022-02-14T13:23:32",
            "2022-13-14T13:23:32Z",
            "2022-02-14T-1:23:32Z",
            "2022-02-14T13:23:32.Z",
        ] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
