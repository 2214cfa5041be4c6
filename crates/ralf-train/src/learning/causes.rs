//! Why artifacts are such: a forest for each cause, of artifacts alone.

use super::boosting::{Bins, Examples, Parameters, boost};
use super::fitting::Fitting;
use super::table::TrainingTable;
use ralf::label::Cause;
use ralf::learned::{CauseForest, Rows};
use ralf_jobs::side_by_side;
use std::convert::Infallible;

/// Rows of a cause from which it can be learned.
const FEWEST: usize = 100;
/// Of so many trees, and of so many leaves, a cause's forest has one: there is a forest for each cause.
const PARTS: [usize; 2] = [2, 4];

/// The forest of each cause that enough rows have, in the causes' order.
pub(super) fn cause_forests(
    table: &TrainingTable,
    rows: &Rows,
    bins: &Bins,
    fitting: &Fitting,
) -> Vec<CauseForest> {
    let of_known_cause =
        |row: &u32| table.known[*row as usize].cause != 0 && !table.known[*row as usize].plausible;
    let train: Vec<u32> = (0..table.len() as u32).filter(of_known_cause).collect();
    let count =
        |cause: &Cause| train.iter().filter(|row| table.known[**row as usize].cause == *cause as u8).count();
    let causes: Vec<Cause> = Cause::ALL.into_iter().skip(1).filter(|cause| count(cause) >= FEWEST).collect();
    let weights = vec![1.0; table.len()];
    let either_way = vec![0; table.features.len()];
    let parameters = Parameters {
        rounds: fitting.parameters.rounds.div_ceil(PARTS[0]),
        leaves: fitting.parameters.leaves.div_ceil(PARTS[1]).max(2),
        ..fitting.parameters.clone()
    };
    let Ok(forests) = side_by_side(&causes, fitting.jobs, |cause| {
        let target: Vec<bool> = table.known.iter().map(|known| known.cause == *cause as u8).collect();
        let (target, weights, monotone) = (&target, &weights, &either_way);
        let examples = Examples { rows, bins, target, weights, monotone, begin: None };
        let forest = boost(&examples, &train, &parameters).forest;
        Ok::<_, Infallible>(CauseForest { name: cause.name().to_owned(), forest })
    });
    forests
}
