//! Numbers in decimal digits, as `format!` writes them, at a fraction of its cost: a scan's reasons are thousands.

use std::fmt::Write;

/// Numbers below this are written here, exactly; see [`push`].
const LARGEST: f64 = 1e6;
/// Digits behind the point at most, and what a number times them is a whole number of.
const SCALES: [f64; 3] = [1.0, 10.0, 100.0];
/// What a product is rounded by is less.
const ROUNDING: f64 = 1e-6;

/// Adds a number with so many digits behind the point: `{:.digits$}`.
pub(super) fn push(text: &mut String, value: f64, digits: usize) {
    let known = SCALES.get(digits).and_then(|scale| rounded(value.abs() * scale));
    match known.filter(|_| value.abs() < LARGEST) {
        Some(units) => push_units(text, value.is_sign_negative(), units, digits),
        // Whether what lies between two numbers is rounded up or down takes all digits, as infinity takes none.
        None => _ = write!(text, "{value:.digits$}"),
    }
}

/// The nearest whole number; `None` where rounding may decide which one it is.
fn rounded(value: f64) -> Option<u64> {
    let over = value - value.floor();
    let clear = (over - 0.5).abs() > ROUNDING;
    clear.then(|| value.floor() as u64 + u64::from(over > 0.5))
}

/// Adds so many units, each of which is the last of the digits behind the point.
fn push_units(text: &mut String, negative: bool, units: u64, digits: usize) {
    // Nine digits, a point and a sign.
    let mut buffer = [0; 16];
    let (mut begin, mut left, mut place) = (buffer.len(), units, 0);
    let mut put = |byte: u8| {
        begin -= 1;
        buffer[begin] = byte;
    };
    while left > 0 || place <= digits {
        if place == digits && digits > 0 {
            put(b'.');
        }
        put(b'0' + (left % 10) as u8);
        left /= 10;
        place += 1;
    }
    if negative {
        put(b'-');
    }
    text.push_str(std::str::from_utf8(&buffer[begin..]).unwrap_or_default());
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn pushed(value: f64, digits: usize) -> String {
        let mut text = String::new();
        push(&mut text, value, digits);
        text
    }

    proptest! {
        #[test]
        fn a_number_is_written_as_the_library_writes_it(
            value in -1e7f64..1e7, small in -12.0f64..12.0, units in -5000i32..5000, digits in 0usize..4,
        ) {
            for value in [value, small, f64::from(small as f32), f64::from(units) / 8.0, f64::from(units) / 1000.0] {
                prop_assert_eq!(pushed(value, digits), format!("{value:.digits$}"));
            }
        }
    }

    #[test]
    fn what_is_no_usual_number_is_written_as_the_library_writes_it() {
        for value in
            [0.0, -0.0, -0.001, 0.005, 0.125, 999_999.999, 1e300, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]
        {
            for digits in 0..4 {
                assert_eq!(pushed(value, digits), format!("{value:.digits$}"), "{value} {digits}");
            }
        }
    }
}
