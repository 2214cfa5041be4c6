//! The secret that is asked for where others can reach the server.

use crate::ReviewError;
use std::fmt::Write;

/// 128 random bits as hexadecimal digits.
#[derive(Clone)]
pub(crate) struct Token(String);

impl Token {
    /// A new one, from the system's source of randomness.
    pub(crate) fn new() -> Result<Self, ReviewError> {
        let mut bytes = [0; 16];
        let filled = getrandom::fill(&mut bytes).map_err(std::io::Error::other);
        filled.map_err(ReviewError::system("random numbers"))?;
        let mut digits = String::with_capacity(32);
        for byte in bytes {
            // Writing to a String can't fail.
            let _ = write!(digits, "{byte:02x}");
        }
        Ok(Self(digits))
    }

    /// For the address that is printed.
    pub(crate) fn digits(&self) -> &str {
        &self.0
    }

    /// Whether a request carries it. The time that this takes tells nothing of where two tokens differ.
    pub(crate) fn is_in(&self, authorization: &str) -> bool {
        let Some(given) = authorization.strip_prefix("Bearer ") else { return false };
        let differing = given.bytes().zip(self.0.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
        given.len() == self.0.len() && differing == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
