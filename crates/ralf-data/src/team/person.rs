//! What people are called who work together.

use crate::result::Component;
use std::collections::BTreeMap;

/// The longest name that the review's page and its interface take, characters.
const LONGEST: usize = 64;

/// A person's name from outside, without the spaces around it, which the review takes away too. The error says what is
/// wrong with it.
pub fn person(typed: &str) -> Result<Component, &'static str> {
    let name = typed.trim();
    if name.chars().count() > LONGEST { Err("one of more than 64 characters") } else { Component::new(name) }
}

/// Two of these names that are equal but for case: on some disks they have one file of second labels.
pub fn alike<'a>(names: impl IntoIterator<Item = &'a str>) -> Option<[&'a str; 2]> {
    let mut known = BTreeMap::new();
    names.into_iter().find_map(|name| known.insert(name.to_lowercase(), name).map(|before| [before, name]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_what_the_page_makes_of_it() {
        for typed in ["Zoë", " Zoë", "Zoë\t"] {
            assert_eq!(person(typed).unwrap().as_str(), "Zoë");
        }
        assert!(person(&"ë".repeat(64)).is_ok());
        assert_eq!(person(&"ë".repeat(65)).unwrap_err(), "one of more than 64 characters");
        assert_eq!(person(" ").unwrap_err(), "an empty one");
        assert_eq!(alike(["ada", "bob", "Ada"]), Some(["ada", "Ada"]));
        assert_eq!(alike(["ada", "bob"]), None);
    }
}
