//! ROS 2's SQLite recordings: the tables `topics` and `messages`.

use super::Schema;
use super::catalogue::{Catalogue, Channel, MessageRef};
use super::database::{self, refused};
use super::error::ContainerError;
use super::loss::Loss;
use super::quality::{OFFERED, is_latched};
use rusqlite::{Connection, Row};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// What an SQLite file begins with.
pub(super) const MAGIC: &[u8] = b"SQLite format 3\0";

/// What the table of definitions tells.
const DEFINITION: [&str; 3] = ["topic_type", "encoding", "encoded_message_definition"];

#[derive(Debug)]
pub(super) struct Db3File {
    path: PathBuf,
    connection: Mutex<Connection>,
}

impl Db3File {
    /// Reads what the file holds, and says what is lost. In the messages the topic is still the number of the channel.
    pub(super) fn open(path: &Path, losses: &mut Vec<Loss>) -> Result<(Self, Catalogue), ContainerError> {
        let connection = database::open(path)?;
        let channels = channels(&connection).map_err(refused(path, "table `topics`"))?;
        let mut catalogue = Catalogue { channels, ..Catalogue::default() };
        let messages = &mut catalogue.messages;
        let rows = "SELECT id, topic_id, timestamp FROM messages ORDER BY id";
        let read = for_each_row(&connection, rows, |row| {
            let place = row.get::<_, i64>(0)?.cast_unsigned();
            messages.push(MessageRef { log_ns: row.get(2)?, place, channel: row.get(1)?, file: 0 });
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

/// The topics, with what newer recorders tell of them: for whom messages are, and what types are made of.
fn channels(connection: &Connection) -> rusqlite::Result<BTreeMap<u32, Channel>> {
    // Labels can do without: what is wrong with them costs no recording.
    let definitions = definitions(connection).unwrap_or_default();
    let told = has_columns(connection, "topics", &[OFFERED])?;
    let offered = if told { OFFERED } else { "''" };
    let mut channels = BTreeMap::new();
    let topics = format!("SELECT id, name, type, serialization_format, {offered} FROM topics");
    for_each_row(connection, &topics, |row| {
        let (topic, type_name, encoding): (String, String, String) = (row.get(1)?, row.get(2)?, row.get(3)?);
        let offered: Option<String> = row.get(4).unwrap_or_default();
        let latched = is_latched(&topic, &offered.unwrap_or_default());
        let schema = definitions.get(&type_name).cloned().unwrap_or_default();
        channels.insert(
            row.get(0)?,
            Channel { topic, type_name, encoding, schema, latched, publisher: String::new() },
        );
        Ok(())
    })?;
    Ok(channels)
}

/// What types are made of, by their names; nothing of older recorders.
fn definitions(connection: &Connection) -> rusqlite::Result<BTreeMap<String, Schema>> {
    let mut definitions = BTreeMap::new();
    if !has_columns(connection, "message_definitions", &DEFINITION)? {
        return Ok(definitions);
    }
    let rows = format!("SELECT {} FROM message_definitions", DEFINITION.join(", "));
    for_each_row(connection, &rows, |row| {
        let (encoding, text): (String, String) = (row.get(1)?, row.get(2)?);
        let text = text.into_bytes();
        definitions.insert(row.get(0)?, Schema { encoding, text, ..Schema::default() });
        Ok(())
    })?;
    Ok(definitions)
}

fn has_columns(connection: &Connection, table: &str, columns: &[&str]) -> rusqlite::Result<bool> {
    let mut known: Vec<String> = Vec::new();
    for_each_row(connection, &format!("SELECT name FROM pragma_table_info('{table}')"), |row| {
        known.push(row.get(0)?);
        Ok(())
    })?;
    Ok(columns.iter().all(|column| known.iter().any(|name| name == column)))
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
