//! A radar whose plausible share is far from its sisters': what neither its range rates nor the LiDAR gave away shows in
//! the labels.

use super::RadarRecord;
use serde::{Deserialize, Serialize};

/// A sequence needs so many radars: of two nobody knows which is right.
const FEWEST_RADARS: usize = 3;
/// Fewer detections tell no share.
const FEWEST: u64 = 500;
/// Far: the odds of being plausible are so many times those of the sister with the highest, or the lowest over this. In
/// good recordings, real and simulated, they stay within 1.6 times.
const FAR: f64 = 2.5;

/// A radar that is unlike the others of its sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct UnlikeSisters {
    /// Its name.
    pub radar: String,
    /// Share of its detections that is plausible, 0 to 1.
    pub share: f64,
    /// The lowest and the highest share of the others.
    pub sisters: [f64; 2],
}

impl UnlikeSisters {
    /// Those of a sequence's radars.
    pub(crate) fn of(radars: &[RadarRecord]) -> Vec<Self> {
        let total = |counts: &[u32]| counts.iter().copied().map(u64::from).sum::<u64>();
        let known: Vec<(&str, f64)> = radars
            .iter()
            .map(|radar| (radar.name.as_str(), total(&radar.plausible), total(&radar.detections)))
            .filter(|(_, _, detections)| *detections >= FEWEST)
            .map(|(name, plausible, detections)| (name, plausible as f64 / detections as f64))
            .collect();
        if known.len() < FEWEST_RADARS {
            return Vec::new();
        }
        let mut found = Vec::new();
        for (i, (radar, share)) in known.iter().enumerate() {
            let others =
                known.iter().enumerate().filter(|(other, _)| *other != i).map(|(_, (_, share))| *share);
            let (lowest, highest) =
                others.fold((1.0_f64, 0.0_f64), |(low, high), share| (low.min(share), high.max(share)));
            if odds(*share) > FAR * odds(highest) || FAR * odds(*share) < odds(lowest) {
                found.push(Self { radar: (*radar).to_owned(), share: *share, sisters: [lowest, highest] });
            }
        }
        found
    }

    /// For people: `4 % of its detections are plausible, 19 to 24 % of the other radars'`.
    pub fn words(&self) -> String {
        let [share, lowest, highest] =
            [self.share, self.sisters[0], self.sisters[1]].map(|share| share * 100.0);
        format!(
            "{share:.0} % of its detections are plausible, {lowest:.0} to {highest:.0} % of the other radars': its \
             mounting, its clock or its units may be wrong, or something covers it"
        )
    }
}

/// Of a share; finite.
fn odds(share: f64) -> f64 {
    let share = share.clamp(1e-4, 1.0 - 1e-4);
    share / (1.0 - share)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unlike(shares: &[(u32, u32)]) -> Vec<String> {
        let record = |(i, (plausible, detections)): (usize, &(u32, u32))| RadarRecord {
            name: format!("radar_{i}"),
            plausible: vec![*plausible, 0],
            detections: vec![*detections, 0],
            ..RadarRecord::default()
        };
        let radars: Vec<RadarRecord> = shares.iter().enumerate().map(record).collect();
        UnlikeSisters::of(&radars).into_iter().map(|found| found.radar).collect()
    }

    #[test]
    fn a_radar_with_hardly_any_plausible_detections_is_unlike_its_sisters() {
        assert_eq!(unlike(&[(220, 1000), (190, 1000), (60, 1000), (240, 1000)]), ["radar_2"]);
        assert_eq!(unlike(&[(220, 1000), (190, 1000), (600, 1000), (240, 1000)]), ["radar_2"]);
        assert_eq!(unlike(&[(220, 1000), (0, 1000), (240, 1000)]), ["radar_1"]);
    }

    #[test]
    fn radars_that_look_elsewhere_differ() {
        assert!(unlike(&[(220, 1000), (190, 1000), (140, 1000), (300, 1000)]).is_empty());
        assert!(unlike(&[(220, 1000), (60, 1000)]).is_empty(), "of two nobody knows which");
        assert!(unlike(&[(220, 1000), (190, 1000), (1, 90)]).is_empty(), "too few detections");
        assert!(unlike(&[(0, 1000), (0, 1000), (0, 1000)]).is_empty());
    }

    #[test]
    fn it_is_said_in_shares() {
        let found = UnlikeSisters { radar: "a".into(), share: 0.042, sisters: [0.19, 0.24] };
        assert!(
            found.words().starts_with("4 % of its detections are plausible, 19 to 24 % of the other radars'")
        );
    }
}
