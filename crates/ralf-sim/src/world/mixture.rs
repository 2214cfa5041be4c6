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

    /// A round of mixtures of some families: each gives the sensors of one, the waves of another and the places of a
    /// third. Other rounds mix them otherwise until all ways are done; none mixes fewer than three.
    pub fn round(families: &[&'static Family], round: usize) -> Vec<Self> {
        let count = families.len();
        if count < 3 {
            return Vec::new();
        }
        let others = count - 1;
        let waves = 1 + round % others;
        let places = 1 + (round + 1 + round / others % (others - 1)) % others;
        let part = |place: usize| families[place % count];
        let mixture =
            |at: usize| Self { sensors: part(at), waves: part(at + waves), places: part(at + places) };
        (0..count).map(mixture).collect()
    }

    /// Each of its families once.
    pub fn families(&self) -> Vec<&'static Family> {
        let mut families: Vec<&'static Family> = Vec::with_capacity(3);
        for family in [self.sensors, self.waves, self.places] {
            if families.iter().all(|known| known.name != family.name) {
                families.push(family);
            }
        }
        families
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
        match self.families().as_slice() {
            [family] => f.write_str(family.name),
            _ => write!(f, "{}+{}+{}", self.sensors.name, self.waves.name, self.places.name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::family::FAMILIES;
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn rounds_mix_all_families_in_all_ways() {
        let families: Vec<&Family> = FAMILIES.iter().collect();
        let mut found = BTreeSet::new();
        for round in 0..42 {
            let mixtures = Mixture::round(&families, round);
            for part in [|m: &Mixture| m.sensors, |m: &Mixture| m.waves, |m: &Mixture| m.places] {
                let names: BTreeSet<&str> = mixtures.iter().map(|mixture| part(mixture).name).collect();
                assert_eq!(names.len(), 8, "{round}");
            }
            assert!(mixtures.iter().all(|mixture| mixture.families().len() == 3), "{round}");
            found.extend(mixtures.iter().map(Mixture::to_string));
        }
        assert_eq!(found.len(), 8 * 7 * 6);
        assert_eq!(Mixture::round(&families[..3], 1).len(), 3);
        assert_eq!(Mixture::round(&families[..2], 0), []);
    }

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
