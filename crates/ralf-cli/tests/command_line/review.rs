//! `ralf review`: from the first line that it prints to its end, however that comes.

use crate::support::{Dataset, program, ralf};
use ralf_corrections::{FILE, read_layer};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

/// A server of its own.
struct Review {
    child: Child,
    address: String,
    token: String,
}

impl Review {
    fn start(dataset: &Dataset, more: &[&str]) -> Self {
        let mut command = program();
        let state = Path::new(&dataset.out).with_extension("state");
        let command = command.args(["review", &dataset.path, &dataset.out, "--port", "0", "--author", "ada"]);
        let command = command.args(more).env("XDG_STATE_HOME", state);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut url = String::new();
        BufReader::new(child.stdout.take().unwrap()).read_line(&mut url).unwrap();
        let (address, token) = url.trim().strip_prefix("http://").unwrap().split_once("/?token=").unwrap();
        Self { address: address.to_owned(), token: token.to_owned(), child }
    }

    fn ask(&self, method: &str, path: &str, body: &str) -> String {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        let (address, token, length) = (&self.address, &self.token, body.len());
        let request = format!(
            "{method} /api/{path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\nAuthorization: Bearer {token}\r\n\
             Content-Type: application/json\r\nContent-Length: {length}\r\n\r\n{body}"
        );
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    }

    /// Corrects one detection of a scan of the first radar; it is on disk when this returns.
    fn correct(&self, scan: u32) {
        let body = format!(
            r#"{{"tool": "click", "label": 10, "base": [{{"radar": "radar_front", "scan": {scan}, "revision": 0}}],
                "points": [{{"radar": "radar_front", "scan": {scan}, "points": [1]}}]}}"#
        );
        let answer = self.ask("POST", "sequences/00/strokes", &body);
        assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    }

    /// Ends it; whether it ended well.
    fn end(mut self, signal: &str) -> bool {
        let sent = Command::new("kill").args([signal, &self.child.id().to_string()]).status().unwrap();
        assert!(sent.success());
        self.child.wait().unwrap().success()
    }
}

fn labelled() -> Dataset {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

#[test]
fn the_address_is_printed_served_and_ended_by_an_interrupt() {
    let review = Review::start(&labelled(), &[]);
    let answer = review.ask("GET", "recording", "");
    assert!(answer.starts_with("HTTP/1.1 200") && answer.contains("\"author\":\"ada\""), "{answer}");
    assert!(review.end("-INT"));
}

#[test]
fn however_it_ends_the_file_alone_holds_every_edit() {
    for signal in ["-TERM", "-INT"] {
        let dataset = labelled();
        let review = Review::start(&dataset, &[]);
        (0..3).for_each(|scan| review.correct(scan));
        assert!(review.end(signal), "{signal}");
        let file = Path::new(&dataset.out).join(FILE);
        let copy = file.with_extension("copy");
        fs::copy(&file, &copy).unwrap();
        assert_eq!(read_layer(&copy).unwrap().len(), 3, "{signal}");
    }
}

#[test]
fn killed_without_warning_it_loses_nothing_and_keeps_its_token() {
    let dataset = labelled();
    let review = Review::start(&dataset, &[]);
    (0..3).for_each(|scan| review.correct(scan));
    let token = review.token.clone();
    assert!(!review.end("-KILL"));
    assert_eq!(read_layer(&Path::new(&dataset.out).join(FILE)).unwrap().len(), 3);
    let again = Review::start(&dataset, &[]);
    assert_eq!(again.token, token, "a page that is open stays open");
    again.correct(3);
    assert!(again.end("-TERM"));
}

#[test]
fn a_deleted_store_is_told_and_nothing_is_called_saved() {
    let dataset = labelled();
    let review = Review::start(&dataset, &[]);
    review.correct(0);
    for suffix in ["", "-wal", "-shm"] {
        fs::remove_file(format!("{}{suffix}", Path::new(&dataset.out).join(FILE).display())).unwrap();
    }
    let body = r#"{"tool": "click", "label": 10, "base": [{"radar": "radar_front", "scan": 1, "revision": 0}],
        "points": [{"radar": "radar_front", "scan": 1, "points": [1]}]}"#;
    let answer = review.ask("POST", "sequences/00/strokes", body);
    assert!(answer.starts_with("HTTP/1.1 500") && answer.contains("it was deleted"), "{answer}");
    review.end("-TERM");
    assert!(!Path::new(&dataset.out).join(FILE).exists(), "nothing is made in its place");
}

#[test]
fn addresses_of_all_interfaces_can_be_opened() {
    let review = Review::start(&labelled(), &["--host", "0.0.0.0"]);
    assert!(review.address.starts_with("127.0.0.1:"), "{}", review.address);
    assert!(review.ask("GET", "recording", "").starts_with("HTTP/1.1 200"));
    assert!(review.end("-INT"));
}

#[test]
fn what_can_not_be_reviewed_is_told() {
    let dataset = Dataset::new();
    ralf(["review", &dataset.path, &dataset.out])
        .exits(1)
        .says(["expected the record of a finished `ralf label`"]);
    ralf(["review", &dataset.path]).exits(2).says(["<OUT>"]);
}
