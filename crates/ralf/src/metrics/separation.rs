//! What can be said without ground truth (paper, section 2.5; docs/method.md, section 9): how far apart the classes
//! are, and how balanced.

/// Running sums over labelled detections.
///
/// ```
/// use ralf::metrics::Separation;
/// let separation: Separation = [(0.9, true), (0.7, true), (0.2, false)].into_iter().collect();
/// assert!((separation.distinctiveness().unwrap() - 0.6).abs() < 1e-12);
/// assert_eq!(separation.plausible_share(), Some(2.0 / 3.0));
/// ```
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Separation {
    /// Detections labelled plausible.
    pub plausible: u64,
    /// Detections labelled artifact.
    pub artifact: u64,
    plausible_sum: f64,
    artifact_sum: f64,
}

impl Separation {
    /// Counts one detection with its plausibility `w` and its label.
    pub fn add(&mut self, w: f64, labelled_plausible: bool) {
        let (count, sum) = if labelled_plausible {
            (&mut self.plausible, &mut self.plausible_sum)
        } else {
            (&mut self.artifact, &mut self.artifact_sum)
        };
        *count += 1;
        *sum += w;
    }

    /// Mean `w` of what is labelled plausible minus mean `w` of what is labelled artifact; `None` where a class is
    /// empty.
    pub fn distinctiveness(&self) -> Option<f64> {
        let mean = |sum: f64, count: u64| (count > 0).then(|| sum / count as f64);
        Some(mean(self.plausible_sum, self.plausible)? - mean(self.artifact_sum, self.artifact)?)
    }

    /// Class balance: the share of detections labelled plausible; `None` without detections.
    pub fn plausible_share(&self) -> Option<f64> {
        let total = self.plausible + self.artifact;
        (total > 0).then(|| self.plausible as f64 / total as f64)
    }
}

impl FromIterator<(f64, bool)> for Separation {
    fn from_iter<I: IntoIterator<Item = (f64, bool)>>(detections: I) -> Self {
        let mut separation = Self::default();
        for (w, labelled_plausible) in detections {
            separation.add(w, labelled_plausible);
        }
        separation
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_class_has_no_mean() {
        let nothing = Separation::default();
        assert_eq!((nothing.distinctiveness(), nothing.plausible_share()), (None, None));
        let artifacts_only = Separation::from_iter([(0.25, false), (0.0, false)]);
        assert_eq!((artifacts_only.distinctiveness(), artifacts_only.plausible_share()), (None, Some(0.0)));
    }

    #[test]
    fn classes_are_averaged_apart() {
        let found =
            Separation::from_iter([(0.75, true), (0.25, false), (0.5, true), (0.0, false), (0.5, false)]);
        assert_eq!((found.plausible, found.artifact), (2, 3));
        assert_eq!((found.distinctiveness(), found.plausible_share()), (Some(0.625 - 0.25), Some(0.4)));
    }
}
