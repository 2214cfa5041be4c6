//! Orders in which files come to be taken for others.

use crate::remedy::{AS_TEXT, BACKWARDS};
use ralf::sensors::Timelines;
use std::collections::{BTreeMap, BTreeSet};

/// How files lie that should be in the order of time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Order {
    /// By their numbers as text, the first of which is this: 0, 1, 10, 11, 2.
    Text(usize),
    /// The last one first.
    Backwards,
}

/// Files in an order.
pub(super) struct Ordered {
    /// Which is at each place.
    pub(super) files: Vec<usize>,
    /// At which place each is.
    pub(super) places: Vec<usize>,
}

/// All orders of the files of radars and LiDARs, by how many there are.
pub(super) struct Orders(BTreeMap<(Order, usize), Ordered>);

impl Orders {
    pub(super) fn of(times: &Timelines) -> Self {
        let counts = times.radars.iter().chain(&times.lidars).map(Vec::len).collect::<BTreeSet<_>>();
        let all = counts.into_iter().flat_map(|count| Order::ALL.map(|order| (order, count)));
        Self(all.map(|(order, count)| ((order, count), order.of(count))).collect())
    }

    /// As many files as some sensor has, in this order.
    pub(super) fn get(&self, order: Order, count: usize) -> &Ordered {
        &self.0[&(order, count)]
    }
}

impl Order {
    pub(super) const ALL: [Self; 3] = [Self::Text(0), Self::Text(1), Self::Backwards];

    /// So many files in this order.
    fn of(self, count: usize) -> Ordered {
        let mut files: Vec<usize> = (0..count).collect();
        match self {
            Self::Text(first) => files.sort_by_cached_key(|file| (file + first).to_string()),
            Self::Backwards => files.reverse(),
        }
        let mut places = vec![0; count];
        files.iter().enumerate().for_each(|(place, file)| places[*file] = place);
        Ordered { files, places }
    }

    pub(super) fn remedy(self) -> &'static str {
        match self {
            Self::Text(_) => AS_TEXT,
            Self::Backwards => BACKWARDS,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_as_text_come_after_their_first_digits() {
        assert_eq!(Order::Text(0).of(12).files, [0, 1, 10, 11, 2, 3, 4, 5, 6, 7, 8, 9]);
        // 1, 10, 11, 12, 2 ...
        assert_eq!(Order::Text(1).of(12).files, [0, 9, 10, 11, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(Order::Backwards.of(3).files, [2, 1, 0]);
    }

    #[test]
    fn a_file_is_found_at_its_place() {
        for order in Order::ALL {
            let Ordered { files, places } = order.of(120);
            assert!((0..120).all(|file| files[places[file]] == file), "{order:?}");
        }
    }
}
