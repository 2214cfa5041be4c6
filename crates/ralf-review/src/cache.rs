//! Values that take a while to make, the last few of them kept.

use std::sync::{Arc, Mutex, PoisonError};

/// Keeps at most `capacity` values, and forgets the one that was not asked for the longest.
pub(crate) struct Cache<K, V> {
    capacity: usize,
    /// The last one is the most recent.
    entries: Mutex<Vec<(K, Slot<V>)>>,
}

/// A value, or its place while it is made.
type Slot<V> = Arc<Mutex<Option<Arc<V>>>>;

impl<K: PartialEq, V> Cache<K, V> {
    pub(crate) fn new(capacity: usize) -> Self {
        Self { capacity, entries: Mutex::new(Vec::new()) }
    }

    /// The value of a key, made if it isn't kept or no longer good. Who asks for it meanwhile waits; for
    /// another one nobody does.
    pub(crate) fn get<E>(
        &self,
        key: K,
        good: impl FnOnce(&V) -> bool,
        make: impl FnOnce() -> Result<V, E>,
    ) -> Result<Arc<V>, E> {
        let slot = self.slot(key);
        let mut held = slot.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = held.as_ref().filter(|value| good(value)) {
            return Ok(known.clone());
        }
        let made = Arc::new(make()?);
        *held = Some(made.clone());
        Ok(made)
    }

    /// The slot of a key, which thereby becomes the most recent.
    fn slot(&self, key: K) -> Slot<V> {
        let mut entries = self.entries.lock().unwrap_or_else(PoisonError::into_inner);
        let known = entries.iter().position(|(kept, _)| *kept == key).map(|at| entries.remove(at).1);
        let slot = known.unwrap_or_default();
        entries.push((key, slot.clone()));
        let surplus = entries.len().saturating_sub(self.capacity);
        entries.drain(..surplus);
        slot
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_asked_for_is_forgotten_and_what_is_bad_made_again() {
        let cache = Cache::new(2);
        let made = |key: u8, good: bool| {
            let mut made = false;
            let make = || {
                made = true;
                Ok::<_, ()>(key * 10)
            };
            assert_eq!(*cache.get(key, |_| good, make).unwrap(), key * 10);
            made
        };
        assert!(made(1, true) && made(2, true));
        assert!(!made(1, true));
        assert!(made(3, true), "and 2 is forgotten");
        assert!(!made(1, true) && made(2, true));
        assert!(made(2, false));
        assert!(cache.get(9, |_| true, || Err("unreadable")).is_err());
    }
}
