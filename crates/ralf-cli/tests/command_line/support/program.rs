//! The built program, run as people run it.

use serde_json::Value;
use std::process::{Command, Output};

/// The program, to be given arguments.
pub(crate) fn program() -> Command {
    Command::new(env!("CARGO_BIN_EXE_ralf"))
}

/// Runs the program with these arguments.
#[track_caller]
pub(crate) fn ralf<const N: usize>(arguments: [&str; N]) -> Ran {
    Ran::of(&program().args(arguments).output().unwrap())
}

/// How a run ended, and what it said.
#[derive(Debug)]
pub(crate) struct Ran {
    /// Exit status.
    pub(crate) code: Option<i32>,
    /// What it printed.
    pub(crate) stdout: String,
    /// What it said to people.
    pub(crate) stderr: String,
}

impl Ran {
    /// A program's end. None may panic.
    #[track_caller]
    pub(crate) fn of(output: &Output) -> Self {
        let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
        let ran =
            Self { code: output.status.code(), stdout: text(&output.stdout), stderr: text(&output.stderr) };
        assert!(!ran.stderr.contains("panicked at"), "{}", ran.stderr);
        ran
    }

    /// It ended with this status.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{}{}", self.stdout, self.stderr);
        self
    }

    /// It said all this on standard error.
    #[track_caller]
    pub(crate) fn says<const N: usize>(self, parts: [&str; N]) -> Self {
        for part in parts {
            assert!(self.stderr.contains(part), "expected `{part}` in\n{}", self.stderr);
        }
        self
    }

    /// The last that it said is an error, in one line, with all these parts.
    #[track_caller]
    pub(crate) fn ends_with_error<const N: usize>(self, parts: [&str; N]) -> Self {
        let last = self.stderr.lines().last().unwrap_or_default();
        assert!(last.starts_with("error: "), "{}", self.stderr);
        for part in parts {
            assert!(last.contains(part), "expected `{part}` in\n{last}");
        }
        self
    }

    /// It said nothing on standard error.
    #[track_caller]
    pub(crate) fn says_nothing(self) -> Self {
        assert_eq!(self.stderr, "");
        self
    }

    /// It printed all this on standard output.
    #[track_caller]
    pub(crate) fn prints<const N: usize>(self, parts: [&str; N]) -> Self {
        for part in parts {
            assert!(self.stdout.contains(part), "expected `{part}` in\n{}", self.stdout);
        }
        self
    }

    /// It printed nothing on standard output.
    #[track_caller]
    pub(crate) fn prints_nothing(self) -> Self {
        assert_eq!(self.stdout, "");
        self
    }

    /// The lines that name scans which are not labelled.
    pub(crate) fn not_labelled(&self) -> Vec<&str> {
        self.stderr.lines().filter_map(|line| line.strip_prefix("not labelled: ")).collect()
    }

    /// What it printed, as JSON.
    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap()
    }
}
