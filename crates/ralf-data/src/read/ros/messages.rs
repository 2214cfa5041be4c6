//! A recording's messages, decoded; errors name the topic and the time at which the message was recorded.

use crate::error::{DataError, expected_and_found};
use ralf_ros::container::{Container, MessageRef, Topic};
use ralf_ros::encoding::{Encoding, EncodingError};
use ralf_ros::message::{Definition, Header, Message, peek_header};
use std::path::{Path, PathBuf};

pub(super) struct Messages {
    path: PathBuf,
    container: Container,
}

impl Messages {
    pub(super) fn open(path: &Path) -> Result<Self, DataError> {
        Ok(Self { path: path.to_owned(), container: Container::open(path)? })
    }

    pub(super) fn container(&self) -> &Container {
        &self.container
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The places of the topics of this name and these types, for publishers may spell one type in two ways; `asked_by`
    /// is what an error is said of.
    pub(super) fn resolve(
        &self,
        asked_by: &str,
        name: &str,
        types: &[&Definition],
    ) -> Result<Vec<usize>, DataError> {
        let refused =
            |expected: String, found: String| DataError::content(&self.path, asked_by, expected, found);
        let topics = self.container.topics();
        let fits = |topic: &Topic| types.iter().any(|definition| definition.is(&topic.type_name));
        let wanted = types.iter().map(|definition| definition.name).collect::<Vec<_>>().join(" or ");
        let all: Vec<_> = topics.iter().enumerate().filter(|(_, topic)| topic.name == name).collect();
        if all.is_empty() {
            let fitting = topics.iter().filter(|topic| fits(topic));
            let expected = match fitting.map(|topic| topic.name.as_str()).collect::<Vec<_>>().as_slice() {
                [] => format!("a topic of the type {wanted}, of which there is none"),
                known => format!("one of the topics of the type {wanted}: {}", known.join(", ")),
            };
            return Err(refused(expected, format!("`{name}`")));
        }
        let fitting: Vec<_> = all.iter().filter(|(_, topic)| fits(topic)).collect();
        let Some((_, first)) = fitting.first() else {
            let found: Vec<&str> = all.iter().map(|(_, topic)| topic.type_name.as_str()).collect();
            return Err(refused(format!("`{name}` of the type {wanted}"), found.join(", ")));
        };
        let known = fitting.iter().filter(|(_, topic)| topic.known_encoding().is_some());
        let known: Vec<usize> = known.map(|(place, _)| *place).collect();
        if known.is_empty() {
            return Err(refused(format!("`{name}` in the encoding ros1 or cdr"), first.encoding.clone()));
        }
        Ok(known)
    }

    /// Whether a topic is there and has no messages.
    pub(super) fn is_silent(&self, name: &str) -> bool {
        let mut named = self.container.topics().iter().filter(|topic| topic.name == name).peekable();
        named.peek().is_some() && named.all(|topic| topic.count == 0)
    }

    /// The place of a message's topic.
    pub(super) fn topic_of(&self, message: &MessageRef) -> usize {
        self.container.topic_of(message)
    }

    pub(super) fn topic(&self, message: &MessageRef) -> &Topic {
        &self.container.topics()[self.topic_of(message)]
    }

    /// A message of this type.
    pub(super) fn decode<M: Message>(&self, message: &MessageRef) -> Result<M, DataError> {
        let bytes = self.container.read(message)?;
        self.decoded(message, &bytes, M::from_bytes)
    }

    /// What `decode` makes of the bytes of a message.
    pub(super) fn decoded<T>(
        &self,
        message: &MessageRef,
        bytes: &[u8],
        decode: impl FnOnce(Encoding, &[u8]) -> Result<T, EncodingError>,
    ) -> Result<T, DataError> {
        let encoding = self.topic(message).known_encoding().ok_or_else(|| {
            self.error(message, "encoding", "ros1 or cdr", self.topic(message).encoding.clone())
        })?;
        decode(encoding, bytes).map_err(|EncodingError { position, expected, found }| {
            self.error(message, &format!("byte {position}"), expected, found)
        })
    }

    pub(super) fn header(&self, message: &MessageRef, bytes: &[u8]) -> Result<Header, DataError> {
        self.decoded(message, bytes, peek_header)
    }

    /// The header of a message that wasn't read yet.
    pub(super) fn read_header(&self, message: &MessageRef) -> Result<Header, DataError> {
        self.header(message, &self.container.read(message)?)
    }

    /// Something that is wrong with a message.
    pub(super) fn error(
        &self,
        message: &MessageRef,
        place: &str,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> DataError {
        let place = format!("{} recorded at {} ns, {place}", self.topic(message).name, message.log_ns);
        DataError::content(&self.path, place, expected, found)
    }

    /// The same of a sentence `expected X, found Y`.
    pub(super) fn refused(&self, message: &MessageRef, place: &str, reason: &str) -> DataError {
        let (expected, found) = expected_and_found(reason);
        self.error(message, place, expected, found)
    }
}
