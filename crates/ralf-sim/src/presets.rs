//! Ready-made recordings: `paper` follows the sequences of the paper's appendix, `tiny` is made in a second.

use super::{Scenario, ScenarioError, SimulatedSequence};

/// A named set of sequences.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// For the command line.
    pub name: &'static str,
    /// In the order of their names.
    pub sequences: &'static [PresetSequence],
}

/// A sequence of a preset: a drive through a place, which it may share with others.
#[derive(Debug, Clone, Copy)]
pub struct PresetSequence {
    /// The folder's name.
    pub name: &'static str,
    /// Scans of each radar.
    pub scans: usize,
    drive: &'static str,
    place: &'static str,
}

impl PresetSequence {
    /// The scenario's TOML.
    pub fn text(&self) -> String {
        // Tables of a drive would swallow the keys of a place: the place goes first.
        format!("{}\n{}", self.place, self.drive)
    }

    /// The sequence with so many scans of each radar. Its own seed follows from its name, so that sequences which share
    /// a place share no noise.
    pub fn simulate(&self, seed: u64, scans: usize) -> Result<SimulatedSequence, ScenarioError> {
        let own = self.name.bytes().fold(seed, |seed, byte| seed.wrapping_mul(257).wrapping_add(byte.into()));
        SimulatedSequence::new(self.name, &Scenario::from_toml(&self.text())?, own, scans)
    }
}

macro_rules! sequence {
    ($name:literal, $scans:literal, $place:literal) => {
        PresetSequence {
            name: $name,
            scans: $scans,
            drive: include_str!(concat!("presets/drives/", $name, ".toml")),
            place: include_str!(concat!("presets/places/", $place, ".toml")),
        }
    };
}

/// All presets.
pub const ALL: [Preset; 2] = [
    Preset {
        name: "paper",
        sequences: &[
            sequence!("00", 245, "crossing"),
            sequence!("01", 290, "open_space"),
            sequence!("02", 101, "street"),
            sequence!("03", 400, "parking"),
            sequence!("04", 334, "open_space"),
            sequence!("05", 163, "plaza"),
            sequence!("06", 170, "open_space"),
            sequence!("07", 422, "parking"),
            sequence!("08", 265, "crossing"),
            sequence!("09", 82, "residential"),
            sequence!("10", 232, "fishbone"),
        ],
    },
    Preset { name: "tiny", sequences: &[sequence!("tiny", 12, "small")] },
];

/// A preset by its name.
pub fn find(name: &str) -> Option<&'static Preset> {
    ALL.iter().find(|preset| preset.name == name)
}

impl Preset {
    /// Scans of each radar in all sequences together.
    pub fn scans(&self) -> usize {
        self.sequences.iter().map(|sequence| sequence.scans).sum()
    }

    /// So many scans spread over the sequences in proportion to their lengths, by largest remainders, and one at least.
    pub fn spread(&self, scans: usize) -> Vec<usize> {
        let total = self.scans();
        let mut shares: Vec<usize> =
            self.sequences.iter().map(|sequence| scans * sequence.scans / total).collect();
        let mut order: Vec<usize> = (0..shares.len()).collect();
        order.sort_by_key(|i| std::cmp::Reverse(scans * self.sequences[*i].scans % total));
        let missing = scans - shares.iter().sum::<usize>();
        order.iter().take(missing).for_each(|i| shares[*i] += 1);
        shares.iter_mut().for_each(|share| *share = (*share).max(1));
        shares
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_scenario() {
        for sequence in ALL.iter().flat_map(|preset| preset.sequences) {
            Scenario::from_toml(&sequence.text())
                .unwrap_or_else(|error| panic!("{}: {error}", sequence.name));
        }
    }

    #[test]
    fn scans_are_spread_in_proportion() {
        let paper = find("paper").unwrap();
        assert_eq!(paper.scans(), 2704);
        assert_eq!(paper.spread(2704), paper.sequences.iter().map(|s| s.scans).collect::<Vec<_>>());
        assert_eq!(paper.spread(300).iter().sum::<usize>(), 300);
        assert!(paper.spread(1).iter().all(|share| *share == 1));
        assert!(find("other").is_none());
    }
}
