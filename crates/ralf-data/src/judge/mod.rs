//! How good a run's labels are: against a truth, and without one.

mod balance;
mod doubt;
mod evaluation;

pub use balance::{Balance, Balances};
pub use doubt::{DISAGREEING, Doubts, UNCERTAIN, is_uncertain};
pub use evaluation::Comparison;
