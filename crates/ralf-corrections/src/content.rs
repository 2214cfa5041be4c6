//! What a scan held when something was said of it.

use std::fmt;

/// A hash of all that a scan holds: a scan with other detections, or with the same ones in another order, has another.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ContentHash([u8; ContentHash::LENGTH]);

impl ContentHash {
    /// Its length, bytes.
    pub const LENGTH: usize = 32;

    /// The hash with these bytes.
    pub fn new(bytes: [u8; Self::LENGTH]) -> Self {
        Self(bytes)
    }

    /// Its bytes.
    pub fn as_bytes(&self) -> &[u8] {
        &self.0
    }

    /// The hash that is written in hexadecimal digits; `None` where these are others than
    /// [`Display`](fmt::Display) writes.
    pub fn from_hex(digits: &str) -> Option<Self> {
        let mut bytes = [0; Self::LENGTH];
        if digits.len() != 2 * Self::LENGTH || !digits.is_ascii() {
            return None;
        }
        for (at, byte) in bytes.iter_mut().enumerate() {
            *byte = u8::from_str_radix(&digits[2 * at..2 * at + 2], 16).ok()?;
        }
        Some(Self(bytes))
    }
}

impl fmt::Display for ContentHash {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for ContentHash {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "ContentHash({self})")
    }
}

/// What a scan holds, as far as it is known: corrections belong to a scan with this content, and to no other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ScanContent {
    /// Number of detections.
    pub detections: u32,
    /// `None` where nobody computed it, as in stores of the first version.
    pub hash: Option<ContentHash>,
}

impl ScanContent {
    /// Which of several contents, of which something was said, is this one: the one with the same hash. One
    /// without a hash is taken for any scan of its size, and where this one has none, a single one of its size
    /// is taken for it.
    pub fn find_in(&self, said: &[ScanContent]) -> Option<usize> {
        let same = said.iter().position(|other| other == self);
        let of_size = |other: &ScanContent| other.detections == self.detections;
        same.or_else(|| match self.hash {
            Some(_) => said.iter().position(|other| other.hash.is_none() && of_size(other)),
            None => (said.len() == 1 && of_size(&said[0])).then_some(0),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn content(detections: u32, hash: Option<u8>) -> ScanContent {
        ScanContent { detections, hash: hash.map(|byte| ContentHash::new([byte; 32])) }
    }

    #[test]
    fn a_hash_comes_back_from_its_digits() {
        let hash = ContentHash::new(std::array::from_fn(|i| i as u8 * 7));
        assert_eq!(ContentHash::from_hex(&hash.to_string()), Some(hash));
        for wrong in ["", "00", &"g".repeat(64), &"ä".repeat(32)] {
            assert_eq!(ContentHash::from_hex(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn what_was_said_of_another_content_is_never_found() {
        let said = [content(10, Some(1)), content(10, Some(2)), content(12, None)];
        assert_eq!(content(10, Some(2)).find_in(&said), Some(1));
        assert_eq!(content(10, Some(3)).find_in(&said), None);
        assert_eq!(content(12, Some(3)).find_in(&said), Some(2), "of a store of the first version");
        assert_eq!(content(11, Some(3)).find_in(&said), None);
        assert_eq!(content(10, None).find_in(&said), None, "which of the two nobody knows");
        assert_eq!(content(10, None).find_in(&said[..1]), Some(0));
        assert_eq!(content(9, None).find_in(&said[..1]), None);
    }
}
