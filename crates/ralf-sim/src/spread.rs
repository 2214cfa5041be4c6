//! What the sequences of a recording that a seed draws are called, and how they share its scans.

/// Scans of each radar in a sequence, where no number is given: some 3 s.
const USUAL_SCANS: usize = 40;

/// The names of so many sequences.
pub(super) fn names(count: usize) -> Vec<String> {
    (0..count).map(|index| format!("{index:02}")).collect()
}

/// So many scans, as many as is usual if none are given, spread over `count` sequences.
pub(super) fn spread(scans: Option<usize>, count: usize) -> Vec<usize> {
    let all = scans.unwrap_or(USUAL_SCANS * count);
    let share = |index: usize| all / count + usize::from(index < all % count);
    (0..count).map(|index| share(index).max(1)).collect()
}
