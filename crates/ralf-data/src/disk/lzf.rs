//! LZF, which PCD files and h5py compress by (Marc Lehmann's LibLZF): runs of new bytes and references to earlier ones.

/// The bytes that were compressed, exactly so many; `None` of anything else.
pub(crate) fn exactly(packed: &[u8], size: usize) -> Option<Vec<u8>> {
    at_most(packed, size).filter(|bytes| bytes.len() == size)
}

/// The bytes that were compressed; `None` of what is no LZF, or more than `most`.
///
/// A byte below 32 is followed by so many bytes and one more, as they are. Any other is a reference: its upper three
/// bits are the length less 2 (7: a byte with more of it follows), the rest, and a byte more, how far back.
pub(crate) fn at_most(packed: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut rest = packed;
    while let Some((&control, after)) = rest.split_first() {
        rest = if control < 32 {
            let (new, after) = after.split_at_checked(usize::from(control) + 1)?;
            bytes.extend_from_slice(new);
            after
        } else {
            repeat(control, after, &mut bytes)?
        };
        if bytes.len() > most {
            return None;
        }
    }
    Some(bytes)
}

/// Appends what a reference stands for. Returns what follows it.
fn repeat<'a>(control: u8, after: &'a [u8], bytes: &mut Vec<u8>) -> Option<&'a [u8]> {
    const LONG: u8 = 7;
    let (more, after) = if control >> 5 == LONG { after.split_first()? } else { (&0, after) };
    let (&low, after) = after.split_first()?;
    let length = usize::from(control >> 5) + usize::from(*more) + 2;
    let back = (usize::from(control & 31) << 8 | usize::from(low)) + 1;
    let start = bytes.len().checked_sub(back)?;
    // What is repeated may reach into itself.
    for place in start..start + length {
        bytes.push(bytes[place]);
    }
    Some(after)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn worked_by_hand() {
        // Three new bytes; then 3 + 2 bytes from 3 back, which reach into themselves; then 7 + 1 + 2 from 1 back.
        let packed = [2, b'a', b'b', b'c', 3 << 5, 2, 7 << 5, 1, 0];
        assert_eq!(exactly(&packed, 18).unwrap(), b"abcabcabbbbbbbbbbb");
        for wrong in [17, 19] {
            assert_eq!(exactly(&packed, wrong), None, "{wrong}");
        }
        for cut in [1, 3, 5, 7, 8] {
            assert_eq!(exactly(&packed[..cut], 18), None, "cut at {cut}");
        }
        assert_eq!(exactly(&[1 << 5, 0], 3), None, "nothing lies before the first byte");
        assert_eq!(exactly(&[], 0), Some(vec![]));
    }

    #[test]
    fn runs_and_repetitions() {
        assert_eq!(at_most(&[], 9), Some(vec![]));
        assert_eq!(at_most(&[2, b'a', b'b', b'c'], 9), Some(b"abc".to_vec()));
        // Four bytes from two back, then nine from the begin.
        assert_eq!(at_most(&[1, b'a', b'b', 2 << 5, 1], 9), Some(b"ababab".to_vec()));
        assert_eq!(at_most(&[0, b'x', 7 << 5, 3, 0], 99), Some(vec![b'x'; 13]));
        let far = [vec![31; 1], vec![b'p'; 32], vec![31], vec![b'q'; 32], vec![1 << 5, 63]].concat();
        assert_eq!(at_most(&far, 99).unwrap()[64..], *b"ppp");
    }

    #[test]
    fn what_ends_early_or_leads_before_the_begin_is_none() {
        for packed in [&[3, b'a'][..], &[7 << 5], &[7 << 5, 0], &[1 << 5, 0], &[0, b'a', 1 << 5, 1]] {
            assert_eq!(at_most(packed, 99), None, "{packed:?}");
        }
        assert_eq!(at_most(&[0, b'x', 7 << 5, 255, 0], 200), None);
    }

    proptest! {
        #[test]
        fn nothing_panics_or_grows(packed in proptest::collection::vec(any::<u8>(), 0..200), size in 0usize..2000) {
            let bytes = exactly(&packed, size);
            prop_assert!(bytes.is_none_or(|bytes| bytes.len() == size));
        }
    }
}
