//! A server that is killed while a disagreement is settled: all of the stroke is there or nothing, and it can be asked
//! for again and undone.

use crate::support::{Out, RADAR, SEQUENCE, Serving, recording};
use ralf_corrections::{FILE, read_layer};
use rusqlite::Connection;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// The output folder of the child's server, and the recording.
const OUT: &str = "RALF_REVIEW_TEST_OUT";
const RECORDING: &str = "RALF_REVIEW_TEST_RECORDING";
const SERVES: &str = "serves ";
const SCANS: usize = 3;
/// So many moments between request and answer, and a few beyond.
const MOMENTS: u32 = 12;

/// Not a test by itself: a server of its own until it is killed.
#[test]
fn child() {
    let [Some(out), Some(recording)] = [OUT, RECORDING].map(|name| std::env::var_os(name).map(PathBuf::from))
    else {
        return;
    };
    let recording = ralf_data::open(&recording, None).unwrap();
    let server = Serving::of_recording(recording, &out, "127.0.0.1", "ada").unwrap();
    let mut told = std::io::stdout().lock();
    writeln!(told, "{SERVES}{}", server.url).and_then(|()| told.flush()).unwrap();
    drop(told);
    loop {
        std::thread::park();
    }
}

fn start(out: &Path) -> (Child, Serving) {
    let mut command = Command::new(std::env::current_exe().unwrap());
    let command = command.args(["--exact", "killed::child", "--nocapture"]).env(OUT, out);
    let command = command.env(RECORDING, recording().path);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    let mut lines = BufReader::new(child.stdout.take().unwrap()).lines().map(Result::unwrap);
    let url = lines.find_map(|line| line.split_once(SERVES).map(|(_, url)| url.to_owned())).unwrap();
    (child, Serving::elsewhere(url))
}

/// Ada calls everything an artifact and bob what the machine says; both are through.
fn disagreeing() -> Out {
    let out = Out::new();
    let [first, second] = [out.serve(), Serving::second(out.path(), "bob").unwrap()];
    for scan in 0..SCANS {
        let all: Vec<u32> = (0..first.table(scan).rows() as u32).collect();
        first.stroke(scan, 0, Some(1), &all).json();
        first.accept(scan, 1).json();
        second.accept(scan, 0).json();
    }
    out
}

/// One stroke that takes the second's side of all disagreements of one kind, and how many detections these are.
fn settling(server: &Serving, id: &str) -> (Value, usize) {
    let told = server.of_sequence("disagreements").json();
    let changes = told["changes"].as_array().unwrap();
    let label = &changes[0]["second"];
    let mut points: Vec<Vec<Value>> = vec![Vec::new(); SCANS];
    for part in changes.iter().filter(|one| &one["second"] == label).flat_map(|one| one["points"].as_array())
    {
        for part in part {
            points[part["scan"].as_u64().unwrap() as usize]
                .extend(part["points"].as_array().unwrap().clone());
        }
    }
    let count = points.iter().map(Vec::len).sum();
    let parts: Vec<Value> = (0..SCANS)
        .filter(|scan| !points[*scan].is_empty())
        .map(|scan| json!({ "radar": RADAR, "scan": scan, "points": points[scan] }))
        .collect();
    assert!(parts.len() > 1, "a stroke over several scans");
    let stroke = json!({ "id": id, "tool": "settle", "protect": false, "confirm": true, "label": label,
        "base": told["base"], "points": parts });
    (stroke, count)
}

/// Asks for a stroke, kills the server after a while, and returns what was answered until then.
fn kill_while_asked(out: &Path, id: &str, after: Duration) -> (Value, usize, Vec<u8>) {
    let (mut child, server) = start(out);
    let (stroke, count) = settling(&server, id);
    let body = stroke.to_string();
    let mut stream = TcpStream::connect(("127.0.0.1", server.port())).unwrap();
    let head = format!(
        "POST /api/sequences/{SEQUENCE}/strokes HTTP/1.1\r\nConnection: close\r\nHost: 127.0.0.1:{}\r\n\
         Authorization: Bearer {}\r\nContent-Type: application/json\r\nContent-Length: {}\r\n\r\n",
        server.port(),
        server.token(),
        body.len()
    );
    stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body.as_bytes())).unwrap();
    std::thread::sleep(after);
    // SIGKILL on Unix.
    child.kill().unwrap();
    child.wait().unwrap();
    let mut answer = Vec::new();
    // A connection that is reset is an answer that was lost.
    let _lost = stream.read_to_end(&mut answer);
    (stroke, count, answer)
}

/// How many detections are settled; the file must be whole.
fn settled(out: &Path) -> usize {
    let file = out.join(FILE);
    let layers = read_layer(&file).unwrap();
    let on = Connection::open(&file).unwrap();
    let said: String = on.query_row("PRAGMA integrity_check", [], |row| row.get(0)).unwrap();
    assert_eq!(said, "ok");
    assert!(!on.prepare("PRAGMA foreign_key_check").unwrap().exists([]).unwrap());
    layers.values().flatten().map(|layer| layer.settled.len()).sum()
}

#[test]
fn all_of_a_settled_disagreement_is_there_or_nothing() {
    let out = disagreeing();
    let whole = {
        let server = out.serve();
        let (stroke, _) = settling(&server, "measured");
        let begin = Instant::now();
        server.edit("POST", "strokes", &stroke, "one").json();
        let whole = begin.elapsed();
        server.edit("POST", "undo", &json!({}), "one").json();
        whole
    };
    let mut kept = 0;
    for moment in 0..MOMENTS {
        let id = format!("moment-{moment:04}");
        let (stroke, count, answer) = kill_while_asked(out.path(), &id, whole * moment / (MOMENTS - 3));
        let there = settled(out.path());
        assert!(there == 0 || there == count, "{there} of {count} detections");
        assert!(there == count || !answer.ends_with(b"}"), "answered, and not there");
        kept += u32::from(there == count);
        let server = out.serve();
        let depth = |server: &Serving| server.of_sequence("history").json()["undo_depth"].as_u64().unwrap();
        let before = depth(&server) - u64::from(there == count);
        // Whoever lost the answer asks again: it is made once.
        assert_eq!(server.edit("POST", "strokes", &stroke, "one").json()["changed"], count);
        assert_eq!((settled(out.path()), depth(&server)), (count, before + 1));
        assert_eq!(server.edit("POST", "undo", &json!({}), "one").json()["changed"], count);
        assert_eq!((settled(out.path()), depth(&server)), (0, before));
        assert_eq!(settling(&server, "again").1, count);
    }
    println!("{kept} of {MOMENTS} strokes were there after the kill");
}
