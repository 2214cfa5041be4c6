//! What people say of labels, kept beside the machine's labels in one SQLite file, `OUT/corrections.sqlite`.
//!
//! The unit of editing is a [`Stroke`]: one author gives one label to detections of one or several scans, with
//! one tool. [`Store::apply`] has it on disk, whole or not at all, before it returns. Machine labels are never
//! touched: a correction lies above them, and taking it away (a stroke without a label) shows them again.
//!
//! - **Undo and redo** belong to an author and a sequence, go back without limit and survive restarts. A group
//!   of strokes is one step, and so is a mark of review. A new stroke ends what that author could redo there,
//!   yet its record stays: nothing is ever deleted.
//! - **Conflicts.** A scan counts its changes: its revision. Whoever edits names the revision seen, and where
//!   another edit came first nothing is written: the answer is [`Outcome::Conflict`], which tells whose edit it
//!   was. A step can be undone unless a later stroke changed one of its detections, too.
//! - **Named edits** ([`Who::edit`]) are made once, however often they are asked for: whoever lost the answer
//!   may ask again.
//! - **Contents.** What is said belongs to a scan *with what it held* ([`ContentHash`]). On another content it
//!   is kept and never applied, until that content is back.
//! - **Reviewed marks** keep the machine's labels of that moment, so that labelling again changes nothing that
//!   was accepted.
//! - **Disagreements.** Who labels a second time without seeing the first labels has a store of its own. Strokes
//!   of the tool [`SETTLE`] in the store that counts say which of both is right; what was said before them is
//!   never lost ([`ScanLayer::before_settling`]), so that agreement can be told for ever.
//! - **The file** is made and moved to its place whole. One that is empty, damaged or another program's is
//!   refused, and so is one with another one's journal beside it; one that is deleted, replaced or written over
//!   while it is open is noticed with the next question, and nothing counts as saved any more.
//!
//! What is said of a detection is, in this order: its correction; the label accepted when its scan was marked
//! reviewed; nothing.
//!
//! ```
//! use ralf_corrections::{ContentHash, Outcome, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, Stroke, Who};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let folder = tempfile::tempdir()?;
//! # let file = folder.path().join("corrections.sqlite");
//! let mut store = Store::open(&file)?;
//! let ada = Who::named("ada");
//! let content = ScanContent { detections: 400, hash: Some(ContentHash::new([7; 32])) };
//! let (radar, detections) = ("front".to_owned(), content.detections);
//! let points = vec![3, 5];
//! let edit = ScanEdit { radar, scan: 17, detections, content: content.hash, base: 0, points };
//! let stroke = Stroke { tool: "lasso".into(), label: Some(99), scans: vec![edit], ..Stroke::of_sequence("00") };
//! assert!(matches!(store.apply(&stroke, &ada)?, Outcome::Done(done) if done.changed == 2));
//! let key = ScanKey { sequence: "00".into(), radar: "front".into(), scan: 17 };
//! let version = ScanVersion { key, content };
//! assert_eq!(store.scan(&version)?.corrections, [(3, 99), (5, 99)]);
//! store.undo("00", &ada)?;
//! assert_eq!(store.scan(&version)?.corrections, []);
//! # Ok(())
//! # }
//! ```

mod alone;
mod answered;
mod apply;
mod causes;
mod changes;
mod conflict;
mod connect;
mod content;
mod error;
mod history;
mod identity;
mod layer;
mod met;
mod model;
mod outcome;
mod read;
mod reader;
mod review;
mod sayings;
mod schema;
mod settled;
mod standing;
mod steps;
mod store;
mod tables;
mod workday;
mod write;

pub use changes::{Change, Changes};
pub use content::{ContentHash, ScanContent};
pub use error::StoreError;
pub use layer::{ScanLayer, read_layer};
pub use model::{Mark, ScanEdit, ScanKey, ScanVersion, Stroke, Who};
pub use outcome::{Conflict, Edit, History, Outcome, Review, ScanState, Step};
pub use read::ScanSummary;
pub use reader::Reader;
pub use sayings::Saying;
pub use settled::SETTLE;
pub use store::Store;
pub use workday::{PAUSE_S, Workday};

/// The file's name in an output folder.
pub const FILE: &str = "corrections.sqlite";
