//! What people say of labels, kept beside the machine's labels in one SQLite file, `OUT/corrections.sqlite`.
//!
//! The unit of editing is a [`Stroke`]: one author gives one label to detections of one or several scans, with one tool.
//! [`Store::apply`] has it on disk, whole or not at all, before it returns. Machine labels are never touched: a correction
//! lies above them, and taking it away (a stroke without a label) shows them again.
//!
//! - **Undo and redo** belong to an author and a sequence, go back without limit and survive restarts. A group of strokes is
//!   one step. A new stroke ends what that author could redo there, yet its record stays: nothing is ever deleted.
//! - **Conflicts.** A scan counts its changes: its revision. Whoever edits names the revision seen, and where another edit came
//!   first nothing is written: the answer is [`Outcome::Conflict`], which tells whose edit it was. A step can be undone unless a
//!   later stroke changed one of its detections, too.
//! - **Reviewed marks** keep the machine's labels of that moment, so that labelling again changes nothing that was accepted.
//!
//! What is said of a detection is, in this order: its correction; the label accepted when its scan was marked reviewed; nothing.
//!
//! ```
//! use ralf_corrections::{Outcome, ScanEdit, ScanKey, Store, Stroke, Who};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let file = folder.path().join("corrections.sqlite");
//! let mut store = Store::open(&file)?;
//! let ada = Who { author: "ada".into(), tab: None };
//! let edit = ScanEdit { radar: "front".into(), scan: 17, detections: 400, base: 0, points: vec![3, 5] };
//! let stroke = Stroke { tool: "lasso".into(), label: Some(99), scans: vec![edit], ..Stroke::of_sequence("00") };
//! assert!(matches!(store.apply(&stroke, &ada)?, Outcome::Done(done) if done.changed == 2));
//! let key = ScanKey { sequence: "00".into(), radar: "front".into(), scan: 17 };
//! assert_eq!(store.scan(&key)?.corrections, [(3, 99), (5, 99)]);
//! store.undo("00", &ada)?;
//! assert_eq!(store.scan(&key)?.corrections, []);
//! # Ok(())
//! # }
//! ```

mod apply;
mod changes;
mod conflict;
mod error;
mod history;
mod layer;
mod model;
mod review;
mod schema;
mod steps;
mod store;

pub use changes::{Change, Changes};
pub use error::StoreError;
pub use layer::{ScanLayer, read_layer};
pub use model::{Conflict, Edit, History, Outcome, Review, ScanEdit, ScanKey, ScanState, Step, Stroke, Who};
pub use review::{Mark, Marked};
pub use store::{ScanSummary, Store};

/// The file's name in an output folder.
pub const FILE: &str = "corrections.sqlite";
