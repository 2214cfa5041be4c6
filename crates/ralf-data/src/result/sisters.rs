//! A radar whose plausible share is far from its sisters': what neither its range rates nor the LiDAR gave away shows
//! in the labels.

use serde::{Deserialize, Serialize};

/// A sequence needs so many radars: of two nobody knows which is right.
const FEWEST_RADARS: usize = 3;
/// Fewer detections, in scans that had a LiDAR's beside them, tell no share.
const FEWEST: u64 = 500;
/// Far: the odds of being plausible are so many times those of the sister with the highest, or those of the lowest are
/// so many times them.
const FAR: f64 = 2.5;
/// Fewer plausible ones than this are hardly any, whatever others have: of real radars one in five is.
const HARDLY_ANY: f64 = 0.01;

/// What a radar's labels count.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RadarCounts<'a> {
    pub(crate) radar: &'a str,
    pub(crate) plausible: u64,
    pub(crate) detections: u64,
}

impl RadarCounts<'_> {
    fn share(&self) -> f64 {
        self.plausible as f64 / self.detections as f64
    }

    /// What there is to say, for people, where hardly any detection is plausible.
    pub(crate) fn hardly_any(&self) -> Option<String> {
        let Self { plausible, detections, .. } = *self;
        let is_hardly_any = detections >= FEWEST && self.share() < HARDLY_ANY;
        is_hardly_any.then(|| {
            format!(
                "{plausible} of its {detections} detections beside a LiDAR's scan are plausible, which is hardly any: \
                 its mounting, its clock or its units may be wrong (`ralf check`), or something covers it"
            )
        })
    }
}

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
    pub(crate) fn of(radars: &[RadarCounts]) -> Vec<Self> {
        let known: Vec<&RadarCounts> = radars.iter().filter(|radar| radar.detections >= FEWEST).collect();
        if known.len() < FEWEST_RADARS {
            return Vec::new();
        }
        let mut found = Vec::new();
        for (i, counts) in known.iter().enumerate() {
            let (mut lowest, mut highest) = (1.0_f64, 0.0_f64);
            for (_, other) in known.iter().enumerate().filter(|(other, _)| *other != i) {
                (lowest, highest) = (lowest.min(other.share()), highest.max(other.share()));
            }
            let share = counts.share();
            if odds(share) > FAR * odds(highest) || FAR * odds(share) < odds(lowest) {
                found.push(Self { radar: counts.radar.to_owned(), share, sisters: [lowest, highest] });
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
        let names = ["radar_0", "radar_1", "radar_2", "radar_3"];
        let mut radars = Vec::new();
        for (radar, (plausible, detections)) in names.into_iter().zip(shares) {
            let [plausible, detections] = [*plausible, *detections].map(u64::from);
            radars.push(RadarCounts { radar, plausible, detections });
        }
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
    fn hardly_any_is_said_of_one_radar_alone_too() {
        let said = |plausible, detections| RadarCounts { radar: "a", plausible, detections }.hardly_any();
        assert!(said(0, 745).is_some_and(|words| words.starts_with("0 of its 745 detections")));
        assert_eq!([said(10, 1000), said(0, 499), said(0, 0)], [None, None, None]);
    }

    #[test]
    fn it_is_said_in_shares() {
        let found = UnlikeSisters { radar: "a".into(), share: 0.042, sisters: [0.19, 0.24] };
        assert!(
            found.words().starts_with("4 % of its detections are plausible, 19 to 24 % of the other radars'")
        );
    }
}
