//! A scenario as its TOML text has it: what stands where, and how the vehicle drives.

mod check;

use super::kind::Kind;
use ralf::config::exact;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why a scenario can't be simulated.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// The text is no scenario.
    #[error(transparent)]
    Toml(#[from] toml::de::Error),
    /// A value that doesn't exist in the world.
    #[error("{key}: expected {expected}, found {found}")]
    Value {
        /// Which one.
        key: &'static str,
        /// What it can be.
        expected: String,
        /// What it is.
        found: String,
    },
}

/// A place and a drive through it. Positions are in the site's frame: x east, y north, m; angles in degrees, to the
/// left.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// For people.
    pub title: String,
    /// Which share of the detections is plausible, in (0, 1).
    #[serde(default = "usual_share")]
    pub plausible_share: f64,
    /// The drive.
    pub ego: Drive,
    /// When cameras fail.
    #[serde(default)]
    pub failure: Vec<CameraFailure>,
    /// Slopes of the ground.
    #[serde(default)]
    pub ramp: Vec<Ramp>,
    /// All that stands, lies or moves on it.
    #[serde(default)]
    pub thing: Vec<Thing>,
}

/// How the vehicle drives: from a start along legs of constant curvature, and straight on after the last.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Drive {
    /// x, y and heading.
    #[serde(deserialize_with = "exact::array")]
    pub start: [f64; 3],
    /// Mean speed, above 0 and below 130 km/h.
    pub speed_kmh: f64,
    /// One after the other.
    #[serde(default)]
    pub leg: Vec<Leg>,
}

/// Part of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Leg {
    /// m, above 0.
    pub length: f64,
    /// Change of heading, to the left.
    #[serde(default)]
    pub turn_deg: f64,
}

/// What goes wrong with a camera.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FailureKind {
    /// No light.
    Dark,
    /// The depth network gives nonsense.
    Garbage,
    /// The sun shines into the lens, and the depth around it is lost.
    Flare,
}

/// A camera that fails for a while.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CameraFailure {
    /// Its name.
    pub camera: String,
    /// How.
    pub kind: FailureKind,
    /// From this time on, s after the start.
    pub from_s: f64,
    /// Until this time, s after the start.
    pub until_s: f64,
}

/// The ground rises along a direction, over its whole width: `tan(slope) * clamp(distance, 0, length)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ramp {
    /// A point at its foot.
    #[serde(deserialize_with = "exact::array")]
    pub at: [f64; 2],
    /// Where it rises to.
    pub direction_deg: f64,
    /// m.
    pub length: f64,
    /// Below 0 it falls.
    pub slope_deg: f64,
}

/// A thing, or a row of equal things.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thing {
    /// What it is.
    pub kind: Kind,
    /// Its centre on the ground.
    #[serde(deserialize_with = "exact::array")]
    pub at: [f64; 2],
    /// Where its length points.
    #[serde(default)]
    pub yaw_deg: f64,
    /// Length, width, height, m; what is usual for its kind if not given.
    #[serde(default, deserialize_with = "exact::optional")]
    pub size: Option<[f64; 3]>,
    /// How many: 1 to 1000.
    #[serde(default = "one")]
    pub count: usize,
    /// From one to the next.
    #[serde(default, deserialize_with = "exact::array")]
    pub step: [f64; 2],
    /// Speed of moving ones, m/s.
    #[serde(default, deserialize_with = "exact::array")]
    pub velocity: [f64; 2],
}

fn usual_share() -> f64 {
    0.215
}

fn one() -> usize {
    1
}

impl Scenario {
    /// Reads a scenario; every value is checked.
    ///
    /// ```
    /// let text = "title = 'A pole'
    /// ego = { start = [0, 0, 0], speed_kmh = 7 }
    /// thing = [{ kind = 'pole', at = [9, 3] }]";
    /// assert_eq!(ralf_sim::Scenario::from_toml(text)?.thing.len(), 1);
    /// # Ok::<(), ralf_sim::ScenarioError>(())
    /// ```
    pub fn from_toml(text: &str) -> Result<Self, ScenarioError> {
        let scenario: Self = toml::from_str(text)?;
        scenario.check()?;
        Ok(scenario)
    }
}
