//! Round numbers and how they are written.

/// The largest of 1, 2, 5 times a power of ten that is at most `limit`, which is above 0.
pub(crate) fn nice_at_most(limit: f64) -> f64 {
    let exponent = limit.log10().floor() as i32;
    // The floor of a rounded logarithm may be one too high or too low: look one decade to either side.
    let decades = (exponent - 1..=exponent + 1).rev().map(power_of_ten);
    let mut candidates = decades.flat_map(|decade| [5.0, 2.0, 1.0].map(|digit| digit * decade));
    candidates.find(|candidate| *candidate <= limit).unwrap_or(limit)
}

fn power_of_ten(exponent: i32) -> f64 {
    if exponent < 0 { 1.0 / 10f64.powi(-exponent) } else { 10f64.powi(exponent) }
}

/// The multiples of `step` within `low..=high`.
pub(crate) fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(move |index| index as f64 * step)
}

/// A length as text with its unit: "0.5 m", "20 m", "2 km".
pub(crate) fn metres(length: f64) -> String {
    if length >= 1000.0 { format!("{} km", number(length / 1000.0)) } else { format!("{} m", number(length)) }
}

/// A round number with as few decimals as it needs (at most 3) and commas between thousands.
pub(crate) fn number(value: f64) -> String {
    let text = format!("{:.3}", value.abs());
    let text = text.trim_end_matches('0').trim_end_matches('.');
    let (whole, decimals) = text.split_at(text.find('.').unwrap_or(text.len()));
    let sign = if value < 0.0 && text != "0" { "\u{2212}" } else { "" };
    format!("{sign}{}{decimals}", with_commas(whole))
}

/// A count with commas between thousands.
pub(crate) fn count(value: usize) -> String {
    with_commas(&value.to_string())
}

fn with_commas(digits: &str) -> String {
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// A part of a whole in percent. "0 %" and "100 %" are kept for none and all.
pub(crate) fn share(part: usize, whole: usize) -> String {
    let percent = if whole == 0 { 0.0 } else { 100.0 * part as f64 / whole as f64 };
    match percent.round() {
        _ if part == 0 || part == whole => format!("{percent:.0} %"),
        0.0 => "< 1 %".to_owned(),
        100.0 => "> 99 %".to_owned(),
        rounded => format!("{rounded:.0} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn nice_numbers_are_the_next_below() {
        for (limit, expected) in
            [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (4.9, 2.0), (5.0, 5.0), (9.99, 5.0), (10.0, 10.0)]
        {
            assert_eq!(nice_at_most(limit), expected, "{limit}");
            assert_eq!(nice_at_most(limit * 1000.0), expected * 1000.0, "{limit}");
        }
        assert_eq!([nice_at_most(0.2), nice_at_most(0.099), nice_at_most(433.0)], [0.2, 0.05, 200.0]);
    }

    proptest! {
        #[test]
        fn a_nice_number_is_within_two_and_a_half_times(limit in 1e-3..1e8) {
            let nice = nice_at_most(limit);
            prop_assert!(nice <= limit && limit < nice * 2.5 * (1.0 + 1e-12));
        }
    }

    #[test]
    fn multiples_lie_within_and_have_no_negative_zero() {
        assert_eq!(multiples(5.0, -6.0, 10.0).collect::<Vec<_>>(), [-5.0, 0.0, 5.0, 10.0]);
        assert!(multiples(5.0, -1.0, 1.0).all(f64::is_sign_positive));
        assert_eq!(multiples(5.0, 1.0, 4.0).count(), 0);
    }

    #[test]
    fn numbers_are_written_briefly() {
        assert_eq!(
            [metres(20.0), metres(0.5), metres(2000.0), metres(0.05)],
            ["20 m", "0.5 m", "2 km", "0.05 m"]
        );
        assert_eq!([number(-40.0), number(0.0), number(3.0 * 0.1)], ["\u{2212}40", "0", "0.3"]);
        assert_eq!([number(-0.0001), number(5_400_120.0)], ["0", "5,400,120"]);
        assert_eq!([count(0), count(999), count(1000), count(3_141_592)], ["0", "999", "1,000", "3,141,592"]);
    }

    #[test]
    fn only_none_is_0_percent_and_only_all_is_100() {
        assert_eq!([share(0, 0), share(0, 9), share(9, 9)], ["0 %", "0 %", "100 %"]);
        assert_eq!([share(61, 290), share(1, 1000), share(999, 1000)], ["21 %", "< 1 %", "> 99 %"]);
    }
}
