//! ROS 2's SQLite recordings: the tables `topics` and `messages`.

use super::Schema;
use super::catalogue::{Catalogue, Channel, MessageRef};
use super::database::{self, refused};
use super::error::ContainerError;
use super::loss::Loss;
use rusqlite::{Connection, Row};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// What an SQLite file begins with.
pub(super) const MAGIC: &[u8] = b"SQLite format 3\0";

#[derive(Debug)]
pub(super) struct Db3File {
    path: PathBuf,
    connection: Mutex<Connection>,
}

impl Db3File {
    /// Reads what the file holds, and says what is lost. In the messages the topic is still the number of the channel.
    pub(super) fn open(path: &Path, losses: &mut Vec<Loss>) -> Result<(Self, Catalogue), ContainerError> {
        let connection = database::open(path)?;
        let mut catalogue = Catalogue::default();
        let topics = "SELECT id, name, type, serialization_format FROM topics";
        for_each_row(&connection, topics, |row| {
            let (topic, type_name, encoding) = (row.get(1)?, row.get(2)?, row.get(3)?);
            let channel = Channel { topic, type_name, encoding, schema: Schema::default() };
            catalogue.channels.insert(row.get(0)?, channel);
            Ok(())
        })
        .map_err(refused(path, "table `topics`"))?;
        let messages = &mut catalogue.messages;
        let rows = "SELECT id, topic_id, timestamp FROM messages ORDER BY id";
        let read = for_each_row(&connection, rows, |row| {
            let place = row.get::<_, i64>(0)?.cast_unsigned();
            messages.push(MessageRef { log_ns: row.get(2)?, place, topic: row.get(1)?, file: 0 });
            Ok(())
        });
        match read {
            Err(error) if messages.is_empty() => return Err(refused(path, "table `messages`")(error)),
            Err(error) => losses.push(Loss::hiding(format!(
                "{}: damaged, read up to there: table `messages`: {error} after {} messages",
                path.display(),
                messages.len()
            ))),
            Ok(()) => {}
        }
        Ok((Self { path: path.to_owned(), connection: Mutex::new(connection) }, catalogue))
    }

    /// The bytes of a message.
    pub(super) fn read(&self, message: &MessageRef) -> Result<Vec<u8>, ContainerError> {
        let id = message.place.cast_signed();
        let place = format!("message {id}");
        // A panic elsewhere while it was held leaves a connection that only ever reads.
        let connection = self.connection.lock().unwrap_or_else(PoisonError::into_inner);
        let bytes: Vec<u8> = connection
            .prepare("SELECT data FROM messages WHERE id = ?1")
            .and_then(|mut statement| statement.query_row([id], |row| row.get(0)))
            .map_err(refused(&self.path, &place))?;
        drop(connection);
        Ok(bytes)
    }
}

fn for_each_row(
    connection: &Connection,
    query: &str,
    mut row: impl FnMut(&Row<'_>) -> rusqlite::Result<()>,
) -> rusqlite::Result<()> {
    let mut statement = connection.prepare(query)?;
    let mut rows = statement.query([])?;
    while let Some(next) = rows.next()? {
        row(next)?;
    }
    Ok(())
}
