//! How good a run's labels are: against a truth, and without one.

mod balance;
mod evaluation;

pub use balance::{Balance, Balances};
pub use evaluation::Comparison;
