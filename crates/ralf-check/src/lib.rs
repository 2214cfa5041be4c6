//! Is a recording what it says? Extrinsics, clocks, units and signs are judged by what the sensors themselves measure.
//!
//! Labels from a recording whose yaw is off by five degrees look like any others. This crate asks the sensors about
//! each other, and says of each what speaks for or against it, and what would put it right:
//!
//! - [`doppler`]: detections of what stands still tell a radar's own velocity. It has to be the one that the
//!   vehicle's motion gives it: direction (yaw), size (units), sign, and time (clock).
//! - `overlap`: detections lie where LiDAR points do, and LiDAR points where they lie half a second later, as
//!   recorded and under changes. What fits clearly better is named.
//! - `ground`: the plane that the LiDAR sees has to be the vehicle's z = 0.
//! - `picture`: edges of images lie where the LiDAR sees things end, and stored depth grows with the LiDAR's.
//! - `wheels`: odometry has to be the motion that poses beside it tell.
//! - `bounds`: what no sensor gives and no vehicle does.
//!
//! And it tells how the vehicle moved where nobody recorded it: [`doppler::from_doppler`], [`odometry::from_lidar`].
//!
//! Pure, like the method: no files, no printing. Everything follows from the recording alone, so the same recording
//! has the same answers.

mod bounds;
mod change;
pub mod doppler;
mod ground;
mod judge;
mod misread;
pub mod odometry;
mod overlap;
mod picture;
mod plan_field;
mod remedy;
mod sample;
mod statistics;
mod thinning;
mod velocity_fit;
mod verdict;
mod wheels;

pub use change::{MotionChange, SensorChange};
pub use judge::{Refinement, check, check_and_refine, check_with_figures};
pub use remedy::{Remedy, Setting, toml_key};
pub use verdict::{Question, RadarFigures, SequenceCheck, State, Verdict};
