//! What a browser is started with in place of the token: that, everybody on the machine can read.

use super::Token;
use crate::error::ReviewError;
use std::time::{Duration, Instant};

/// Where an invitation is taken, its code behind it.
pub(crate) const OPEN: &str = "/open/";
/// How long it is good: a browser's first start, on a slow disk, may take a minute.
const GOOD_FOR: Duration = Duration::from_secs(120);

/// A code that is worth nothing later, and nothing to others (see [`super::Ends`]).
pub(crate) struct Invitation {
    code: Token,
    given: Instant,
}

impl Invitation {
    pub(crate) fn new(now: Instant) -> Result<Self, ReviewError> {
        Ok(Self { code: Token::new()?, given: now })
    }

    pub(crate) fn path(&self) -> String {
        format!("{OPEN}{}", self.code.digits())
    }

    /// Whether this is its code, in time.
    pub(crate) fn is(&self, code: &str, now: Instant) -> bool {
        self.code.is(code) && now.duration_since(self.given) <= GOOD_FOR
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_good_for_a_while() {
        let now = Instant::now();
        let invitation = Invitation::new(now).unwrap();
        let path = invitation.path();
        let code = path.strip_prefix(OPEN).unwrap();
        assert!(invitation.is(code, now) && invitation.is(code, now + GOOD_FOR));
        assert!(!invitation.is(code, now + GOOD_FOR + Duration::from_millis(1)));
        assert!(!invitation.is(&code[1..], now) && !invitation.is("", now));
    }
}
