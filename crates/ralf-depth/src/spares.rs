//! Things that only one thread can use at a time, one for each thread that needs one at the same time.

use std::sync::{Mutex, PoisonError};

/// Those that nobody uses at the moment.
pub(crate) struct Spares<T>(Mutex<Vec<T>>);

impl<T> Spares<T> {
    /// With some to begin with.
    pub(crate) fn holding(spares: Vec<T>) -> Self {
        Self(Mutex::new(spares))
    }

    /// Does something with a spare one, or with a new one where all are in use, and keeps it.
    ///
    /// One that a panic came through is not kept.
    pub(crate) fn with<R, E>(
        &self,
        make: impl FnOnce() -> Result<T, E>,
        work: impl FnOnce(&mut T) -> Result<R, E>,
    ) -> Result<R, E> {
        let spare = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut one = spare.map_or_else(make, Ok)?;
        let result = work(&mut one);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(one);
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn made_only_while_all_others_are_in_use() {
        let spares = Spares::<u8>::holding(Vec::new());
        let use_one = |made: u8, nested: bool| {
            spares.with(
                || Ok::<_, ()>(made),
                |first| {
                    if nested {
                        assert_eq!(spares.with(|| Ok::<_, ()>(made + 1), |second| Ok(*second)), Ok(made + 1));
                    }
                    Ok(*first)
                },
            )
        };
        assert_eq!(use_one(1, true), Ok(1));
        assert!([Ok(1), Ok(2)].contains(&use_one(9, false)));
        assert_eq!(spares.0.lock().unwrap().len(), 2);
        assert_eq!(Spares::<u8>::holding(Vec::new()).with(|| Err("none"), |_| Ok(())), Err("none"));
    }
}
