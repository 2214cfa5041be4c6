//! Runs cases in a process of their own, whose memory is bounded, and sees to it that each ends.

use std::fmt;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// Address space of the process that runs the cases, kB.
const MEMORY_KB: u64 = 2_000_000;
/// What a case may take: some do all that a command does, on a machine that does other things as well.
const PATIENCE: Duration = Duration::from_secs(30);

/// A case that went wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// The case, to be replayed.
    pub number: u64,
    /// Verb and file.
    pub name: String,
    /// Panic, hang, memory or death, with what the process said.
    pub what: String,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "case {} ({}): {}", self.number, self.name, self.what)
    }
}

/// How it went.
#[derive(Debug, Default)]
pub struct Watched {
    /// Cases that were run.
    pub cases: u64,
    /// Those that went wrong.
    pub failures: Vec<Failure>,
    /// The longest case.
    pub longest: Duration,
}

/// Runs cases from a number on for some time. `program` is the one of this crate.
pub fn watch(program: &Path, first: u64, time: Duration) -> std::io::Result<Watched> {
    let folder = tempfile::tempdir()?;
    crate::make_places(&folder.path().join("places"));
    let end = Instant::now() + time;
    let mut watched = Watched::default();
    let mut next = first;
    while Instant::now() < end {
        let mut child = start(program, folder.path(), next)?;
        let lines = lines(&mut child);
        let ended = follow(&lines, &mut watched, &mut next, end);
        let _ = child.kill();
        let _ = child.wait();
        if let Some((number, name, hang)) = ended {
            let mut said = String::new();
            if let Some(stderr) = &mut child.stderr {
                let _ = stderr.read_to_string(&mut said);
            }
            let what = if hang { format!("hangs for {PATIENCE:?}") } else { death(&said) };
            watched.failures.push(Failure { number, name, what });
            next = number + 1;
        }
    }
    Ok(watched)
}

fn death(said: &str) -> String {
    if let Some(line) = said.lines().find(|line| line.contains("memory allocation")) {
        return format!("memory: {line}");
    }
    let last = said.lines().rev().find(|line| !line.trim().is_empty());
    format!("death: {}", last.unwrap_or("without a word"))
}

fn start(program: &Path, folder: &Path, next: u64) -> std::io::Result<Child> {
    let _ = std::fs::remove_dir_all(folder.join("scratch"));
    let mut command = Command::new("sh");
    command.arg("-c").arg(format!("ulimit -v {MEMORY_KB}; exec \"$0\" \"$@\"")).arg(program);
    command.arg("cases").arg(folder.join("places")).arg(folder.join("scratch")).arg(next.to_string());
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
}

/// What the process tells, line by line.
fn lines(child: &mut Child) -> Receiver<String> {
    let (send, lines) = channel();
    if let Some(stdout) = child.stdout.take() {
        std::thread::spawn(move || {
            for line in BufReader::new(stdout).lines().map_while(Result::ok) {
                if send.send(line).is_err() {
                    return;
                }
            }
        });
    }
    lines
}

/// Follows a process until the time is over (`None`), or until it dies in a case or hangs there (true).
fn follow(
    lines: &Receiver<String>,
    watched: &mut Watched,
    next: &mut u64,
    end: Instant,
) -> Option<(u64, String, bool)> {
    let mut running = (*next, "before it began".to_owned());
    loop {
        let begun = Instant::now();
        match lines.recv_timeout(PATIENCE) {
            Ok(line) => match line.split_once(' ') {
                Some(("start", case)) => {
                    let (number, name) = case.split_once(' ').unwrap_or((case, ""));
                    running = (number.parse().unwrap_or(*next), name.to_owned());
                }
                Some(("panic", told)) => {
                    let (number, name) = running.clone();
                    watched.failures.push(Failure { number, name, what: format!("panic: {told}") });
                }
                _ => {
                    watched.cases += 1;
                    watched.longest = watched.longest.max(begun.elapsed());
                    *next = running.0 + 1;
                    if Instant::now() >= end {
                        return None;
                    }
                }
            },
            Err(RecvTimeoutError::Timeout) => return Some((running.0, running.1, true)),
            Err(RecvTimeoutError::Disconnected) => return Some((running.0, running.1, false)),
        }
    }
}
