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
mod records;

use bag::Bag;
pub use catalogue::MessageRef;
use catalogue::{Catalogue, Channel};
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
    /// What its type is made of.
    pub schema: Schema,
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
    /// Whether messages are also for those who come later.
    pub latched: bool,
}

impl Topic {
    /// How its messages are written, if this program can read them.
    pub fn known_encoding(&self) -> Option<Encoding> {
        match self.encoding.as_str() {
            "ros1" => Some(Encoding::Ros1),
            "cdr" => Some(Encoding::Cdr),
            _ => None,
        }
    }
}

/// A recording, opened. Any thread may read any message.
#[derive(Debug)]
pub struct Container {
    files: Vec<PathBuf>,
    parts: Vec<Part>,
    topics: Vec<Topic>,
    messages: Vec<MessageRef>,
    losses: Vec<Loss>,
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
        let (parts, topics, messages) = (Vec::new(), Vec::new(), Vec::new());
        let mut container = Self { files, parts, topics, messages, losses };
        for file in 0..container.files.len() {
            container.add(file)?;
        }
        container.sort();
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

    /// In the order of the files: those that follow each other are read the fastest.
    pub fn messages(&self) -> &[MessageRef] {
        &self.messages
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
        let topic = &self.topics[message.topic()];
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

    /// Takes over a file's messages, with the topics of their channels.
    fn adopt(&mut self, file: u32, catalogue: Catalogue) {
        let topics: BTreeMap<u32, u32> =
            catalogue.channels.iter().map(|(channel, known)| (*channel, self.topic(known))).collect();
        let mut messages = catalogue.messages;
        messages.extend(catalogue.outside);
        messages.sort_by_key(|message| message.place);
        let found = messages.len();
        messages.retain_mut(|message| {
            let Some(topic) = topics.get(&message.topic) else { return false };
            (message.topic, message.file) = (*topic, file);
            self.topics[*topic as usize].count += 1;
            true
        });
        if messages.len() < found {
            let (path, lost) = (self.files[file as usize].display(), found - messages.len());
            let sentence = format!("{path}: {lost} messages are of channels that the file doesn't describe");
            self.losses.push(Loss::hiding(sentence));
        }
        self.messages.extend(messages);
    }

    /// The topic of a channel, new or known from another channel or file.
    fn topic(&mut self, channel: &Channel) -> u32 {
        let same = |topic: &Topic| {
            (&topic.name, &topic.type_name, &topic.encoding)
                == (&channel.topic, &channel.type_name, &channel.encoding)
        };
        let known = self.topics.iter().position(same).unwrap_or_else(|| {
            let Channel { topic, type_name, encoding, schema } = channel.clone();
            self.topics.push(Topic { name: topic, type_name, encoding, schema, count: 0 });
            self.topics.len() - 1
        });
        known as u32
    }

    /// Topics by name, and the messages' numbers of them accordingly.
    fn sort(&mut self) {
        let mut order: Vec<usize> = (0..self.topics.len()).collect();
        let key = |topic: &Topic| (topic.name.clone(), topic.type_name.clone(), topic.encoding.clone());
        order.sort_by_key(|topic| key(&self.topics[*topic]));
        let mut rank = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, topic)| rank[*topic] = place as u32);
        self.messages.iter_mut().for_each(|message| message.topic = rank[message.topic as usize]);
        self.topics = order.iter().map(|topic| self.topics[*topic].clone()).collect();
    }
}
