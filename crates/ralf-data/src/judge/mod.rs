//! How good a run's labels are: against a truth, and without one.

mod agreement;
mod balance;
mod doubt;
mod evaluation;
mod queue;
mod told;
mod worth;

pub use agreement::{
    Agreement, Difference, compare, disagreements, is_about_plausibility, kappa, kappa_of_names,
};
pub use balance::{Balance, Balances};
pub use doubt::{Certainty, DISAGREEING, Doubts, SURE, UNCERTAIN};
pub use evaluation::{Comparison, Missing};
pub use queue::{QueueCurve, TENTHS};
pub use told::label_name;
