//! ROS 1 bags, MCAP files and ROS 2 folders: one sequence, named after the file.
//!
//! The table `topics` of the settings says which topic is which sensor; without one a first guess is made, and said.
//! Opening reads the whole file once: times are those of the messages' headers, which no index knows.

mod camera;
mod cloud;
mod frames;
mod guess;
mod inspection;
mod messages;
mod motion;
mod mounting;
mod pixels;
mod point_clock;
mod range_rate;
mod same_radar;
mod sensors;
mod source;
mod survey;
#[cfg(test)]
mod tests;
mod topics;
mod track;
mod unread;
mod vehicle;

use crate::error::DataError;
use crate::read::Recording;
pub(crate) use cloud::derives_doppler;
pub use guess::{Guess, guess, topics_toml};
pub use inspection::{RosInspection, TopicInspection, inspect, is_ros};
use messages::Messages;
use ralf_ros::container::ContainerError;
use source::Drive;
pub(crate) use source::RosOrigin;
use std::path::Path;
pub(crate) use topics::check as check_topics;
pub use topics::{Stamps, TopicConfig, TopicKind, Topics};

/// As `--format` takes it.
pub const NAME: &str = "ros";
/// How the topics end that `ralf export` adds: clouds with labels, which are no sensor's.
pub(crate) const LABELLED: &str = "/points_labelled";

/// Opens a file or folder whose topics these are; a first guess is made where there are none.
pub(crate) fn open(path: &Path, topics: &Topics) -> Result<Recording, DataError> {
    let messages = Messages::open(path)?;
    let mut warnings: Vec<String> = messages.container().losses().iter().map(ToString::to_string).collect();
    let topics = if topics.is_empty() {
        let Guess { topics, remarks } = guess::of_messages(&messages);
        warnings.push(
            "no table `topics` in the settings: a first guess of it is used; `ralf inspect` shows it"
                .to_owned(),
        );
        warnings.extend(remarks);
        topics
    } else {
        topics.clone()
    };
    let drive = Drive::new(messages, &topics, warnings)?;
    Ok(Recording::new(path, NAME, vec![Box::new(drive)]))
}

impl From<ContainerError> for DataError {
    fn from(error: ContainerError) -> Self {
        match error {
            ContainerError::Io { file, error } => Self::Io { file, error },
            ContainerError::Content { file, place, expected, found } => {
                Self::Content { file, place, expected, found }
            }
        }
    }
}
