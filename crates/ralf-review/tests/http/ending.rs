//! The end of the server.

use crate::support::{Out, SEQUENCE};
use std::io::Write;
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
    std::io::Read::read_to_string(&mut stream, &mut answer).unwrap();
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
