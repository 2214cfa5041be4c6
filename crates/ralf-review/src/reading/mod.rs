//! What the page sees of the recording and the run.

mod camera;
mod detections;
mod disagreements;
mod kinds;
mod lidar;
mod lidar_map;
mod moment;
mod opinion;
mod past;
mod projection;
mod queue;
mod recording;
mod said;
mod things;

pub(crate) use camera::image;
pub(crate) use detections::{check_size, detections, machine_labels, reviewed, stamp};
pub(crate) use disagreements::disagreements;
pub(crate) use kinds::{AskedKinds, kinds};
pub(crate) use lidar::{Near, cloud, near};
pub(crate) use lidar_map::map;
pub(crate) use moment::{Moment, moment};
pub(crate) use opinion::{Around, opinion};
pub(crate) use past::{About, people, said};
pub(crate) use projection::{LidarProjection, Projection, lidar_projection, projection, thing_projection};
pub(crate) use queue::{progress, queue};
pub(crate) use recording::recording;
pub(crate) use things::{doubtful, things};

use crate::http::ApiError;
use ralf::space::Transform;
use serde_json::{Value, json};

/// A time, which may be more than a JavaScript number can hold.
fn time(t_ns: i64) -> Value {
    Value::String(t_ns.to_string())
}

/// A time, as a query has it.
fn read_time(text: &str) -> Result<i64, ApiError> {
    text.parse().map_err(|error| ApiError::Malformed(format!("query: t_ns: expected nanoseconds: {error}")))
}

fn times(times: &[i64]) -> Vec<Value> {
    times.iter().copied().map(time).collect()
}

/// 16 numbers, row by row.
fn matrix(transform: &Transform) -> Value {
    json!(transform.to_homogeneous().transpose().as_slice())
}
