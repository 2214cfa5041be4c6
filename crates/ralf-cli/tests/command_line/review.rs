//! `ralf review`: from the first line that it prints to Ctrl-C.

use crate::support::{Dataset, program, ralf};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Command, Stdio};

#[test]
fn the_address_is_printed_served_and_ended_by_an_interrupt() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let mut command = program();
    let command = command.args(["review", &dataset.path, &dataset.out, "--port", "0", "--author", "ada"]);
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let mut url = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut url).unwrap();
    let address = url.trim().strip_prefix("http://").unwrap().strip_suffix('/').unwrap();
    let mut stream = TcpStream::connect(address).unwrap();
    let request = format!("GET /api/recording HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n");
    stream.write_all(request.as_bytes()).unwrap();
    let mut answer = String::new();
    stream.read_to_string(&mut answer).unwrap();
    assert!(answer.starts_with("HTTP/1.1 200") && answer.contains("\"author\":\"ada\""), "{answer}");
    let interrupt = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(interrupt.success() && child.wait().unwrap().success());
}

#[test]
fn what_can_not_be_reviewed_is_told() {
    let dataset = Dataset::new();
    ralf(["review", &dataset.path, &dataset.out])
        .exits(1)
        .says(["expected the record of a finished `ralf label`"]);
    ralf(["review", &dataset.path]).exits(2).says(["<OUT>"]);
}
