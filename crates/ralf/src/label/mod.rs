//! What a result says: the classes that labels name, why a detection is an artifact, and the flags beside a
//! plausibility.

mod cause;
mod classes;
pub mod flag;

pub use cause::Cause;
pub use classes::{ARTIFACT, Cluster, PLAUSIBLE, UNLABELED, class_name, cluster_of, truth_of};
