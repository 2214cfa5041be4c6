//! The last few things that were asked for.

/// Remembers at most `capacity` values, and forgets the one that was not asked for the longest.
#[derive(Debug)]
pub(crate) struct Recent<K, V> {
    capacity: usize,
    /// The last one is the most recent.
    entries: Vec<(K, V)>,
}

impl<K: PartialEq, V: Clone> Recent<K, V> {
    /// Room for `capacity` values, at least one.
    pub(crate) fn new(capacity: usize) -> Self {
        Self { capacity: capacity.max(1), entries: Vec::new() }
    }

    /// Room for how many values.
    pub(crate) fn capacity(&self) -> usize {
        self.capacity
    }

    /// The value of a key, which thereby becomes the most recent.
    pub(crate) fn get(&mut self, key: &K) -> Option<V> {
        let at = self.entries.iter().rposition(|(known, _)| known == key)?;
        let entry = self.entries.remove(at);
        let value = entry.1.clone();
        self.entries.push(entry);
        Some(value)
    }

    /// Forgets these.
    pub(crate) fn forget(&mut self, which: impl Fn(&K) -> bool) {
        self.entries.retain(|(known, _)| !which(known));
    }

    /// Remembers a value.
    pub(crate) fn insert(&mut self, key: K, value: V) {
        self.entries.retain(|(known, _)| *known != key);
        if self.entries.len() == self.capacity {
            self.entries.remove(0);
        }
        self.entries.push((key, value));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forgets_what_was_not_asked_for() {
        let mut recent = Recent::new(2);
        recent.insert(1, "one");
        recent.insert(2, "two");
        assert_eq!(recent.get(&1), Some("one"));
        recent.insert(3, "three");
        assert_eq!((recent.get(&2), recent.get(&1), recent.get(&3)), (None, Some("one"), Some("three")));
        recent.insert(1, "uno");
        assert_eq!(recent.get(&1), Some("uno"));
        recent.forget(|key| *key > 2);
        assert_eq!((recent.get(&1), recent.get(&3)), (Some("uno"), None));
    }
}
