//! Making MCAP files and ROS 1 bags, message by message, in bounded memory.

mod bag;
mod mcap_file;

use crate::container::{Channel, Schema};
use crate::encoding::{Encoding, EncodingError};
use crate::message::{DEFINITIONS, Definition, Message};
use bag::BagWriter;
use mcap_file::McapWriter;
use std::io::{Seek, Write};
use std::marker::PhantomData;
use thiserror::Error;

/// How the chunks of an MCAP file are compressed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compression {
    /// Not at all.
    None,
    /// By zstd, on one thread, so that the same messages give the same bytes.
    Zstd,
}

/// Who gets the messages of a topic when they are played back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Delivery {
    /// Those who listen.
    Live,
    /// Also who comes later, as static transforms and calibrations need it: ROS 1 says latched, ROS 2 transient local.
    Latched,
}

/// Why a recording could not be written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The system refused.
    #[error(transparent)]
    Io(#[from] std::io::Error),
    /// The MCAP library refused.
    #[error("MCAP: {0}")]
    Mcap(#[from] mcap::McapError),
    /// The message has values that its encoding can't hold.
    #[error("{topic}: {error}")]
    Message {
        /// The topic.
        topic: String,
        /// Why.
        error: EncodingError,
    },
    /// The recording has values that its format can't hold.
    #[error("expected {expected}, found {found}")]
    Content {
        /// What the format can hold.
        expected: &'static str,
        /// What it was given.
        found: String,
    },
}

/// A topic of a recording in the making, for messages of one type.
#[derive(Debug)]
pub struct Topic<M> {
    id: u32,
    name: String,
    of: PhantomData<fn(M)>,
}

/// A channel whose messages are copied from another recording.
#[derive(Debug)]
pub struct RawTopic {
    id: u32,
}

/// What a file writes down of the messages of a topic.
struct Described {
    type_name: String,
    /// How the messages are written.
    encoding: String,
    schema: Schema,
    delivery: Delivery,
    /// The node of ROS 1 that sent them; empty where that doesn't matter.
    publisher: String,
}

impl Described {
    fn known(definition: &Definition, encoding: Encoding, delivery: Delivery) -> Self {
        let (name, language) = match encoding {
            Encoding::Ros1 => ("ros1", "ros1msg"),
            Encoding::Cdr => ("cdr", "ros2msg"),
        };
        let text = definition.text(encoding).into_bytes();
        let schema = Schema { encoding: language.to_owned(), text, md5: definition.md5.to_owned() };
        let (type_name, encoding) = (definition.type_name(encoding), name.to_owned());
        Self { type_name, encoding, schema, delivery, publisher: String::new() }
    }
}

impl From<&Channel> for Described {
    /// Where the recording doesn't tell what a type is made of, but this program knows, it does.
    fn from(channel: &Channel) -> Self {
        let delivery = if channel.latched { Delivery::Latched } else { Delivery::Live };
        let known = DEFINITIONS.into_iter().find(|definition| definition.is(&channel.type_name));
        let known = known.zip(channel.known_encoding());
        let known = known.map(|(known, encoding)| Self::known(known, encoding, delivery).schema);
        let Channel { type_name, encoding, schema, publisher, .. } = channel.clone();
        let schema = match known {
            Some(known) if schema.text.is_empty() => known,
            Some(known) if schema.md5.is_empty() => Schema { md5: known.md5, ..schema },
            _ => schema,
        };
        Self { type_name, encoding, schema, delivery, publisher }
    }
}

/// A recording in the making. Without [`Self::finish`] it is one that was cut short.
pub struct MessageWriter<W: Write + Seek> {
    container: Container<W>,
}

enum Container<W: Write + Seek> {
    Bag(BagWriter<W>),
    Mcap(Box<McapWriter<W>>),
}

impl<W: Write + Seek> MessageWriter<W> {
    /// An MCAP file of the profile `ros2`.
    pub fn mcap(file: W, compression: Compression) -> Result<Self, WriteError> {
        Ok(Self { container: Container::Mcap(Box::new(McapWriter::new(file, compression)?)) })
    }

    /// A ROS 1 bag, version 2.0, its chunks uncompressed.
    pub fn bag(file: W) -> Result<Self, WriteError> {
        Ok(Self { container: Container::Bag(BagWriter::new(file)?) })
    }

    /// Adds a topic. A name is added once.
    pub fn topic<M: Message>(&mut self, name: &str, delivery: Delivery) -> Result<Topic<M>, WriteError> {
        let id = match &mut self.container {
            Container::Bag(bag) => {
                bag.add_topic(name, &Described::known(M::DEFINITION, Encoding::Ros1, delivery))
            }
            Container::Mcap(mcap) => {
                mcap.add_topic(name, &Described::known(M::DEFINITION, Encoding::Cdr, delivery))?
            }
        };
        Ok(Topic { id, name: name.to_owned(), of: PhantomData })
    }

    /// Whether the messages of another recording's channel can be written as they are: a bag holds the encoding of ROS
    /// 1 alone, with a checksum, and a file of the profile `ros2` everything else.
    pub fn can_copy(&self, channel: &Channel) -> bool {
        let is_ros1 = channel.known_encoding() == Some(Encoding::Ros1);
        match &self.container {
            Container::Bag(_) => is_ros1 && !Described::from(channel).schema.md5.is_empty(),
            Container::Mcap(_) => !is_ros1,
        }
    }

    /// Adds a channel of another recording, one that [can be copied](Self::can_copy).
    pub fn raw_topic(&mut self, channel: &Channel) -> Result<RawTopic, WriteError> {
        let id = match &mut self.container {
            Container::Bag(bag) => bag.add_topic(&channel.topic, &channel.into()),
            Container::Mcap(mcap) => mcap.add_topic(&channel.topic, &channel.into())?,
        };
        Ok(RawTopic { id })
    }

    /// Adds a message of another recording, as it is.
    pub fn write_raw(&mut self, topic: &RawTopic, log_ns: i64, message: &[u8]) -> Result<(), WriteError> {
        match &mut self.container {
            Container::Bag(bag) => bag.write(topic.id, log_ns, message),
            Container::Mcap(mcap) => mcap.write(topic.id, log_ns, message),
        }
    }

    /// Adds a message, recorded at this time (ns since 1970). Messages should come in the order of these times.
    pub fn write<M: Message>(
        &mut self,
        topic: &Topic<M>,
        log_ns: i64,
        message: &M,
    ) -> Result<(), WriteError> {
        let bytes = message
            .to_bytes(self.encoding())
            .map_err(|error| WriteError::Message { topic: topic.name.clone(), error })?;
        match &mut self.container {
            // Readers of bags begin at 1 ns, and pass over what is earlier.
            Container::Bag(bag) => bag.write(topic.id, if log_ns == 0 { 1 } else { log_ns }, &bytes),
            Container::Mcap(mcap) => mcap.write(topic.id, log_ns, &bytes),
        }
    }

    /// Writes the index, and gives the file back.
    pub fn finish(self) -> Result<W, WriteError> {
        match self.container {
            Container::Bag(bag) => bag.finish(),
            Container::Mcap(mcap) => mcap.finish(),
        }
    }

    fn encoding(&self) -> Encoding {
        match self.container {
            Container::Bag(_) => Encoding::Ros1,
            Container::Mcap(_) => Encoding::Cdr,
        }
    }
}
