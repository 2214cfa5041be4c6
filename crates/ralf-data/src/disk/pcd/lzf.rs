//! LZF, the compression of PCD files (Marc Lehmann's LibLZF): runs of new bytes and references to earlier ones.

/// The bytes that were compressed, exactly so many; `None` of anything else.
pub(super) fn decompress(packed: &[u8], size: usize) -> Option<Vec<u8>> {
    // No more than three bytes make 264.
    let mut bytes = Vec::with_capacity(size.min(packed.len().saturating_mul(88)));
    let mut rest = packed;
    while let Some((&control, after)) = rest.split_first() {
        rest = if control < 32 {
            let (new, after) = after.split_at_checked(usize::from(control) + 1)?;
            bytes.extend_from_slice(new);
            after
        } else {
            repeat(control, after, &mut bytes)?
        };
        if bytes.len() > size {
            return None;
        }
    }
    (bytes.len() == size).then_some(bytes)
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
        assert_eq!(decompress(&packed, 18).unwrap(), b"abcabcabbbbbbbbbbb");
        for wrong in [17, 19] {
            assert_eq!(decompress(&packed, wrong), None, "{wrong}");
        }
        for cut in [1, 3, 5, 7, 8] {
            assert_eq!(decompress(&packed[..cut], 18), None, "cut at {cut}");
        }
        assert_eq!(decompress(&[1 << 5, 0], 3), None, "nothing lies before the first byte");
        assert_eq!(decompress(&[], 0), Some(vec![]));
    }

    proptest! {
        #[test]
        fn nothing_panics_or_grows(packed in proptest::collection::vec(any::<u8>(), 0..200), size in 0usize..2000) {
            let bytes = decompress(&packed, size);
            prop_assert!(bytes.is_none_or(|bytes| bytes.len() == size));
        }
    }
}
