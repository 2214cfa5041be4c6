//! What a label says: SemanticKITTI's classes and the paper's clusters of them (paper, table 5; docs/method.md, section
//! 11).

/// Nobody has said anything of this detection.
pub const UNLABELED: u16 = 0;
/// An artifact; SemanticKITTI's "outlier".
pub const ARTIFACT: u16 = 1;
/// Plausible, of no known class; SemanticKITTI's "other-object".
pub const PLAUSIBLE: u16 = 99;

/// The paper's consolidation of SemanticKITTI's classes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Cluster {
    /// Cars, trucks, buses and two-wheelers.
    Vehicle,
    /// People, riding ones too.
    Human,
    /// Buildings and fences.
    Construction,
    /// Vegetation, trunks and terrain (the paper keeps grass as plausible).
    Vegetation,
    /// Poles and traffic signs.
    Poles,
    /// Outliers and everything that is driven or walked on.
    Artifact,
}

impl Cluster {
    /// All of them, in the order of the paper's table.
    pub const ALL: [Self; 6] =
        [Self::Vehicle, Self::Human, Self::Construction, Self::Vegetation, Self::Poles, Self::Artifact];

    /// A name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Vehicle => "vehicle",
            Self::Human => "human",
            Self::Construction => "construction",
            Self::Vegetation => "vegetation",
            Self::Poles => "poles",
            Self::Artifact => "artifact",
        }
    }
}

/// One class: its SemanticKITTI id, its name there, and its cluster.
type Class = (u16, &'static str, Option<Cluster>);

/// SemanticKITTI's classes by ascending id. The paper's table has no cluster for rail vehicles, other structures and
/// other objects; its "sky" and "traffic light" have no id.
const CLASSES: [Class; 34] = [
    (UNLABELED, "unlabeled", None),
    (ARTIFACT, "outlier", Some(Cluster::Artifact)),
    (10, "car", Some(Cluster::Vehicle)),
    (11, "bicycle", Some(Cluster::Vehicle)),
    (13, "bus", Some(Cluster::Vehicle)),
    (15, "motorcycle", Some(Cluster::Vehicle)),
    (16, "on-rails", None),
    (18, "truck", Some(Cluster::Vehicle)),
    (20, "other-vehicle", Some(Cluster::Vehicle)),
    (30, "person", Some(Cluster::Human)),
    (31, "bicyclist", Some(Cluster::Human)),
    (32, "motorcyclist", Some(Cluster::Human)),
    (40, "road", Some(Cluster::Artifact)),
    (44, "parking", Some(Cluster::Artifact)),
    (48, "sidewalk", Some(Cluster::Artifact)),
    (49, "other-ground", Some(Cluster::Artifact)),
    (50, "building", Some(Cluster::Construction)),
    (51, "fence", Some(Cluster::Construction)),
    (52, "other-structure", None),
    (60, "lane-marking", Some(Cluster::Artifact)),
    (70, "vegetation", Some(Cluster::Vegetation)),
    (71, "trunk", Some(Cluster::Vegetation)),
    (72, "terrain", Some(Cluster::Vegetation)),
    (80, "pole", Some(Cluster::Poles)),
    (81, "traffic-sign", Some(Cluster::Poles)),
    (PLAUSIBLE, "other-object", None),
    (252, "moving-car", Some(Cluster::Vehicle)),
    (253, "moving-bicyclist", Some(Cluster::Human)),
    (254, "moving-person", Some(Cluster::Human)),
    (255, "moving-motorcyclist", Some(Cluster::Human)),
    (256, "moving-on-rails", None),
    (257, "moving-bus", Some(Cluster::Vehicle)),
    (258, "moving-truck", Some(Cluster::Vehicle)),
    (259, "moving-other-vehicle", Some(Cluster::Vehicle)),
];

fn class_of(id: u16) -> Option<&'static Class> {
    CLASSES.binary_search_by_key(&id, |class| class.0).ok().map(|place| &CLASSES[place])
}

/// The name of a SemanticKITTI class; `None` for an id that SemanticKITTI doesn't have.
pub fn class_name(id: u16) -> Option<&'static str> {
    class_of(id).map(|class| class.1)
}

/// The paper's cluster of a SemanticKITTI id; `None` where its table has none.
pub fn cluster_of(id: u16) -> Option<Cluster> {
    class_of(id).and_then(|class| class.2)
}

/// What a label says of plausibility: `None` where it is [`UNLABELED`], `Some(false)` for the artifact cluster,
/// `Some(true)` for any other id, known or not.
///
/// ```
/// use ralf::label::{ARTIFACT, PLAUSIBLE, UNLABELED, truth_of};
/// let (car, road) = (10, 40);
/// assert_eq!([PLAUSIBLE, car].map(truth_of), [Some(true); 2]);
/// assert_eq!([ARTIFACT, road].map(truth_of), [Some(false); 2]);
/// assert_eq!(truth_of(UNLABELED), None);
/// ```
pub fn truth_of(id: u16) -> Option<bool> {
    (id != UNLABELED).then(|| cluster_of(id) != Some(Cluster::Artifact))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_classes_are_sorted_for_the_search() {
        assert!(CLASSES.is_sorted_by(|a, b| a.0 < b.0));
        assert!(CLASSES.iter().all(|class| class_name(class.0) == Some(class.1)));
    }

    #[test]
    fn moving_classes_go_with_their_static_ones() {
        for (_, name, cluster) in CLASSES {
            let still = name.strip_prefix("moving-").unwrap_or(name);
            let of_still = CLASSES.iter().find(|class| class.1 == still).unwrap();
            assert_eq!(cluster, of_still.2, "{name}");
        }
    }

    #[test]
    fn exactly_the_outlier_and_the_five_grounds_are_artifacts() {
        let artifacts: Vec<u16> = (0..=u16::MAX).filter(|id| truth_of(*id) == Some(false)).collect();
        assert_eq!(artifacts, [1, 40, 44, 48, 49, 60]);
        let silent: Vec<u16> = (0..=u16::MAX).filter(|id| truth_of(*id).is_none()).collect();
        assert_eq!(silent, [UNLABELED]);
    }

    #[test]
    fn every_cluster_of_the_paper_has_its_classes() {
        let ids = |cluster| -> Vec<u16> { (0..250).filter(|id| cluster_of(*id) == Some(cluster)).collect() };
        let expected: [&[u16]; 6] = [
            &[10, 11, 13, 15, 18, 20],
            &[30, 31, 32],
            &[50, 51],
            &[70, 71, 72],
            &[80, 81],
            &[1, 40, 44, 48, 49, 60],
        ];
        for (cluster, expected) in Cluster::ALL.into_iter().zip(expected) {
            assert_eq!(ids(cluster), expected, "{}", cluster.name());
        }
        assert_eq!((class_name(7), cluster_of(7), truth_of(7)), (None, None, Some(true)));
    }
}
