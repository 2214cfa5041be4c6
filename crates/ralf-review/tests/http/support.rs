//! A recording with labels, a server on it, and a client.

use ralf_data::run::{LabelRun, Unwatched};
use ralf_data::{Recording, Settings, open, write_sequence};
use ralf_review::{Options, ReviewError, Server};
use ralf_sim::presets;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::io::{Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::thread::JoinHandle;
use tokio::sync::oneshot;

/// The sequence, its front radar, its LiDAR and one of its cameras.
pub(crate) const SEQUENCE: &str = "tiny";
pub(crate) const RADAR: &str = "radar_front";
pub(crate) const LIDAR: &str = "lidar_top";
pub(crate) const CAMERA: &str = "camera_front";

/// A recording of three scans per radar and its labels, made once.
struct Made {
    folder: tempfile::TempDir,
}

static MADE: LazyLock<Made> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let sequence = presets::find("tiny").unwrap().sequences[0].simulate(3, 3).unwrap();
    write_sequence(&sequence, &folder.path().join("recording"), &|_| ()).unwrap();
    let made = Made { folder };
    label(&made.recording(), &made.folder.path().join("out"), &Settings::default());
    made
});

impl Made {
    fn recording(&self) -> Recording {
        open(&self.folder.path().join("recording"), None).unwrap()
    }
}

/// The recording.
pub(crate) fn recording() -> Recording {
    MADE.recording()
}

/// Labels a recording.
pub(crate) fn label(recording: &Recording, out: &Path, settings: &Settings) {
    LabelRun { recording, settings, out, jobs: 1, evidence: false, checks: &[], model: None }
        .execute(&Unwatched)
        .unwrap();
}

/// Labels of one's own, as `ralf label` left them.
pub(crate) struct Out {
    folder: tempfile::TempDir,
}

impl Out {
    pub(crate) fn new() -> Self {
        Self::copy_of(&MADE.folder.path().join("out"))
    }

    /// All that lies in such a folder, in another one.
    pub(crate) fn copy_of(out: &Path) -> Self {
        let folder = tempfile::tempdir().unwrap();
        copy(out, folder.path());
        Self { folder }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn parquet(&self) -> PathBuf {
        self.path().join("sequences").join(SEQUENCE).join("plausibility.parquet")
    }

    /// A server on these labels.
    pub(crate) fn serve(&self) -> Serving {
        Serving::of(self.path(), "127.0.0.1", "ada").unwrap()
    }

    /// The same for somebody else.
    pub(crate) fn serve_for(&self, author: &str) -> Serving {
        Serving::of(self.path(), "127.0.0.1", author).unwrap()
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let (from, to) = (entry.as_ref().unwrap().path(), to.join(entry.unwrap().file_name()));
        if from.is_dir() { copy(&from, &to) } else { fs::copy(from, to).map(drop).unwrap() }
    }
}

/// A server that serves until it is dropped.
pub(crate) struct Serving {
    pub(crate) url: String,
    end: Option<oneshot::Sender<()>>,
    thread: Option<JoinHandle<Result<(), ReviewError>>>,
}

impl Serving {
    pub(crate) fn of(out: &Path, host: &str, author: &str) -> Result<Self, ReviewError> {
        Self::of_recording(recording(), out, host, author)
    }

    /// A server for somebody who labels a second time.
    pub(crate) fn second(out: &Path, name: &str) -> Result<Self, ReviewError> {
        let (host, second) = ("127.0.0.1".to_owned(), Some(name.to_owned()));
        Self::with(recording(), out, &Options { host, port: Some(0), second, ..Options::default() })
    }

    /// The same of another recording.
    pub(crate) fn of_recording(
        recording: Recording,
        out: &Path,
        host: &str,
        author: &str,
    ) -> Result<Self, ReviewError> {
        let options =
            Options { host: host.into(), port: Some(0), author: author.into(), ..Options::default() };
        Self::with(recording, out, &options)
    }

    /// A client of a server that is another process's.
    pub(crate) fn elsewhere(url: String) -> Self {
        Self { url, end: None, thread: None }
    }

    fn with(recording: Recording, out: &Path, options: &Options) -> Result<Self, ReviewError> {
        let server = Server::bind(recording, out, options)?;
        let url = server.urls()[0].clone();
        let (end, ended) = oneshot::channel::<()>();
        let until = async { drop(ended.await) };
        let thread = std::thread::spawn(move || server.run_until(until));
        Ok(Self { url, end: Some(end), thread: Some(thread) })
    }

    /// Ends it, as Ctrl-C does.
    pub(crate) fn end(mut self) {
        self.stop();
    }

    fn stop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            thread.join().unwrap().unwrap();
        }
    }

    pub(crate) fn port(&self) -> u16 {
        let address = self.url.trim_start_matches("http://").split('/').next().unwrap();
        address.rsplit_once(':').unwrap().1.parse().unwrap()
    }

    pub(crate) fn token(&self) -> &str {
        self.url.split_once("/?token=").unwrap().1
    }

    /// A request of any kind, with the token; `head` are further header lines.
    pub(crate) fn ask(&self, method: &str, path: &str, head: &[(&str, &str)], body: &[u8]) -> Reply {
        let mut lines = format!("{method} {path} HTTP/1.1\r\nConnection: close\r\n");
        let host = format!("127.0.0.1:{}", self.port());
        let is_given = |name: &str| head.iter().any(|(given, _)| given.eq_ignore_ascii_case(name));
        if !is_given("host") {
            lines += &format!("Host: {host}\r\n");
        }
        if !is_given("authorization") {
            lines += &format!("Authorization: Bearer {}\r\n", self.token());
        }
        if !is_given("content-length") && !body.is_empty() {
            lines += &format!("Content-Length: {}\r\n", body.len());
        }
        head.iter().for_each(|(name, value)| lines += &format!("{name}: {value}\r\n"));
        let mut stream = TcpStream::connect(("127.0.0.1", self.port())).unwrap();
        stream.write_all(format!("{lines}\r\n").as_bytes()).unwrap();
        stream.write_all(body).unwrap();
        let mut bytes = Vec::new();
        stream.read_to_end(&mut bytes).unwrap();
        Reply::parse(&bytes)
    }

    pub(crate) fn get(&self, path: &str) -> Reply {
        self.ask("GET", path, &[], &[])
    }

    /// What is asked for below the sequence.
    pub(crate) fn of_sequence(&self, path: &str) -> Reply {
        self.get(&format!("/api/sequences/{SEQUENCE}/{path}"))
    }

    /// An edit of the sequence, in the window `tab`.
    pub(crate) fn edit(&self, method: &str, path: &str, body: &Value, tab: &str) -> Reply {
        let head = [("Content-Type", "application/json"), ("X-Ralf-Tab", tab)];
        let path = format!("/api/sequences/{SEQUENCE}/{path}");
        self.ask(method, &path, &head, body.to_string().as_bytes())
    }

    /// An edit by a person who has a mark of its own.
    pub(crate) fn edit_by(&self, path: &str, body: &Value, author: &str) -> Reply {
        let head = [("Content-Type", "application/json"), ("X-Ralf-Author", author)];
        self.ask("POST", &format!("/api/sequences/{SEQUENCE}/{path}"), &head, body.to_string().as_bytes())
    }

    /// Marks a scan of the front radar as reviewed, by the labels that are there now.
    pub(crate) fn accept(&self, scan: usize, revision: u64) -> Reply {
        let stamp = self.table(scan).header["stamp"].clone();
        let body = json!({ "reviewed": true, "revision": revision, "stamp": stamp });
        self.edit("PUT", &format!("radars/{RADAR}/scans/{scan}/reviewed"), &body, "one")
    }

    /// A stroke on a scan of the front radar.
    pub(crate) fn stroke(&self, scan: usize, revision: u64, label: Option<u16>, points: &[u32]) -> Reply {
        self.edit("POST", "strokes", &stroke(scan, revision, label, points), "one")
    }

    pub(crate) fn table(&self, scan: usize) -> Table {
        self.of_sequence(&format!("radars/{RADAR}/scans/{scan}")).table()
    }
}

impl Drop for Serving {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            self.stop();
        }
    }
}

/// A stroke as the page sends it.
pub(crate) fn stroke(scan: usize, revision: u64, label: Option<u16>, points: &[u32]) -> Value {
    json!({
        "tool": "lasso",
        "protect": false,
        "label": label,
        "base": [{ "radar": RADAR, "scan": scan, "revision": revision }],
        "points": [{ "radar": RADAR, "scan": scan, "points": points }],
    })
}

/// An answer.
#[derive(Debug)]
pub(crate) struct Reply {
    pub(crate) status: u16,
    pub(crate) headers: BTreeMap<String, String>,
    pub(crate) body: Vec<u8>,
}

impl Reply {
    fn parse(bytes: &[u8]) -> Self {
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n").unwrap();
        let head = String::from_utf8(bytes[..end].to_vec()).unwrap();
        let mut lines = head.lines();
        let status = lines.next().unwrap().split(' ').nth(1).unwrap().parse().unwrap();
        let pairs = lines.map(|line| line.split_once(": ").unwrap());
        let headers = pairs.map(|(name, value)| (name.to_lowercase(), value.to_owned())).collect();
        Self { status, headers, body: bytes[end + 4..].to_vec() }
    }

    /// What a request that went well was answered.
    pub(crate) fn json(&self) -> Value {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        serde_json::from_slice(&self.body).unwrap()
    }

    /// The sentence of a refusal with this status.
    pub(crate) fn refused(&self, status: u16) -> String {
        assert_eq!(self.status, status, "{}", String::from_utf8_lossy(&self.body));
        let body: Value = serde_json::from_slice(&self.body).unwrap();
        body["error"].as_str().unwrap().to_owned()
    }

    pub(crate) fn table(&self) -> Table {
        assert_eq!(self.status, 200, "{}", String::from_utf8_lossy(&self.body));
        assert_eq!(self.headers["content-type"], "application/octet-stream");
        let length = u32::from_le_bytes(self.body[..4].try_into().unwrap()) as usize;
        let header = serde_json::from_slice(&self.body[4..4 + length]).unwrap();
        Table { header, bytes: self.body[4 + length..].to_vec() }
    }
}

/// A table, read as the interface's document says.
pub(crate) struct Table {
    pub(crate) header: Value,
    bytes: Vec<u8>,
}

impl Table {
    pub(crate) fn rows(&self) -> usize {
        self.header["rows"].as_u64().unwrap() as usize
    }

    pub(crate) fn names(&self) -> Vec<&str> {
        self.header["columns"]
            .as_array()
            .unwrap()
            .iter()
            .map(|column| column["name"].as_str().unwrap())
            .collect()
    }

    fn column<const N: usize>(&self, name: &str, kind: &str) -> Vec<[u8; N]> {
        let columns = self.header["columns"].as_array().unwrap();
        let column =
            columns.iter().find(|column| column["name"] == name).unwrap_or_else(|| panic!("no {name}"));
        assert_eq!(column["type"], kind, "{name}");
        let offset = column["offset"].as_u64().unwrap() as usize;
        self.bytes[offset..offset + N * self.rows()].as_chunks().0.to_vec()
    }

    pub(crate) fn f32(&self, name: &str) -> Vec<f32> {
        self.column(name, "f32").into_iter().map(f32::from_le_bytes).collect()
    }

    pub(crate) fn u32(&self, name: &str) -> Vec<u32> {
        self.column(name, "u32").into_iter().map(u32::from_le_bytes).collect()
    }

    pub(crate) fn u16(&self, name: &str) -> Vec<u16> {
        self.column(name, "u16").into_iter().map(u16::from_le_bytes).collect()
    }

    pub(crate) fn u8(&self, name: &str) -> Vec<u8> {
        self.column::<1>(name, "u8").into_iter().map(|[value]| value).collect()
    }
}
