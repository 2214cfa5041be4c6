//! What a search goes by, bounded: a trial costs no more after thousands of others than after some hundred.

use std::convert::Infallible;
use tpe::density_estimation::{BuildDensityEstimator, DefaultEstimator, DefaultEstimatorBuilder};
use tpe::range::Range;

/// So many trials tell where the good ones lie, and as many where the others do: an estimator asks each of them for
/// every candidate of every trial to come.
const MOST: usize = 512;

/// An estimator of at most [`MOST`] of the trials that it is told of: all of fewer, else every so many of them. They
/// come ordered by how good they were, so that good and bad ones are thinned alike.
#[derive(Debug)]
pub(super) struct Thinned(pub(super) DefaultEstimatorBuilder);

impl BuildDensityEstimator for Thinned {
    type Estimator = DefaultEstimator;
    type Error = Infallible;

    fn build_density_estimator<I>(&self, values: I, range: Range) -> Result<DefaultEstimator, Infallible>
    where
        I: Iterator<Item = f64> + Clone,
    {
        self.0.build_density_estimator(thinned(values), range)
    }
}

fn thinned<I: Iterator + Clone>(values: I) -> impl Iterator<Item = I::Item> + Clone {
    let step = values.clone().count().div_ceil(MOST).max(1);
    values.step_by(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_all_count_and_of_many_no_more_than_so_many() {
        for count in [0, 1, MOST] {
            assert!(thinned(0..count).eq(0..count));
        }
        assert!(thinned(0..MOST + 1).eq((0..MOST + 1).step_by(2)));
        assert!((1..40).all(|times| thinned(0..times * 997).count() <= MOST));
    }
}
