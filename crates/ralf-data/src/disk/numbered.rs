//! Files whose names are numbers.

use std::path::Path;

/// The number that is a file's name without its extension: digits and nothing else.
pub(crate) fn number_of(file: &Path) -> Option<u64> {
    let stem = file.file_stem()?.to_str()?;
    stem.bytes().all(|byte| byte.is_ascii_digit()).then(|| stem.parse().ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_has_digits_alone() {
        let of = |name: &str| number_of(Path::new(name));
        assert_eq!([of("a/000012.png"), of("7"), of("0.label")], [Some(12), Some(7), Some(0)]);
        assert_eq!([of("+1.png"), of("-1.png"), of("a1.png"), of("99999999999999999999.png")], [None; 4]);
    }
}
