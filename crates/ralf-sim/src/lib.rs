//! A simulator: recordings with a truth, from nothing but a scenario and a seed. Pure: no files, clocks, threads or
//! printing.
//!
//! 1. A [`Scenario`] (TOML; [`presets`] holds ready ones) says what stands where and how the vehicle drives.
//! 2. Built up it is a site: bodies that rays meet, and scatterers that reflect radar waves. A scene is the site at one
//!    moment.
//! 3. The LiDAR casts rays and adds noise, drop-outs and leaves. Radars see scatterers by rules of their own: they look
//!    under cars and through leaves, and report clutter, mirror images, bounces, side lobes, the inside of buildings
//!    and noise. Fisheye cameras are rendered, with what a depth network would make of their views. Wheels slip.
//! 4. [`SimulatedSequence`] is all that as a [`ralf::sensors::Source`], with the [`Truth`] of every detection beside
//!    it.
//!
//! The truth follows the paper's labelling policy: facades, vehicles with their inside, poles, people, vegetation and
//! grass are plausible; the road, mirror images and the inside of buildings are not. It is known from what sent an
//! echo, and never from what LiDAR or cameras see. Each artifact has a [`Cause`](ralf::label::Cause).
//!
//! [`world`] has another kind of sequences: worlds that a seed draws, each with sensors and physics of its own, whose
//! radars follow the radar equation. [`sketch`] has a third, of which the second knows nothing.
//!
//! Every measurement follows from (seed, sensor, number) alone: the same seed gives the same bytes in any order.

mod bvh;
mod camera;
mod drawn;
mod ground;
mod kind;
mod lidar;
mod mounting;
mod odometry;
mod path;
pub mod presets;
mod radar;
mod random;
mod scatterer;
mod scenario;
mod scenario_sequence;
mod scene;
mod shape;
mod simulated;
mod simulation;
mod site;
pub mod sketch;
mod solid;
mod spread;
mod truth;
mod vehicle;
pub mod world;

pub use drawn::{DrawnRecording, Worlds};
pub use kind::Kind;
pub use scenario::{CameraFailure, Drive, FailureKind, Leg, Ramp, Scenario, ScenarioError, Thing};
pub use simulated::SimulatedSequence;
pub use truth::Truth;
