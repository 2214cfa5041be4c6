//! Where the errors are: over range and azimuth, by class and by cause.

use crate::scored::Scored;
use ralf::label::class_name;
use ralf::metrics::Confusion;
use std::collections::BTreeMap;

/// Confusion matrices along an axis.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Profile {
    /// Lower edge of the first bin.
    pub(crate) first: f64,
    /// Width of each bin.
    pub(crate) step: f64,
    /// Of each bin.
    pub(crate) bins: Vec<Confusion>,
}

/// Confusion matrices by metre of range and by 10 degrees of azimuth.
#[derive(Debug, Default)]
pub(crate) struct Profiles {
    /// By whole metres; what lies beyond [`FARTHEST`] counts there.
    range: BTreeMap<usize, Confusion>,
    farthest: f64,
    /// From -180 degrees.
    azimuth: BTreeMap<usize, Confusion>,
    widest: f64,
}

/// Width of a bin of the azimuth, degrees.
const AZIMUTH_STEP: f64 = 10.0;
/// How many there are all around.
const AZIMUTH_BINS: usize = 36;

/// No radar of a vehicle looks farther, m: a damaged number must not stretch the axis.
const FARTHEST: f64 = 1000.0;

impl Profiles {
    pub(crate) fn add(&mut self, scored: &Scored, truth: bool) {
        let (range, azimuth) = (f64::from(scored.range), f64::from(scored.azimuth).to_degrees());
        self.widest = self.widest.max(azimuth.abs());
        if range.is_finite() {
            let range = range.min(FARTHEST);
            self.farthest = self.farthest.max(range);
            self.range.entry(range as usize).or_default().add(truth, scored.plausible);
        }
        if azimuth.is_finite() {
            let bin = (((azimuth + 180.0) / AZIMUTH_STEP) as usize).min(AZIMUTH_BINS - 1);
            self.azimuth.entry(bin).or_default().add(truth, scored.plausible);
        }
    }

    /// Over the range, m.
    pub(crate) fn over_range(&self) -> Profile {
        // About 20 bins of a width that people like.
        let step =
            [1.0, 2.0, 5.0, 10.0, 20.0].into_iter().find(|step| self.farthest / step <= 20.0).unwrap_or(50.0);
        let count = ((self.farthest / step).ceil() as usize).max(1);
        let mut bins = vec![Confusion::default(); count];
        for (metre, counts) in &self.range {
            bins[(metre / step as usize).min(count - 1)] += *counts;
        }
        Profile { first: 0.0, step, bins }
    }

    /// Over the azimuth in the radar's frame, degrees.
    pub(crate) fn over_azimuth(&self) -> Profile {
        let edge = (self.widest.clamp(AZIMUTH_STEP, 180.0) / AZIMUTH_STEP).ceil() * AZIMUTH_STEP;
        let (count, left_out) =
            ((2.0 * edge / AZIMUTH_STEP) as usize, ((180.0 - edge) / AZIMUTH_STEP) as usize);
        let mut bins = vec![Confusion::default(); count];
        for (bin, counts) in &self.azimuth {
            bins[bin.saturating_sub(left_out).min(count - 1)] += *counts;
        }
        Profile { first: -edge, step: AZIMUTH_STEP, bins }
    }
}

/// Something with a name that is labelled right or wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Group {
    /// The class or cause.
    pub(crate) name: String,
    /// Whether it is plausible.
    pub(crate) plausible: bool,
    /// How many there are.
    pub(crate) count: u64,
    /// How many of them are labelled plausible.
    pub(crate) kept: u64,
}

/// Counts by class and by cause.
#[derive(Debug, Default)]
pub(crate) struct Groups {
    /// Detections, and those labelled plausible, by class and whether it is a plausible one.
    classes: BTreeMap<(u16, bool), [u64; 2]>,
    /// Causes in the order in which sequences name them; several sequences may share some.
    causes: Vec<(String, [u64; 2])>,
}

impl Groups {
    /// A sequence with these causes follows. The first is none: where people have corrected the truth it has artifacts
    /// of which no file tells a cause.
    pub(crate) fn name_causes(&mut self, names: &[String]) {
        names.iter().skip(1).for_each(|name| self.name_cause(name));
    }

    /// A cause may follow that no file names: people say their own.
    pub(crate) fn name_cause(&mut self, name: &str) {
        if self.causes.iter().all(|(known, _)| known != name) {
            self.causes.push((name.to_owned(), [0; 2]));
        }
    }

    pub(crate) fn add(&mut self, scored: &Scored, cause: Option<&str>) {
        let Some((class, plausible)) = scored.truth else { return };
        count(self.classes.entry((class, plausible)).or_default(), scored);
        let cause = cause.filter(|_| !plausible);
        let known = cause.and_then(|cause| self.causes.iter_mut().find(|(name, _)| name == cause));
        if let Some((_, counts)) = known {
            count(counts, scored);
        }
    }

    /// By the class that the truth gives, in the order of their ids.
    pub(crate) fn by_class(&self) -> Vec<Group> {
        let group = |(&(id, plausible), &[count, kept]): (&(u16, bool), &[u64; 2])| {
            let name = class_name(id).map_or_else(|| format!("class {id}"), str::to_owned);
            Group { name, plausible, count, kept }
        };
        self.classes.iter().map(group).collect()
    }

    /// Artifacts by cause; empty where causes aren't known.
    pub(crate) fn by_cause(&self) -> Vec<Group> {
        let found = self.causes.iter().filter(|(_, [count, _])| *count > 0);
        let group = |(name, [count, kept]): &(String, [u64; 2])| Group {
            name: name.clone(),
            plausible: false,
            count: *count,
            kept: *kept,
        };
        found.map(group).collect()
    }
}

fn count(counts: &mut [u64; 2], scored: &Scored) {
    *counts = [counts[0] + 1, counts[1] + u64::from(scored.plausible)];
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(range: f32, azimuth: f32, plausible: bool, class: u16, cause: u8) -> Scored {
        let truth = ralf::label::truth_of(class).map(|truth| (class, truth));
        Scored { range, azimuth, plausible, truth, cause: Some(cause), ..Scored::with(1.0) }
    }

    fn some() -> [Scored; 5] {
        [
            scored(3.0, -0.5, true, 10, 0),
            scored(3.5, 0.5, false, 10, 0),
            scored(17.0, 0.0, true, 1, 1),
            scored(17.0, 0.0, false, 1, 2),
            scored(17.0, f32::NAN, false, 0, 2),
        ]
    }

    #[test]
    fn errors_are_counted_where_they_are() {
        let mut profiles = Profiles::default();
        for scored in some() {
            if let Some((_, truth)) = scored.truth {
                profiles.add(&scored, truth);
            }
        }
        let found = profiles.over_range();
        assert_eq!((found.step, found.bins.len()), (1.0, 17));
        assert_eq!(found.bins[3], Confusion { tp: 1, fp: 0, tn: 0, r#fn: 1 });
        assert_eq!(found.bins[16], Confusion { tp: 0, fp: 1, tn: 1, r#fn: 0 });
        let found = profiles.over_azimuth();
        // 0.5 rad is 28.6 deg: from -30 to 30.
        assert_eq!((found.first, found.bins.len()), (-30.0, 6));
        assert_eq!((found.bins[0].tp, found.bins[5].r#fn, found.bins[3].total()), (1, 1, 2));
    }

    /// Two metres to a bin, and what lies on the last edge belongs to the last bin.
    #[test]
    fn far_detections_widen_the_bins() {
        let mut profiles = Profiles::default();
        for range in [0.0, 1.9, 2.0, 39.9, 40.0] {
            profiles.add(&scored(range, 3.2, true, 10, 0), true);
        }
        let found = profiles.over_range();
        assert_eq!((found.step, found.bins.len()), (2.0, 20));
        assert_eq!((found.bins[0].tp, found.bins[1].tp, found.bins[19].tp), (2, 1, 2));
        for range in [1e20, f32::MAX] {
            profiles.add(&scored(range, 3.2, true, 10, 0), true);
        }
        assert_eq!(
            (profiles.over_range().bins.len(), profiles.over_range().bins[19].tp),
            (20, 2),
            "no farther"
        );
        // Beyond 180 degrees there is nothing.
        assert_eq!((profiles.over_azimuth().first, profiles.over_azimuth().bins[35].tp), (-180.0, 7));
    }

    #[test]
    fn what_has_no_place_stretches_no_axis() {
        let mut profiles = Profiles::default();
        for range in [9.5, f32::NAN, f32::INFINITY] {
            profiles.add(&scored(range, 0.0, true, 10, 0), true);
        }
        let found = profiles.over_range();
        assert_eq!((found.step, found.bins.len(), found.bins[9].tp), (1.0, 10, 1));
        assert_eq!(found.bins.iter().map(Confusion::total).sum::<u64>(), 1);
    }

    #[test]
    fn classes_and_causes_have_their_shares() {
        let group = |name: &str, plausible, count, kept| Group { name: name.into(), plausible, count, kept };
        let names = ["none", "clutter", "mirror"].map(str::to_owned);
        let mut groups = Groups::default();
        groups.name_causes(&names);
        for scored in some() {
            groups.add(&scored, scored.cause.map(|code| names[usize::from(code)].as_str()));
        }
        // Somebody has called it an artifact whose file says nothing of a cause; the class has another number.
        let corrected = Scored { truth: Some((40, false)), ..scored(1.0, 0.0, false, 40, 0) };
        groups.add(&corrected, Some("none"));
        let road = group("road", false, 1, 0);
        assert_eq!(groups.by_class(), [group("outlier", false, 2, 1), group("car", true, 2, 1), road]);
        assert_eq!(groups.by_cause(), [group("clutter", false, 1, 1), group("mirror", false, 1, 0)]);
        assert_eq!(Groups::default().by_cause(), []);
        // People name a cause that no file does.
        groups.name_cause("rain");
        groups.add(&corrected, Some("rain"));
        assert_eq!(groups.by_cause().last(), Some(&group("rain", false, 1, 0)));
    }
}
