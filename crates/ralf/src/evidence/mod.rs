//! Evidence besides the paper's: numbers about each detection that a person, a rule or a learner can weigh.
//!
//! A [`Piece`] is a pure function of a [`Frame`] and of what can be told from it, its [`Surroundings`]. It gives one or
//! several columns, each described by its [`Feature`].
//! All pieces stand in [`PIECES`]; whoever writes, shows or learns from evidence goes by that list. Nothing is computed
//! unless it is asked for.
//!
//! A new piece is a file of its own here, its line in [`PIECES`], and a row in `docs/evidence.md`.

mod amplitude;
mod camera;
mod chance;
mod cloud;
mod columns;
mod context;
mod course;
mod distance;
mod doppler;
mod echoes;
mod geometry;
mod going;
mod ground;
mod joint;
mod lidar_map;
mod lidar_rays;
mod lidar_reach;
mod lidar_residual;
mod line_of_sight;
mod meeting;
mod mirror;
mod persistence;
mod probe;
mod pursuit;
mod rates;
mod recurrence;
mod rings;
mod seen_classes;
mod sensor_frame;
mod sought;
mod statistics;
mod surroundings;
mod terrain;
mod wall;
mod way;

pub use probe::Probe;
pub use seen_classes::seen_classes;
pub use surroundings::Surroundings;

use crate::config::Config;
use crate::scene::Frame;

/// Every piece of evidence, in the order of the columns.
pub const PIECES: &[Piece] = &[
    lidar_residual::PIECE,
    ground::PIECE,
    lidar_rays::PIECE,
    lidar_rays::MOVING,
    lidar_reach::PIECE,
    lidar_map::PIECE,
    line_of_sight::PIECE,
    terrain::PIECE,
    amplitude::PIECE,
    doppler::PIECE,
    persistence::PIECE,
    camera::PIECE,
    context::PIECE,
    mirror::PIECE,
    geometry::PIECE,
];

/// What pieces of evidence can belong to. A sensor or circumstance that lacks takes whole groups away.
pub const GROUPS: [&str; 12] = [
    "LiDAR rays",
    "LiDAR map",
    "Line of sight",
    "Ground",
    "Terrain",
    "Amplitude",
    "Doppler",
    "Persistence",
    "Camera",
    "Context",
    "Geometry",
    "Paper",
];

/// What one column says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Feature {
    /// The column's name: lower-case words and underscores, unique.
    pub name: &'static str,
    /// Unit of the values, such as `m` or `sigma`; `1` for a plain number.
    pub unit: &'static str,
    /// What it belongs to: one of [`GROUPS`].
    pub group: &'static str,
    /// One sentence for people, without a full stop.
    pub meaning: &'static str,
}

/// One value per detection, in the scan's order; `None` where it was not observed.
pub type Values = Vec<Option<f64>>;

/// A piece of evidence: what its columns say, and how a frame answers.
#[derive(Debug, Clone, Copy)]
pub struct Piece {
    /// One entry per column.
    pub features: &'static [Feature],
    /// The columns' values, as many as features and in their order.
    pub observe: fn(&Surroundings) -> Vec<Values>,
}

/// A column of evidence on one scan.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it says.
    pub feature: &'static Feature,
    /// What was observed; finite.
    pub values: Values,
}

/// What all columns say, in their order.
pub fn features() -> impl Iterator<Item = &'static Feature> {
    PIECES.iter().flat_map(|piece| piece.features)
}

/// Every piece of evidence on a frame: one column per entry of [`features`], in that order. The settings are those of
/// its `FrameWindow`, which refuses what is out of range.
///
/// ```
/// use ralf::{config::Config, evidence, scene::Frame};
///
/// /// `frame` is that of a `FrameWindow` `with_evidence`.
/// fn print(frame: &Frame) -> String {
///     let columns = evidence::observe(frame, &Config::default());
///     columns.iter().map(|column| format!("{}: {:?}\n", column.feature.name, column.values)).collect()
/// }
/// ```
pub fn observe(frame: &Frame, config: &Config) -> Vec<Column> {
    let surroundings = Surroundings::new(frame, config);
    let mut columns = Vec::new();
    for piece in PIECES {
        for (feature, mut values) in piece.features.iter().zip((piece.observe)(&surroundings)) {
            for value in &mut values {
                *value = value.filter(|value| value.is_finite());
            }
            columns.push(Column { feature, values });
        }
    }
    columns
}
