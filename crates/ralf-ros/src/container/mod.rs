//! Finding and reading the messages of a recording: ROS 1 bags, MCAP files, SQLite files of ROS 2, and folders of the
//! latter two.
//!
//! Opening walks over a file without reading its chunks, and keeps 24 bytes of each message. A chunk is decompressed
//! when a message of it is asked for, and some are kept. What is cut short or damaged is read up to there, and the
//! [loss](Container::losses) is said.

pub(crate) mod bag_format;

mod bag;
mod catalogue;
mod chunked;
mod chunks;
mod database;
mod db3;
mod decompress;
mod error;
mod folder;
mod loss;
mod mcap_file;
mod quality;
mod records;

use bag::Bag;
use catalogue::Catalogue;
pub use catalogue::{Channel, MessageRef};
use chunked::{ChunkedFile, Format};
use db3::Db3File;
pub use error::ContainerError;
pub use loss::Loss;
use mcap_file::Mcap;
use ralf_files::Kind;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::encoding::Encoding;

/// A topic of a recording: all messages of one type under one name.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Topic {
    /// Such as `/radar_front/points`.
    pub name: String,
    /// As the file spells it: `sensor_msgs/PointCloud2` or `sensor_msgs/msg/PointCloud2`.
    pub type_name: String,
    /// `ros1`, `cdr`, or what this program can't read.
    pub encoding: String,
    /// How many messages it has.
    pub count: usize,
}

/// What a message type is made of, as a recording has it written down.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Schema {
    /// `ros1msg`, `ros2msg` or another language.
    pub encoding: String,
    /// In that language; empty where the recording doesn't tell.
    pub text: Vec<u8>,
    /// The checksum by which ROS 1 tells versions of a type apart; empty elsewhere.
    pub md5: String,
}

impl Topic {
    /// How its messages are written, if this program can read them.
    pub fn known_encoding(&self) -> Option<Encoding> {
        Encoding::named(&self.encoding)
    }
}

/// A recording, opened. Any thread may read any message.
#[derive(Debug)]
pub struct Container {
    files: Vec<PathBuf>,
    parts: Vec<Part>,
    topics: Vec<Topic>,
    channels: Vec<Channel>,
    /// The place of each channel's topic.
    topic_of: Vec<u32>,
    messages: Vec<MessageRef>,
    losses: Vec<Loss>,
    attached: usize,
}

#[derive(Debug)]
enum Part {
    Chunked(ChunkedFile),
    Db3(Db3File),
}

const FORMATS: [&dyn Format; 2] = [&Bag, &Mcap];

/// Whether this is a file, or a folder with a `metadata.yaml`, that can be opened.
pub fn recognises(path: &Path) -> bool {
    if path.is_dir() {
        return path.join(folder::METADATA).is_file();
    }
    beginning(path).is_ok_and(|bytes| {
        bytes.starts_with(db3::MAGIC) || FORMATS.iter().any(|format| format.begins(&bytes))
    })
}

fn beginning(path: &Path) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    ralf_files::open(path, Kind::Stream)?.take(db3::MAGIC.len() as u64).read_to_end(&mut bytes)?;
    Ok(bytes)
}

impl Container {
    /// Opens a file, or a folder with a `metadata.yaml`.
    pub fn open(path: &Path) -> Result<Self, ContainerError> {
        let mut losses = Vec::new();
        let files = if path.is_dir() { folder::files(path, &mut losses)? } else { vec![path.to_owned()] };
        let (parts, topics, channels) = (Vec::new(), Vec::new(), Vec::new());
        let (topic_of, messages) = (Vec::new(), Vec::new());
        let mut container = Self { files, parts, topics, channels, topic_of, messages, losses, attached: 0 };
        for file in 0..container.files.len() {
            container.add(file)?;
        }
        container.sort();
        container.losses = Loss::once(std::mem::take(&mut container.losses));
        Ok(container)
    }

    /// Every file, in the order of reading.
    pub fn files(&self) -> &[PathBuf] {
        &self.files
    }

    /// In the order of their names.
    pub fn topics(&self) -> &[Topic] {
        &self.topics
    }

    /// In the order of their topics' names: what a copy is made of.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The place of a message's topic in the list of topics.
    pub fn topic_of(&self, message: &MessageRef) -> usize {
        self.topic_of[message.channel()] as usize
    }

    /// In the order of the files: those that follow each other are read the fastest.
    pub fn messages(&self) -> &[MessageRef] {
        &self.messages
    }

    /// How many files and records of metadata an MCAP file holds beside its messages.
    pub fn attached(&self) -> usize {
        self.attached
    }

    /// What could not be read.
    pub fn losses(&self) -> &[Loss] {
        &self.losses
    }

    /// The bytes of a message, in its topic's encoding.
    pub fn read(&self, message: &MessageRef) -> Result<Vec<u8>, ContainerError> {
        let stored = match &self.parts[message.file as usize] {
            Part::Chunked(file) => file.read(message),
            Part::Db3(file) => file.read(message),
        }?;
        let topic = &self.topics[self.topic_of(message)];
        if topic.known_encoding() != Some(Encoding::Cdr) {
            return Ok(stored);
        }
        decompress::message(stored).map_err(|(expected, found)| {
            let place = format!("message of {} at {} ns", topic.name, message.log_ns);
            ContainerError::content(&self.files[message.file as usize], place, expected, found)
        })
    }

    fn add(&mut self, file: usize) -> Result<(), ContainerError> {
        let path = self.files[file].clone();
        let bytes = beginning(&path).map_err(ContainerError::io(&path))?;
        let (part, catalogue) = if bytes.starts_with(db3::MAGIC) {
            let (part, catalogue) = Db3File::open(&path, &mut self.losses)?;
            (Part::Db3(part), catalogue)
        } else {
            let format = *FORMATS.iter().find(|format| format.begins(&bytes)).ok_or_else(|| {
                let expected = "a ROS 1 bag 2.0, an MCAP file or an SQLite file";
                ContainerError::content(&path, "byte 0", expected, "other bytes")
            })?;
            let (part, catalogue) = ChunkedFile::open(&path, format, &mut self.losses)?;
            (Part::Chunked(part), catalogue)
        };
        self.parts.push(part);
        self.adopt(file as u32, catalogue);
        Ok(())
    }

    /// Takes over a file's messages, with their channels.
    fn adopt(&mut self, file: u32, catalogue: Catalogue) {
        self.attached += catalogue.attached;
        let channels: BTreeMap<u32, u32> =
            catalogue.channels.into_iter().map(|(number, known)| (number, self.channel(known))).collect();
        let mut messages = catalogue.messages;
        messages.extend(catalogue.outside);
        messages.sort_by_key(|message| message.place);
        let found = messages.len();
        messages.retain_mut(|message| {
            let Some(channel) = channels.get(&message.channel) else { return false };
            (message.channel, message.file) = (*channel, file);
            self.topics[self.topic_of[*channel as usize] as usize].count += 1;
            true
        });
        if messages.len() < found {
            let (path, lost) = (self.files[file as usize].display(), found - messages.len());
            let sentence = format!("{path}: {lost} messages are of channels that the file doesn't describe");
            self.losses.push(Loss::hiding(sentence));
        }
        self.messages.extend(messages);
    }

    /// The place of a channel, new or known from another publisher or file.
    fn channel(&mut self, channel: Channel) -> u32 {
        if let Some(known) = self.channels.iter().position(|known| *known == channel) {
            return known as u32;
        }
        let topic = self.topics.iter().position(|topic| channel.is_of(topic)).unwrap_or_else(|| {
            let Channel { topic, type_name, encoding, .. } = channel.clone();
            self.topics.push(Topic { name: topic, type_name, encoding, count: 0 });
            self.topics.len() - 1
        });
        self.topic_of.push(topic as u32);
        self.channels.push(channel);
        self.channels.len() as u32 - 1
    }

    /// Topics and their channels by name, and the channels' numbers in messages accordingly.
    fn sort(&mut self) {
        self.topics
            .sort_by_key(|topic| (topic.name.clone(), topic.type_name.clone(), topic.encoding.clone()));
        let topic_of = |channel: &Channel| self.topics.iter().position(|topic| channel.is_of(topic));
        let mut order: Vec<(usize, usize)> =
            self.channels.iter().map(|channel| topic_of(channel).unwrap_or_default()).zip(0..).collect();
        order.sort_unstable();
        let mut rank = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, (_, channel))| rank[*channel] = place as u32);
        self.messages.iter_mut().for_each(|message| message.channel = rank[message.channel()]);
        self.topic_of = order.iter().map(|(topic, _)| *topic as u32).collect();
        self.channels = order.iter().map(|(_, channel)| self.channels[*channel].clone()).collect();
    }
}
