//! LZF, the compression that h5py has of its own (HDF5's registered filter 32000).

/// The filter's number.
pub(super) const FILTER: u16 = 32_000;

/// Decompressed bytes; `None` of what is no LZF, or more than `most`.
///
/// A byte below 32 is followed by so many bytes and one more, as they are. Any other repeats what came before: its
/// upper three bits are the length less 2 (7: a byte with more of it follows), the rest, and a byte more, how far back.
pub(super) fn decompressed(mut packed: &[u8], most: usize) -> Option<Vec<u8>> {
    let mut bytes = Vec::new();
    while let Some((&control, rest)) = packed.split_first() {
        let (high, low) = (usize::from(control >> 5), usize::from(control & 31));
        if high == 0 {
            let (run, rest) = rest.split_at_checked(low + 1)?;
            bytes.extend_from_slice(run);
            packed = rest;
        } else {
            let (more, rest) = if high == 7 { rest.split_first()? } else { (&0, rest) };
            let (back, rest) = rest.split_first()?;
            let first = bytes.len().checked_sub((low << 8) + usize::from(*back) + 1)?;
            let length = high + usize::from(*more) + 2;
            // What is repeated may overlap what it makes.
            (first..first + length).for_each(|at| bytes.push(bytes[at]));
            packed = rest;
        }
        if bytes.len() > most {
            return None;
        }
    }
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_and_repetitions() {
        assert_eq!(decompressed(&[], 9), Some(vec![]));
        assert_eq!(decompressed(&[2, b'a', b'b', b'c'], 9), Some(b"abc".to_vec()));
        // Four bytes from two back, then nine from the begin.
        assert_eq!(decompressed(&[1, b'a', b'b', 2 << 5, 1], 9), Some(b"ababab".to_vec()));
        assert_eq!(decompressed(&[0, b'x', 7 << 5, 3, 0], 99), Some(vec![b'x'; 13]));
        let far = [vec![31; 1], vec![b'p'; 32], vec![31], vec![b'q'; 32], vec![1 << 5, 63]].concat();
        assert_eq!(decompressed(&far, 99).unwrap()[64..], *b"ppp");
    }

    #[test]
    fn what_ends_early_or_leads_before_the_begin_is_none() {
        for packed in [&[3, b'a'][..], &[7 << 5], &[7 << 5, 0], &[1 << 5, 0], &[0, b'a', 1 << 5, 1]] {
            assert_eq!(decompressed(packed, 99), None, "{packed:?}");
        }
        assert_eq!(decompressed(&[0, b'x', 7 << 5, 255, 0], 200), None);
    }
}
