//! The end of the server.

use crate::support::{Out, SEQUENCE};
use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

#[test]
fn requests_that_wait_are_answered_when_the_server_ends() {
    let out = Out::new();
    let server = out.serve();
    let port = server.port();
    let path = format!("/api/sequences/{SEQUENCE}/changes?since=0");
    let token = server.token();
    let request = format!(
        "GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nAuthorization: Bearer {token}\r\nConnection: close\r\n\r\n"
    );
    let mut stream = TcpStream::connect(("127.0.0.1", port)).unwrap();
    stream.write_all(request.as_bytes()).unwrap();
    std::thread::sleep(Duration::from_millis(200));
    let begin = Instant::now();
    server.end();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(
        answer.starts_with("HTTP/1.1 200") && answer.ends_with("{\"counter\":0,\"scans\":[]}"),
        "{answer}"
    );
    assert!(begin.elapsed() < Duration::from_secs(3), "{:?}", begin.elapsed());
}

#[test]
fn a_connection_that_says_nothing_does_not_keep_it() {
    let out = Out::new();
    let server = out.serve();
    let _silent = TcpStream::connect(("127.0.0.1", server.port())).unwrap();
    let begin = Instant::now();
    server.end();
    assert!(begin.elapsed() < Duration::from_secs(8), "{:?}", begin.elapsed());
}

/// So many connections are let in at a time.
const CONNECTIONS: usize = 128;

#[test]
fn connections_that_say_nothing_or_half_a_request_are_closed_and_keep_nobody_out_for_long() {
    let out = Out::new();
    let server = out.serve();
    let connect = || TcpStream::connect(("127.0.0.1", server.port())).unwrap();
    let mut held: Vec<TcpStream> = (0..CONNECTIONS).map(|_| connect()).collect();
    for stream in held.iter_mut().step_by(2) {
        stream.write_all(b"GET / HTTP/1.1\r\nHost: ").unwrap();
    }
    let mut waiting = connect();
    let host = format!("Host: 127.0.0.1:{}", server.port());
    waiting.write_all(format!("GET / HTTP/1.1\r\n{host}\r\nConnection: close\r\n\r\n").as_bytes()).unwrap();
    let mut answer = Vec::new();
    waiting.set_read_timeout(Some(Duration::from_secs(2))).unwrap();
    assert!(waiting.read_to_end(&mut answer).is_err() && answer.is_empty(), "there is no place yet");
    waiting.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
    waiting.read_to_end(&mut answer).unwrap();
    assert!(answer.starts_with(b"HTTP/1.1 200"), "{}", String::from_utf8_lossy(&answer));
    for stream in &mut held {
        stream.set_read_timeout(Some(Duration::from_secs(30))).unwrap();
        let mut rest = Vec::new();
        stream.read_to_end(&mut rest).unwrap();
    }
}
