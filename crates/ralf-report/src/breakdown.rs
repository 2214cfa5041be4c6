//! Where the errors are: over range and azimuth, by class and by cause.

use crate::scored::{Detections, Scored};
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

impl Profile {
    /// Over the range, m.
    pub(crate) fn over_range(detections: &Detections) -> Self {
        let farthest = detections.with_truth().map(|(scored, _)| f64::from(scored.range)).fold(0.0, f64::max);
        // About 20 bins of a width that people like.
        let step =
            [1.0, 2.0, 5.0, 10.0, 20.0].into_iter().find(|step| farthest / step <= 20.0).unwrap_or(50.0);
        Self::of(detections, 0.0, step, farthest, |scored| scored.range.into())
    }

    /// Over the azimuth in the radar's frame, degrees.
    pub(crate) fn over_azimuth(detections: &Detections) -> Self {
        let step = 10.0;
        let of = |scored: &Scored| f64::from(scored.azimuth).to_degrees();
        let widest =
            detections.with_truth().map(|(scored, _)| of(scored).abs()).fold(step, f64::max).min(180.0);
        let edge = (widest / step).ceil() * step;
        Self::of(detections, -edge, step, edge, of)
    }

    fn of(detections: &Detections, first: f64, step: f64, last: f64, of: impl Fn(&Scored) -> f64) -> Self {
        let count = (((last - first) / step).ceil() as usize).max(1);
        let mut bins = vec![Confusion::default(); count];
        for (scored, truth) in detections.with_truth().filter(|(scored, _)| of(scored).is_finite()) {
            let bin = (((of(scored) - first) / step) as usize).min(count - 1);
            bins[bin].add(truth, scored.plausible);
        }
        Self { first, step, bins }
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

/// By the class that the truth gives, in the order of their ids.
pub(crate) fn by_class(detections: &Detections) -> Vec<Group> {
    let of = |scored: &Scored| scored.truth.map(|(class, plausible)| (usize::from(class), plausible));
    let name = |id: usize| {
        let known = u16::try_from(id).ok().and_then(class_name);
        known.map_or_else(|| format!("class {id}"), str::to_owned)
    };
    grouped(detections, of, name)
}

/// Artifacts by cause, in the order of their codes; empty where causes aren't known.
pub(crate) fn by_cause(detections: &Detections) -> Vec<Group> {
    let of = |scored: &Scored| {
        scored.truth.filter(|(_, plausible)| !plausible).and(scored.cause).map(|cause| (cause, false))
    };
    grouped(detections, of, |cause| detections.causes[cause].clone())
}

fn grouped(
    detections: &Detections,
    of: impl Fn(&Scored) -> Option<(usize, bool)>,
    name: impl Fn(usize) -> String,
) -> Vec<Group> {
    let mut counts = BTreeMap::<(usize, bool), [u64; 2]>::new();
    for scored in &detections.all {
        if let Some(key) = of(scored) {
            let entry = counts.entry(key).or_default();
            *entry = [entry[0] + 1, entry[1] + u64::from(scored.plausible)];
        }
    }
    let group = |((key, plausible), [count, kept]): ((usize, bool), [u64; 2])| Group {
        name: name(key),
        plausible,
        count,
        kept,
    };
    counts.into_iter().map(group).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(range: f32, azimuth: f32, plausible: bool, class: u16, cause: usize) -> Scored {
        let (w_opt, w_tr, w, gamma) = (1.0, 1.0, 1.0, 1.0);
        let truth = ralf::label::truth_of(class).map(|truth| (class, truth));
        Scored { range, azimuth, w_opt, w_tr, w, gamma, plausible, flags: 0, truth, cause: Some(cause) }
    }

    fn some() -> Detections {
        let all = vec![
            scored(3.0, -0.5, true, 10, 0),
            scored(3.5, 0.5, false, 10, 0),
            scored(17.0, 0.0, true, 1, 1),
            scored(17.0, 0.0, false, 1, 2),
            scored(17.0, f32::NAN, false, 0, 2),
        ];
        Detections { all, causes: ["none", "clutter", "mirror"].map(str::to_owned).to_vec() }
    }

    #[test]
    fn errors_are_counted_where_they_are() {
        let found = Profile::over_range(&some());
        assert_eq!((found.step, found.bins.len()), (1.0, 17));
        assert_eq!(found.bins[3], Confusion { tp: 1, fp: 0, tn: 0, r#fn: 1 });
        assert_eq!(found.bins[16], Confusion { tp: 0, fp: 1, tn: 1, r#fn: 0 });
        let found = Profile::over_azimuth(&some());
        // 0.5 rad is 28.6 deg: from -30 to 30.
        assert_eq!((found.first, found.bins.len()), (-30.0, 6));
        assert_eq!((found.bins[0].tp, found.bins[5].r#fn, found.bins[3].total()), (1, 1, 2));
    }

    #[test]
    fn classes_and_causes_have_their_shares() {
        let group = |name: &str, plausible, count, kept| Group { name: name.into(), plausible, count, kept };
        assert_eq!(by_class(&some()), [group("outlier", false, 2, 1), group("car", true, 2, 1)]);
        assert_eq!(by_cause(&some()), [group("clutter", false, 1, 1), group("mirror", false, 1, 0)]);
        assert_eq!(by_cause(&Detections::default()), []);
    }
}
