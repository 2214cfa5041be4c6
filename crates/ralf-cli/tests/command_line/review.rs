//! `ralf review`: from the first line that it prints to its end, however that comes.

use crate::support::{Dataset, program, ralf};
use ralf_corrections::{FILE, read_layer};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, ChildStdout, Command, Stdio};

/// A server of its own.
struct Review {
    child: Child,
    /// Held open, for a program that can't print ends.
    _printed: BufReader<ChildStdout>,
    address: String,
    token: String,
}

impl Review {
    fn start(dataset: &Dataset, more: &[&str]) -> Self {
        Self::start_with(program(), dataset, more)
    }

    fn start_with(mut command: Command, dataset: &Dataset, more: &[&str]) -> Self {
        let state = Path::new(&dataset.out).with_extension("state");
        let command = command.args(["review", &dataset.path, &dataset.out, "--port", "0", "--author", "ada"]);
        let command = command.args(more).env("XDG_STATE_HOME", state);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut url = String::new();
        let mut printed = BufReader::new(child.stdout.take().unwrap());
        printed.read_line(&mut url).unwrap();
        let (address, token) = url.trim().strip_prefix("http://").unwrap().split_once("/?token=").unwrap();
        Self { address: address.to_owned(), token: token.to_owned(), _printed: printed, child }
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
    let dataset = labelled();
    let review = Review::start(&dataset, &[]);
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
fn second_labels_go_through_no_link_that_leads_out() {
    let dataset = labelled();
    let victim = dataset.beside("victim");
    fs::create_dir(&victim).unwrap();
    std::os::unix::fs::symlink(&victim, format!("{}/second", dataset.out)).unwrap();
    ralf(["review", &dataset.path, &dataset.out, "--port", "0", "--second", "bob"])
        .exits(1)
        .ends_with_error(["out/second: link: expected a folder", "victim"]);
    assert_eq!(fs::read_dir(victim).unwrap().count(), 0);
}

#[test]
fn addresses_of_all_interfaces_can_be_opened() {
    let dataset = labelled();
    let review = Review::start(&dataset, &["--host", "0.0.0.0"]);
    assert!(review.address.starts_with("127.0.0.1:"), "{}", review.address);
    assert!(review.ask("GET", "recording", "").starts_with("HTTP/1.1 200"));
    assert!(review.end("-INT"));
}

/// A command that runs the program as somebody who can write nowhere: root could, whatever the permissions say.
#[cfg(unix)]
fn program_of_nobody() -> Command {
    let mut command = Command::new("setpriv");
    command.args(["--reuid=65534", "--regid=65534", "--clear-groups"]).arg(program().get_program());
    command
}

#[cfg(unix)]
#[test]
fn an_out_that_can_only_be_read_is_shown_and_says_so() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    let is_root = fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0);
    if is_root && !is_root_and_can_be_nobody() {
        return println!("skipped: root can write everywhere, and there is no setpriv");
    }
    let dataset = labelled();
    let out = Path::new(&dataset.out);
    for (with_corrections, with_journal) in [(false, false), (true, false), (true, true)] {
        if with_corrections && !with_journal {
            let review = Review::start(&dataset, &[]);
            review.correct(0);
            assert!(review.end("-TERM"));
        }
        if with_journal {
            // Whoever reads leaves a journal, for only who may write takes it away.
            ralf(["evaluate", &dataset.out, "--progress"]).exits(0);
            assert!(out.join("corrections.sqlite-shm").exists());
        }
        let permit = |mode: u32| fs::set_permissions(out, fs::Permissions::from_mode(mode)).unwrap();
        fs::set_permissions(out.parent().unwrap(), fs::Permissions::from_mode(0o755)).unwrap();
        permit(0o555);
        let command = if is_root { program_of_nobody() } else { program() };
        let review = Review::start_with(command, &dataset, &[]);
        let recording = review.ask("GET", "recording", "");
        assert!(
            recording.starts_with("HTTP/1.1 200") && !recording.contains("\"read_only\":null"),
            "{recording}"
        );
        let queue = review.ask("GET", "sequences/00/queue", "");
        let corrected = format!("\"corrected_detections\":{}", u8::from(with_corrections));
        assert!(queue.contains(&corrected), "{queue}");
        let undo = review.ask("POST", "sequences/00/undo", "{}");
        assert!(undo.starts_with("HTTP/1.1 403") && undo.contains("can only be read"), "{undo}");
        assert!(review.end("-TERM"));
        permit(0o755);
    }
}

/// Whether this is root, and may run the program as somebody who can write nowhere.
#[cfg(unix)]
fn is_root_and_can_be_nobody() -> bool {
    use std::os::unix::fs::MetadataExt;
    fs::metadata("/proc/self").is_ok_and(|own| own.uid() == 0)
        && program_of_nobody().arg("--version").output().is_ok_and(|ran| ran.status.success())
}

/// Who can only read began to look when nobody wrote, and before there was a store at all.
#[cfg(unix)]
#[test]
fn who_can_only_read_sees_what_others_write_meanwhile() {
    use std::os::unix::fs::PermissionsExt;
    if !is_root_and_can_be_nobody() {
        return println!("skipped: only root writes where another person can't");
    }
    let dataset = labelled();
    let out = Path::new(&dataset.out);
    for (folder, mode) in [(out.parent().unwrap(), 0o755), (out, 0o555)] {
        fs::set_permissions(folder, fs::Permissions::from_mode(mode)).unwrap();
    }
    let reader = Review::start_with(program_of_nobody(), &dataset, &[]);
    let sees = |corrected: u32| {
        let queue = reader.ask("GET", "sequences/00/queue", "");
        assert!(queue.contains(&format!("\"corrected_detections\":{corrected}")), "{corrected}: {queue}");
    };
    sees(0);
    for corrected in 1..3 {
        let writer = Review::start(&dataset, &[]);
        writer.correct(corrected - 1);
        sees(corrected);
        assert!(writer.end("-TERM"));
        sees(corrected);
    }
}

#[test]
fn what_can_not_be_reviewed_is_told() {
    let dataset = Dataset::new();
    ralf(["review", &dataset.path, &dataset.out])
        .exits(1)
        .says(["expected the record of a finished `ralf label`"]);
    ralf(["review", &dataset.path]).exits(2).says(["<OUT>"]);
}

/// What `ralf review --open` starts a browser with.
#[cfg(target_os = "linux")]
fn browser_of(dataset: &Dataset) -> (Review, String) {
    use std::os::unix::fs::PermissionsExt;
    let [programs, seen] = ["programs", "seen"].map(|name| dataset.beside(name));
    fs::create_dir(&programs).unwrap();
    let browser = format!("{programs}/xdg-open");
    fs::write(&browser, format!("#!/bin/sh\necho \"$@\" > {seen}.part\nmv {seen}.part {seen}\n")).unwrap();
    fs::set_permissions(&browser, PermissionsExt::from_mode(0o755)).unwrap();
    let mut command = program();
    command.env("PATH", format!("{programs}:{}", std::env::var("PATH").unwrap()));
    let review = Review::start_with(command, dataset, &["--open"]);
    let begun = std::time::Instant::now();
    while !Path::new(&seen).exists() {
        assert!(begun.elapsed().as_secs() < 60, "no browser was opened");
        std::thread::sleep(std::time::Duration::from_millis(20));
    }
    let seen = fs::read_to_string(seen).unwrap().trim().to_owned();
    (review, seen)
}

/// Everybody on the machine sees what programs are started with.
#[cfg(target_os = "linux")]
#[test]
fn the_browser_is_started_without_the_token_and_led_to_it_once() {
    let dataset = labelled();
    let (review, opened) = browser_of(&dataset);
    assert!(!opened.contains(&review.token), "{opened}");
    let path = opened.strip_prefix(&format!("http://{}/", review.address)).unwrap();
    let ask = |path: &str| {
        let mut stream = TcpStream::connect(&review.address).unwrap();
        let address = &review.address;
        write!(stream, "GET /{path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    };
    let wrong = ask(&format!("open/{}", review.token));
    assert!(wrong.starts_with("HTTP/1.1 401"), "{wrong}");
    let answer = ask(path);
    let led = format!("location: /?token={}\r\n", review.token);
    assert!(answer.starts_with("HTTP/1.1 303") && answer.contains(&led), "{answer}");
    assert!(answer.contains("cache-control: no-store\r\n"), "{answer}");
    let again = ask(path);
    assert!(again.starts_with("HTTP/1.1 401") && again.contains("open the address that"), "{again}");
    assert!(!again.contains(&review.token));
    assert!(review.end("-INT"));
}

/// Whoever sees what the browser is started with may be faster than it.
#[cfg(target_os = "linux")]
#[test]
fn what_the_browser_is_started_with_lets_nobody_else_in() {
    let other = |script: &str| {
        let mut command = Command::new("setpriv");
        command.args(["--reuid=54321", "--regid=54321", "--clear-groups", "bash", "-c", script]);
        command.output().ok().filter(|ran| ran.status.success())
    };
    if other("true").is_none() {
        return println!("skipped: nobody else can be asked without root, setpriv and bash");
    }
    let dataset = labelled();
    let (review, opened) = browser_of(&dataset);
    let (host, port) = review.address.split_once(':').unwrap();
    let path = opened.strip_prefix(&format!("http://{}", review.address)).unwrap();
    let ask = format!(
        "exec 3<>/dev/tcp/{host}/{port}\n\
         printf 'GET {path} HTTP/1.1\\r\\nHost: {host}:{port}\\r\\nConnection: close\\r\\n\\r\\n' >&3\ncat <&3"
    );
    let answer = String::from_utf8(other(&ask).unwrap().stdout).unwrap();
    assert!(answer.starts_with("HTTP/1.1 401") && !answer.contains(&review.token), "{answer}");
    let own = Command::new("bash").args(["-c", &ask]).output().unwrap();
    assert!(
        String::from_utf8(own.stdout).unwrap().starts_with("HTTP/1.1 303"),
        "it is good for its user yet"
    );
    assert!(review.end("-INT"));
}
