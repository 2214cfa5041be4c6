//! Messages of the recording that a sequence is read from, copied byte for byte.

use super::{FileWriter, written};
use crate::error::DataError;
use crate::read::ros::{LABELLED, RosOrigin};
use crate::read::{Altered, SequenceReader};
use ralf_ros::container::{Channel, Container, MessageRef};
use ralf_ros::writer::{RawTopic, WriteError};
use std::path::Path;

/// The recording behind a sequence, and which of its topics are copied.
pub(super) struct Originals<'a> {
    origin: &'a RosOrigin,
    container: &'a Container,
    /// One for each channel of the recording; an earlier export's labels are not copied.
    channels: Vec<Option<RawTopic>>,
}

impl<'a> Originals<'a> {
    /// Adds the recording's topics; `None` where there is none, or one that is encoded otherwise, or where settings
    /// alter more than `at_most`: the messages would say it as it was before.
    pub(super) fn of(
        reader: &'a dyn SequenceReader,
        at_most: Altered,
        writer: &mut FileWriter,
    ) -> Result<Option<Self>, WriteError> {
        if reader.altered() > at_most {
            return Ok(None);
        }
        let Some(origin) = RosOrigin::of(reader) else { return Ok(None) };
        let container = origin.container();
        let is_copied = |channel: &&Channel| !channel.topic.ends_with(LABELLED);
        if !container.channels().iter().filter(is_copied).all(|channel| writer.can_copy(channel)) {
            return Ok(None);
        }
        let copy = |channel| is_copied(&channel).then(|| writer.raw_topic(channel)).transpose();
        let channels = container.channels().iter().map(copy).collect::<Result<_, _>>()?;
        Ok(Some(Self { origin, container, channels }))
    }

    /// The frame of each radar.
    pub(super) fn radar_frames(&self) -> &'a [String] {
        self.origin.radar_frames()
    }

    /// When the message that holds a radar's scan was recorded, ns: what is said of it belongs beside it, whatever
    /// clock the radar has.
    pub(super) fn radar_log(&self, radar: usize, scan: usize) -> Option<i64> {
        self.origin.radar_log(radar, scan)
    }

    /// When each message that is copied was recorded.
    pub(super) fn times(&self) -> impl Iterator<Item = (i64, usize)> {
        let copied = |(_, message): &(usize, &MessageRef)| self.channels[message.channel()].is_some();
        let messages = self.container.messages().iter().enumerate().filter(copied);
        messages.map(|(place, message)| (message.log_ns, place))
    }

    /// Copies a message.
    pub(super) fn copy(&self, place: usize, writer: &mut FileWriter, file: &Path) -> Result<(), DataError> {
        let message = &self.container.messages()[place];
        let Some(channel) = &self.channels[message.channel()] else { return Ok(()) };
        let bytes = self.container.read(message)?;
        writer.write_raw(channel, message.log_ns, &bytes).map_err(written(file))
    }
}
