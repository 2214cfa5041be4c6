//! Worlds whose parts are of several families.

use super::family::Family;
use std::fmt;

/// Where a world's ranges come from: the sensors of one family at the places of another, where waves behave as in a
/// third. What is learned in such worlds cannot hang on what happens to go together in a family.
///
/// ```
/// use ralf_sim::world::{Family, Mixture};
/// let mixture = Mixture::find("survey+yard+motorway").unwrap();
/// assert_eq!(mixture.places.name, "motorway");
/// assert_eq!(mixture.to_string(), "survey+yard+motorway");
/// assert_eq!(Mixture::find("yard"), Some(Family::find("yard").unwrap().into()));
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Mixture {
    /// Radars, LiDARs, cameras, and what the recording says wrongly of them.
    pub sensors: &'static Family,
    /// How waves behave, and how often it rains.
    pub waves: &'static Family,
    /// Where it is driven, among what, and how.
    pub places: &'static Family,
}

impl Mixture {
    /// A family by its name or number, or three with `+` between them: of the sensors, the waves and the places.
    pub fn find(text: &str) -> Option<Self> {
        let parts: Option<Vec<&'static Family>> = text.split('+').map(Family::find).collect();
        match *parts?.as_slice() {
            [family] => Some(family.into()),
            [sensors, waves, places] => Some(Self { sensors, waves, places }),
            _ => None,
        }
    }
}

impl From<&'static Family> for Mixture {
    fn from(family: &'static Family) -> Self {
        Self { sensors: family, waves: family, places: family }
    }
}

impl PartialEq for Mixture {
    fn eq(&self, other: &Self) -> bool {
        let names = |mixture: &Self| [mixture.sensors, mixture.waves, mixture.places].map(|part| part.name);
        names(self) == names(other)
    }
}

/// The family's name, or three with `+` between them.
impl fmt::Display for Mixture {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if *self == self.sensors.into() {
            return f.write_str(self.sensors.name);
        }
        write!(f, "{}+{}+{}", self.sensors.name, self.waves.name, self.places.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_family_or_three_are_found() {
        for wrong in ["", "town", "city+yard", "city+yard+town", "city+yard+city+yard", "city++yard"] {
            assert_eq!(Mixture::find(wrong), None, "{wrong}");
        }
        assert_eq!(Mixture::find("2+yard+0").unwrap().to_string(), "motorway+yard+city");
        assert_eq!(Mixture::find("city+city+city").unwrap().to_string(), "city");
        assert_eq!(Mixture::find("city+city+yard").unwrap().to_string(), "city+city+yard");
    }
}
