//! The secret that is asked for: others may work on the same machine, or reach it.

use crate::error::ReviewError;
use crate::place;
use std::fmt::Write as _;
use std::fs::{self, OpenOptions};
use std::io::{self, Write as _};
use std::path::Path;

/// 128 random bits as hexadecimal digits.
#[derive(Clone)]
pub(crate) struct Token(String);

/// How many digits a token has.
const DIGITS: usize = 32;

impl Token {
    /// The token of the labels in `out`, kept in the user's own `folder` so that a page stays open when the
    /// server is started again. A new one where there is none, and where none can be kept.
    pub(crate) fn of(out: &Path, folder: Option<&Path>) -> Result<Self, ReviewError> {
        let Some(folder) = folder else { return Self::new() };
        let file = folder.join(place::digits(out));
        if let Some(kept) = fs::read_to_string(&file).ok().and_then(|text| Self::from_digits(text.trim())) {
            return Ok(kept);
        }
        let token = Self::new()?;
        // A token that can't be kept serves until the server ends.
        let _kept = keep(folder, &file, &token.0);
        Ok(token)
    }

    /// A new one, from the system's source of randomness.
    pub(crate) fn new() -> Result<Self, ReviewError> {
        let mut bytes = [0; DIGITS / 2];
        let filled = getrandom::fill(&mut bytes).map_err(std::io::Error::other);
        filled.map_err(ReviewError::system("random numbers"))?;
        let mut digits = String::with_capacity(DIGITS);
        for byte in bytes {
            // Writing to a String can't fail.
            let _ = write!(digits, "{byte:02x}");
        }
        Ok(Self(digits))
    }

    fn from_digits(text: &str) -> Option<Self> {
        let whole = text.len() == DIGITS && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        whole.then(|| Self(text.to_owned()))
    }

    /// For the address that is printed.
    pub(crate) fn digits(&self) -> &str {
        &self.0
    }

    /// Whether a request carries it.
    pub(crate) fn is_in(&self, authorization: &str) -> bool {
        authorization.strip_prefix("Bearer ").is_some_and(|given| self.is(given))
    }

    /// Whether these are its digits. The time that this takes tells nothing of where two tokens differ.
    pub(crate) fn is(&self, given: &str) -> bool {
        let differing = given.bytes().zip(self.0.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        given.len() == self.0.len() && differing == 0
    }
}

/// Writes a file that nobody but the user can read.
fn keep(folder: &Path, file: &Path, digits: &str) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    // What is there holds no token.
    let _absent = fs::remove_file(file);
    let mut options = OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
    options.open(file)?.write_all(digits.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_token_is_kept_for_its_labels_alone_and_for_nobody_else_to_read() {
        let folder = tempfile::tempdir().unwrap();
        let [here, there] = ["here", "there"].map(|name| folder.path().join(name));
        let kept = folder.path().join("kept");
        let token = |out: &Path| Token::of(out, Some(&kept)).unwrap().0;
        let first = token(&here);
        assert_eq!(token(&here), first);
        assert_ne!(token(&there), first);
        assert_ne!(Token::of(&here, None).unwrap().0, first);
        for file in fs::read_dir(&kept).unwrap().map(Result::unwrap) {
            #[cfg(unix)]
            {
                use std::os::unix::fs::PermissionsExt;
                assert_eq!(file.metadata().unwrap().permissions().mode() & 0o777, 0o600);
            }
            fs::write(file.path(), "no token").unwrap();
        }
        let second = token(&here);
        assert_ne!(second, first);
        assert_eq!(token(&here), second);
    }

    #[test]
    fn only_the_whole_token_counts() {
        let [token, other] = [(); 2].map(|()| Token::new().unwrap());
        let digits = token.digits();
        assert_eq!(digits.len(), 32);
        assert!(token.is_in(&format!("Bearer {digits}")));
        for wrong in [
            String::new(),
            digits.to_owned(),
            format!("Bearer {}", &digits[..31]),
            format!("Bearer {digits}0"),
        ] {
            assert!(!token.is_in(&wrong), "{wrong}");
        }
        assert!(!token.is_in(&format!("Bearer {}", other.digits())));
    }
}
