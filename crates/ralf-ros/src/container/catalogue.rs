//! What a file holds, as far as it was read: channels, messages, chunks.

use super::chunks::ChunkPlace;
use super::{Schema, Topic};
use crate::encoding::Encoding;
use std::collections::{BTreeMap, BTreeSet};

/// Where a message lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MessageRef {
    /// When it was recorded, ns; not when it was measured.
    pub log_ns: i64,
    /// A number that its file gives it.
    pub(super) place: u64,
    /// Its place in the list of channels.
    pub(super) channel: u32,
    /// Its place in the list of files.
    pub(super) file: u32,
}

impl MessageRef {
    /// Its channel's place in the list of channels.
    pub fn channel(&self) -> usize {
        self.channel as usize
    }
}

/// What a recorder knows of messages of a topic that have one definition and reach the same listeners. A topic has
/// several where its type changed, or where several publishers have messages for those who come later.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Channel {
    /// The topic's name.
    pub topic: String,
    /// As the file spells it.
    pub type_name: String,
    /// `ros1`, `cdr`, or what this program can't read.
    pub encoding: String,
    /// What its type is made of.
    pub schema: Schema,
    /// Whether messages are also for those who come later.
    pub latched: bool,
    /// The node of ROS 1 whose messages these are, where they are also for those who come later: who comes later gets
    /// the last message of each. Empty elsewhere.
    pub publisher: String,
}

impl Channel {
    /// How its messages are written, if this program can read them.
    pub fn known_encoding(&self) -> Option<Encoding> {
        Encoding::named(&self.encoding)
    }

    /// Whether both are of one topic.
    pub(super) fn is_of(&self, topic: &Topic) -> bool {
        (&self.topic, &self.type_name, &self.encoding) == (&topic.name, &topic.type_name, &topic.encoding)
    }
}

#[derive(Debug, Default)]
pub(super) struct Catalogue {
    pub(super) channels: BTreeMap<u32, Channel>,
    /// Names of types, by the numbers that channels of MCAP have for them.
    pub(super) schemas: BTreeMap<u16, (String, Schema)>,
    /// In these the channel is still the file's own number for it.
    pub(super) messages: Vec<MessageRef>,
    /// The same of those that lie in no chunk.
    pub(super) outside: Vec<MessageRef>,
    pub(super) chunks: Vec<ChunkPlace>,
    /// Files and records of metadata beside the messages.
    pub(super) attached: usize,
    /// How many messages there were when each chunk began: what tells those without an index.
    pub(super) messages_before: Vec<usize>,
}

/// Set in the place of a message that lies in no chunk: the rest is its position in the file.
const OUTSIDE: u64 = 1 << 63;

/// Where a message lies in its file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// In a chunk, so many bytes from its beginning.
    Chunk(u32, u32),
    /// Outside of all chunks, so many bytes from the beginning of the file.
    File(u64),
}

impl Place {
    fn packed(self) -> u64 {
        match self {
            Self::Chunk(chunk, offset) => (u64::from(chunk) << 32) | u64::from(offset),
            Self::File(position) => OUTSIDE | position,
        }
    }

    pub(super) fn from_message(message: &MessageRef) -> Self {
        if message.place & OUTSIDE != 0 {
            return Self::File(message.place & !OUTSIDE);
        }
        // The lower half is the offset.
        Self::Chunk((message.place >> 32) as u32, message.place as u32)
    }
}

impl Catalogue {
    pub(super) fn add_chunk(&mut self, place: ChunkPlace) {
        self.messages_before.push(self.messages.len());
        self.chunks.push(place);
    }

    pub(super) fn add_message(&mut self, channel: u32, log_ns: i64, place: Place) {
        let messages = if matches!(place, Place::File(_)) { &mut self.outside } else { &mut self.messages };
        messages.push(MessageRef { log_ns, place: place.packed(), channel, file: 0 });
    }

    /// The number of the chunk that was added last, to which an index belongs.
    pub(super) fn last_chunk(&self) -> Option<u32> {
        self.chunks.len().checked_sub(1).map(|last| last as u32)
    }

    /// Forgets the index of the last chunk: it may be cut, and the chunk itself has to be asked.
    pub(super) fn forget_last_index(&mut self) {
        if let Some(before) = self.messages_before.last() {
            self.messages.truncate(*before);
        }
    }

    /// Chunks of which no index said what they hold.
    pub(super) fn without_index(&self) -> Vec<usize> {
        let ends = self.messages_before.iter().skip(1).copied().chain([self.messages.len()]);
        let spans = self.messages_before.iter().zip(ends).enumerate();
        spans.filter(|(_, (before, after))| *before == after).map(|(chunk, _)| chunk).collect()
    }

    /// The channels of all messages.
    pub(super) fn channels_in_use(&self) -> BTreeSet<u32> {
        self.messages.iter().chain(&self.outside).map(|message| message.channel).collect()
    }
}
