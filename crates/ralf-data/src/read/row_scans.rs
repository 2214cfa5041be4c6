//! Which rows of a table are one scan, and when it was.

use std::collections::BTreeMap;
use std::ops::Range;

/// A scan: its time, ns, and its rows, in the order of the table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Scan {
    pub(crate) t_ns: i64,
    runs: Vec<Range<usize>>,
}

impl Scan {
    /// Its rows.
    pub(crate) fn rows(&self) -> impl Iterator<Item = usize> {
        self.runs.iter().cloned().flatten()
    }

    /// Its values of a column; `None` of a column that ends before its last row.
    pub(crate) fn of<T: Clone>(&self, column: &[T]) -> Option<Vec<T>> {
        let runs = self.runs.iter().map(|run| column.get(run.clone()));
        Some(runs.collect::<Option<Vec<&[T]>>>()?.concat())
    }
}

/// A warning of so many scans whose rows are of several times, unless there are none.
pub(crate) fn torn_scans(torn: usize) -> Option<String> {
    let words = "of the scans, which have that of their first";
    (torn > 0).then(|| format!("detections of several times in {torn} {words}"))
}

/// The rows of each key.
fn runs<K: Ord + Copy>(keys: impl Iterator<Item = K>) -> BTreeMap<K, Vec<Range<usize>>> {
    let mut found: BTreeMap<K, Vec<Range<usize>>> = BTreeMap::new();
    for (row, key) in keys.enumerate() {
        let runs = found.entry(key).or_default();
        match runs.last_mut() {
            Some(run) if run.end == row => run.end += 1,
            _ => runs.push(row..row + 1),
        }
    }
    found
}

/// The scans of rows of which each has a key, in the order of time; a scan's time is that of its first row.
pub(crate) fn scans<K: Ord + Copy>(keys: impl Iterator<Item = K>, times: &[i64]) -> Vec<(K, Scan)> {
    let scan = |(key, runs): (K, Vec<Range<usize>>)| (key, Scan { t_ns: times[runs[0].start], runs });
    let mut found: Vec<(K, Scan)> = runs(keys).into_iter().map(scan).collect();
    found.sort_by_key(|(_, scan)| scan.t_ns);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_one_key_are_one_scan_wherever_they_lie() {
        let keys = [("a", 1), ("b", 1), ("a", 1), ("a", 1), ("a", 0)];
        let found = scans(keys.into_iter(), &[50, 51, 50, 50, 7]);
        let told: Vec<_> =
            found.iter().map(|(key, scan)| (*key, scan.t_ns, scan.rows().collect::<Vec<_>>())).collect();
        assert_eq!(told, [(("a", 0), 7, vec![4]), (("a", 1), 50, vec![0, 2, 3]), (("b", 1), 51, vec![1])]);
        assert_eq!(found[1].1.of(&["p", "q", "r", "s", "t"]), Some(vec!["p", "r", "s"]));
        assert_eq!(found[1].1.of(&["p", "q", "r"]), None);
    }
}
