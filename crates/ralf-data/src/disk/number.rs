//! Numbers of any type as they lie in arrays and clouds, little-endian.

/// The type of a value; whole numbers with their size in bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Number {
    F32,
    F64,
    Signed(usize),
    Unsigned(usize),
}

const WHOLE_SIZES: [usize; 4] = [1, 2, 4, 8];

impl Number {
    pub(crate) fn float(size: usize) -> Option<Self> {
        match size {
            4 => Some(Self::F32),
            8 => Some(Self::F64),
            _ => None,
        }
    }

    pub(crate) fn signed(size: usize) -> Option<Self> {
        WHOLE_SIZES.contains(&size).then_some(Self::Signed(size))
    }

    pub(crate) fn unsigned(size: usize) -> Option<Self> {
        WHOLE_SIZES.contains(&size).then_some(Self::Unsigned(size))
    }

    /// How many bytes it takes.
    pub(crate) fn size(self) -> usize {
        match self {
            Self::F32 => 4,
            Self::F64 => 8,
            Self::Signed(size) | Self::Unsigned(size) => size,
        }
    }

    /// From as many bytes as the type has.
    pub(crate) fn value(self, bytes: &[u8]) -> f64 {
        match (self, bytes) {
            (Self::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
            (Self::F64, &[a, b, c, d, e, f, g, h]) => f64::from_le_bytes([a, b, c, d, e, f, g, h]),
            // Of 128 bits only where 64 don't do: no processor has an instruction for it.
            (_, bytes) => self
                .whole(bytes)
                .map_or(f64::NAN, |whole| i64::try_from(whole).map_or(whole as f64, |whole| whole as f64)),
        }
    }

    /// The same as a whole number; the error is what was found in place of one of at most 63 bits.
    pub(crate) fn integer(self, bytes: &[u8]) -> Result<i64, String> {
        let Some(whole) = self.whole(bytes) else {
            let value = self.value(bytes);
            let is_whole = value.fract() == 0.0 && value.abs() < 9e15;
            return if is_whole { Ok(value as i64) } else { Err(value.to_string()) };
        };
        i64::try_from(whole).map_err(|_| whole.to_string())
    }

    /// The value of a type of whole numbers.
    fn whole(self, bytes: &[u8]) -> Option<i128> {
        let mut wide = [0; 16];
        wide.get_mut(..bytes.len())?.copy_from_slice(bytes);
        let unsigned = i128::from_le_bytes(wide);
        let unused = 128 - 8 * bytes.len() as u32;
        match self {
            Self::F32 | Self::F64 => None,
            Self::Unsigned(_) => Some(unsigned),
            Self::Signed(_) => Some((unsigned << unused) >> unused),
        }
    }

    /// Appends the bytes of a number in digits; `None` if it is none of this type.
    pub(crate) fn append(self, word: &str, bytes: &mut Vec<u8>) -> Option<()> {
        match self {
            Self::F32 => bytes.extend(word.parse::<f32>().ok()?.to_le_bytes()),
            Self::F64 => bytes.extend(word.parse::<f64>().ok()?.to_le_bytes()),
            Self::Unsigned(size) | Self::Signed(size) => {
                let whole: i128 = word.parse().ok()?;
                let little = whole.to_le_bytes();
                let kept = little.get(..size)?;
                (self.whole(kept)? == whole).then(|| bytes.extend(kept))?;
            }
        }
        Some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_of_every_size_become_the_nearest_number() {
        assert_eq!(Number::Signed(1).value(&[0xff]), -1.0);
        assert_eq!(Number::Unsigned(1).value(&[0xff]), 255.0);
        assert_eq!(Number::Signed(3).value(&[0, 0, 0x80]), -8_388_608.0);
        assert_eq!(Number::Signed(8).value(&i64::MIN.to_le_bytes()), -(2.0_f64.powi(63)));
        assert_eq!(Number::Unsigned(8).value(&u64::MAX.to_le_bytes()), 2.0_f64.powi(64));
        // Halfway between two numbers it is the even one, below 63 bits and above.
        assert_eq!(Number::Unsigned(8).value(&((1_u64 << 53) + 1).to_le_bytes()), 2.0_f64.powi(53));
        let halfway = (1_u64 << 63) + (1 << 10);
        assert_eq!(Number::Unsigned(8).value(&halfway.to_le_bytes()), 2.0_f64.powi(63));
        assert!(Number::Signed(9).value(&[0; 17]).is_nan());
    }
}
