//! The hash of a scan's labels, as `run.json` keeps it.

/// Hexadecimal digits that are kept.
const SHORT: usize = 16;

/// The hash of a `.label` file, short: it tells damage, and there is one for each scan.
pub(super) fn hash_of_labels(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex()[..SHORT].to_owned()
}
