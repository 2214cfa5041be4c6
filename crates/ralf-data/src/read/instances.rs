//! Numbers for things that a data set tells apart by names.

use std::collections::HashMap;
use std::sync::Arc;

/// Instances as label files have them: numbered from 1 in the order in which their names appear, 0 for no name, and for
/// those of which there are more than numbers.
pub(crate) fn numbered(names: Vec<Arc<str>>) -> Vec<u16> {
    let mut known: HashMap<Arc<str>, u16> = HashMap::new();
    let number = |name: Arc<str>| {
        let next = u16::try_from(known.len() + 1).unwrap_or(0);
        if name.is_empty() { 0 } else { *known.entry(name).or_insert(next) }
    };
    names.into_iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_follow_the_order_of_appearance() {
        let names = ["b", "", "a", "b", "a", "c"].map(Arc::from).to_vec();
        assert_eq!(numbered(names), [1, 0, 2, 1, 2, 3]);
        let many = (0..65_537).map(|n| n.to_string().into()).collect();
        assert_eq!(numbered(many)[65_533..], [65_534, 65_535, 0, 0]);
    }
}
