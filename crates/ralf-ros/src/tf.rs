//! The tree of frames, from the messages of `/tf` and `/tf_static`.
//!
//! A transform `a_from_b` takes coordinates in frame b to frame a. Between two messages positions are interpolated
//! linearly and rotations by slerp; outside their span nothing is known, and this is said, unless somebody knows that
//! the last one holds.

use crate::message::TransformStamped;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use std::collections::BTreeMap;
use thiserror::Error;

/// How far the length of a rotation's quaternion may be from 1: people type them with two digits.
const UNIT_TOLERANCE: f64 = 1e-2;

/// Two places of a frame nearer than this, m and rad, are one. An encoder of twelve bits tells what stands still by
/// steps of 0.088 deg, and so moves the end of a mast of 3 m by 4.6 mm; what 4-byte numbers round is far below.
pub const SAME_PLACE: [f64; 2] = [5e-3, 0.1 * std::f64::consts::PI / 180.0];

/// What is wrong with a tree, or why it doesn't know a transform.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TfError {
    /// A frame without a name.
    #[error("expected the names of two frames, found `{parent}` and `{child}`")]
    Names {
        /// The frame that the message names as the upper one.
        parent: String,
        /// The frame that the message places in it.
        child: String,
    },
    /// Numbers that are no transform.
    #[error("{child} in {parent}: expected finite numbers and a unit quaternion x y z w, found {found}")]
    NoTransform {
        /// The frame that the message names as the upper one.
        parent: String,
        /// The frame that the message places in it.
        child: String,
        /// The numbers.
        found: String,
    },
    /// A frame that hangs on two others.
    #[error("{child}: expected one parent, found {first} and {second}")]
    TwoParents {
        /// The frame.
        child: String,
        /// Its parent, as known before.
        first: String,
        /// The other one.
        second: String,
    },
    /// A transform that is said to never change, and does; or one that is both static and moving.
    #[error("{child} in {parent}: expected a static transform that stays the same, found another one")]
    Changed {
        /// The frame's parent.
        parent: String,
        /// The frame.
        child: String,
    },
    /// A frame that no message speaks of.
    #[error("no frame `{frame}`; known are {known}")]
    Unknown {
        /// The frame asked for.
        frame: String,
        /// Those that exist.
        known: String,
    },
    /// Frames that hang on each other in a circle.
    #[error("the frames above `{frame}` form a circle")]
    Cycle {
        /// Where the way up began.
        frame: String,
    },
    /// Two frames of two trees.
    #[error(
        "nothing connects `{a}`, whose topmost frame is `{root_a}`, with `{b}`, whose topmost frame is `{root_b}`"
    )]
    NotConnected {
        /// A frame asked for.
        a: String,
        /// The other one.
        b: String,
        /// The top of the first one's tree.
        root_a: String,
        /// The top of the second one's tree.
        root_b: String,
    },
    /// A moving transform, asked for at a time of which no message tells.
    #[error("{child} in {parent}: known from {first_ns} to {last_ns} ns, asked for at {t_ns} ns")]
    OutsideSpan {
        /// The frame's parent.
        parent: String,
        /// The frame.
        child: String,
        /// The first message's time.
        first_ns: i64,
        /// The last message's time.
        last_ns: i64,
        /// The time asked for.
        t_ns: i64,
    },
}

/// Frames and how they hang on each other.
#[derive(Debug, Clone, Default)]
pub struct TfTree {
    /// By the name of the child.
    edges: BTreeMap<String, Edge>,
}

#[derive(Debug, Clone)]
struct Edge {
    parent: String,
    parent_from_child: Motion,
}

#[derive(Debug, Clone)]
enum Motion {
    Static(Isometry3<f64>),
    /// In time order, one per time.
    Moving(Vec<(i64, Isometry3<f64>)>),
}

impl Motion {
    /// Whether it was never told to be anywhere else.
    fn stays_at(&self, place: &Isometry3<f64>) -> bool {
        match self {
            Self::Static(known) => is_same_place(known, place),
            Self::Moving(known) => known.iter().all(|(_, known)| is_same_place(known, place)),
        }
    }
}

/// Whether a transform holds for all times.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// From `/tf_static`.
    Static,
    /// From `/tf`.
    Moving,
}

impl TfTree {
    /// Adds a transform. What contradicts the tree is refused, and leaves it as it was.
    pub fn add(&mut self, message: &TransformStamped, kind: Kind) -> Result<(), TfError> {
        let [parent, child] =
            [&message.header.frame_id, &message.child_frame_id].map(|name| frame_name(name));
        if parent.is_empty() || child.is_empty() || parent == child {
            return Err(TfError::Names { parent: parent.to_owned(), child: child.to_owned() });
        }
        let parent_from_child = isometry(message).ok_or_else(|| TfError::NoTransform {
            parent: parent.to_owned(),
            child: child.to_owned(),
            found: format!("{:?}", message.transform),
        })?;
        let edge = self.edges.entry(child.to_owned()).or_insert_with(|| Edge {
            parent: parent.to_owned(),
            parent_from_child: match kind {
                Kind::Static => Motion::Static(parent_from_child),
                Kind::Moving => Motion::Moving(Vec::new()),
            },
        });
        if edge.parent != parent {
            let (first, second) = (edge.parent.clone(), parent.to_owned());
            return Err(TfError::TwoParents { child: child.to_owned(), first, second });
        }
        match (&mut edge.parent_from_child, kind) {
            // Told again, perhaps in other digits, or as what moves by a publisher that knows no other kind.
            (Motion::Static(known), _) if is_same_place(known, &parent_from_child) => {}
            (Motion::Moving(known), Kind::Moving) => {
                insert(known, message.header.stamp_ns, parent_from_child)
            }
            (known, Kind::Static) if known.stays_at(&parent_from_child) => {
                *known = Motion::Static(parent_from_child);
            }
            _ => return Err(TfError::Changed { parent: parent.to_owned(), child: child.to_owned() }),
        }
        Ok(())
    }

    /// The names of all frames, sorted.
    pub fn frames(&self) -> Vec<&str> {
        let names = self.edges.iter().flat_map(|(child, edge)| [child.as_str(), edge.parent.as_str()]);
        let mut names: Vec<&str> = names.collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// `target_from_source` at a time (ns).
    pub fn lookup(&self, target: &str, source: &str, t_ns: i64) -> Result<Isometry3<f64>, TfError> {
        self.chain(target, source)?.at(t_ns)
    }

    /// The transforms from one frame to another.
    pub fn chain<'a>(&'a self, target: &'a str, source: &'a str) -> Result<Chain<'a>, TfError> {
        let [target, source] = [target, source].map(frame_name);
        let (above_target, above_source) = (self.way_up(target)?, self.way_up(source)?);
        let shared = above_target.iter().find(|frame| above_source.contains(frame)).ok_or_else(|| {
            let root = |way: &[&str]| way.last().map_or_else(String::new, |root| (*root).to_owned());
            let (a, b) = (target.to_owned(), source.to_owned());
            TfError::NotConnected { a, b, root_a: root(&above_target), root_b: root(&above_source) }
        })?;
        let below_shared = |way: &[&'a str]| {
            let below = way.iter().take_while(|frame| *frame != shared);
            below.filter_map(|child| Some((*child, self.edges.get(*child)?))).collect()
        };
        Ok(Chain { target: below_shared(&above_target), source: below_shared(&above_source) })
    }

    /// The frame itself, its parent, and so on up to the topmost one.
    fn way_up<'a>(&'a self, frame: &'a str) -> Result<Vec<&'a str>, TfError> {
        let mut way = vec![frame];
        let mut at = frame;
        while let Some(edge) = self.edges.get(at) {
            at = &edge.parent;
            way.push(at);
            if way.len() > self.edges.len() + 1 {
                return Err(TfError::Cycle { frame: frame.to_owned() });
            }
        }
        if way.len() == 1 && !self.edges.values().any(|edge| edge.parent == frame) {
            let frames = self.frames();
            let known = if frames.is_empty() { "none".to_owned() } else { frames.join(", ") };
            return Err(TfError::Unknown { frame: frame.to_owned(), known });
        }
        Ok(way)
    }
}

/// The transforms that lie between two frames: each with its child, from either end up to the frame that both hang on.
#[derive(Debug, Clone)]
pub struct Chain<'a> {
    target: Vec<(&'a str, &'a Edge)>,
    source: Vec<(&'a str, &'a Edge)>,
}

impl<'a> Chain<'a> {
    /// `target_from_source` at a time (ns).
    pub fn at(&self, t_ns: i64) -> Result<Isometry3<f64>, TfError> {
        self.edges().try_for_each(|(child, edge)| edge.check_known(child, t_ns))?;
        Ok(self.held_at(t_ns))
    }

    /// The same, where each transform is held before its first message and after its last.
    pub fn held_at(&self, t_ns: i64) -> Isometry3<f64> {
        let shared_from = |edges: &[(&str, &Edge)]| {
            edges.iter().fold(Isometry3::identity(), |below, (_, edge)| edge.held_at(t_ns) * below)
        };
        shared_from(&self.target).inv_mul(&shared_from(&self.source))
    }

    /// The frames whose places it goes by.
    pub fn frames(&self) -> impl Iterator<Item = &'a str> {
        self.edges().map(|(child, _)| child)
    }

    /// When messages tell of it, in time order: those within a span (ns), if all its transforms are known over the
    /// whole span, else all.
    pub fn told(&self, [first, last]: [i64; 2]) -> Vec<i64> {
        let moving = || {
            self.edges().filter_map(|(_, edge)| match &edge.parent_from_child {
                Motion::Static(_) => None,
                Motion::Moving(known) => Some(known),
            })
        };
        let is_within = |t_ns: i64| (first..=last).contains(&t_ns);
        let is_covered = self.edges().all(|(_, edge)| edge.covers(first) && edge.covers(last));
        let times = moving().flatten().map(|(t_ns, _)| *t_ns);
        let mut times: Vec<i64> = times.filter(|t_ns| !is_covered || is_within(*t_ns)).collect();
        times.sort_unstable();
        times.dedup();
        times
    }

    fn edges(&self) -> impl Iterator<Item = (&'a str, &'a Edge)> {
        self.target.iter().chain(&self.source).copied()
    }
}

impl Edge {
    /// Whether messages tell it at this time, or around it.
    fn covers(&self, t_ns: i64) -> bool {
        match &self.parent_from_child {
            Motion::Static(_) => true,
            Motion::Moving(known) => {
                let span = known.first().zip(known.last());
                span.is_some_and(|((first, _), (last, _))| (*first..=*last).contains(&t_ns))
            }
        }
    }

    fn check_known(&self, child: &str, t_ns: i64) -> Result<(), TfError> {
        let known = match &self.parent_from_child {
            Motion::Moving(known) if !self.covers(t_ns) => known,
            _ => return Ok(()),
        };
        Err(TfError::OutsideSpan {
            parent: self.parent.clone(),
            child: child.to_owned(),
            first_ns: known.first().map_or(0, |(t, _)| *t),
            last_ns: known.last().map_or(0, |(t, _)| *t),
            t_ns,
        })
    }

    fn held_at(&self, t_ns: i64) -> Isometry3<f64> {
        let known = match &self.parent_from_child {
            Motion::Static(parent_from_child) => return *parent_from_child,
            Motion::Moving(known) => known,
        };
        let after = known.partition_point(|(t, _)| *t < t_ns);
        match (after.checked_sub(1).map(|before| known[before]), known.get(after)) {
            (_, Some((t, exactly))) if *t == t_ns => *exactly,
            (Some((t0, a)), Some((t1, b))) => interpolate(&a, b, (t_ns - t0) as f64 / (t1 - t0) as f64),
            (Some((_, only)), None) => only,
            (None, Some((_, only))) => *only,
            (None, None) => Isometry3::identity(),
        }
    }
}

/// Whether two places of a frame are one, by [`SAME_PLACE`].
pub fn is_same_place(a: &Isometry3<f64>, b: &Isometry3<f64>) -> bool {
    let [metres, radians] = SAME_PLACE;
    (a.translation.vector - b.translation.vector).norm() <= metres
        && a.rotation.angle_to(&b.rotation) <= radians
}

/// Early versions of ROS wrote a slash before the names of frames.
fn frame_name(name: &str) -> &str {
    name.strip_prefix('/').unwrap_or(name)
}

/// In time order; of two at one time the later one counts.
fn insert(known: &mut Vec<(i64, Isometry3<f64>)>, t_ns: i64, parent_from_child: Isometry3<f64>) {
    let place = known.partition_point(|(t, _)| *t < t_ns);
    match known.get_mut(place) {
        Some((t, transform)) if *t == t_ns => *transform = parent_from_child,
        _ => known.insert(place, (t_ns, parent_from_child)),
    }
}

fn isometry(message: &TransformStamped) -> Option<Isometry3<f64>> {
    let ([x, y, z], [i, j, k, w]) = (message.transform.position, message.transform.orientation);
    let rotation = Quaternion::new(w, i, j, k);
    let unit = (rotation.norm() - 1.0).abs() <= UNIT_TOLERANCE;
    (unit && [x, y, z].into_iter().all(f64::is_finite))
        .then(|| Isometry3::from_parts(Translation3::new(x, y, z), UnitQuaternion::new_normalize(rotation)))
}

fn interpolate(a: &Isometry3<f64>, b: &Isometry3<f64>, share: f64) -> Isometry3<f64> {
    let position = a.translation.vector.lerp(&b.translation.vector, share);
    // Opposite rotations have no shortest way; either end is then as good.
    let rotation = a.rotation.try_slerp(&b.rotation, share, 1e-12).unwrap_or(a.rotation);
    Isometry3::from_parts(Translation3::from(position), rotation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::message::{Header, Pose};
    use nalgebra::Point3;
    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

    /// A child in its parent: its origin, and how far it is turned about z.
    fn stamped(parent: &str, child: &str, t_ns: i64, position: [f64; 3], yaw: f64) -> TransformStamped {
        let header = Header { stamp_ns: t_ns, frame_id: parent.to_owned(), ..Header::default() };
        let orientation = [0.0, 0.0, (yaw / 2.0).sin(), (yaw / 2.0).cos()];
        TransformStamped {
            header,
            child_frame_id: child.to_owned(),
            transform: Pose { position, orientation },
        }
    }

    fn tree(transforms: &[(TransformStamped, Kind)]) -> TfTree {
        let mut tree = TfTree::default();
        transforms.iter().for_each(|(transform, kind)| tree.add(transform, *kind).unwrap());
        tree
    }

    /// odom -> base moves, base -> mast -> radar and base -> lidar stay.
    fn vehicle() -> TfTree {
        tree(&[
            (stamped("odom", "base", 100, [10.0, 0.0, 0.0], 0.0), Kind::Moving),
            (stamped("odom", "base", 0, [0.0, 0.0, 0.0], 0.0), Kind::Moving),
            (stamped("odom", "base", 200, [10.0, 10.0, 0.0], FRAC_PI_2), Kind::Moving),
            (stamped("base", "mast", 0, [1.0, 0.0, 2.0], FRAC_PI_2), Kind::Static),
            (stamped("/mast", "/radar", 0, [0.5, 0.0, 0.0], 0.0), Kind::Static),
            (stamped("base", "lidar", 0, [0.0, -1.0, 0.0], 0.0), Kind::Static),
        ])
    }

    fn close(transform: &Isometry3<f64>, point: [f64; 3], expected: [f64; 3]) {
        let found = transform * Point3::from(point);
        assert!((found - Point3::from(expected)).norm() < 1e-12, "{found} instead of {expected:?}");
    }

    #[test]
    fn frames_are_looked_up_both_ways_and_across() {
        let tree = vehicle();
        // The mast looks to the left: 0.5 m along its x is 0.5 m to the vehicle's left.
        close(&tree.lookup("base", "radar", 0).unwrap(), [0.0; 3], [1.0, 0.5, 2.0]);
        close(&tree.lookup("base", "radar", 0).unwrap(), [1.0, 0.0, 0.0], [1.0, 1.5, 2.0]);
        close(&tree.lookup("radar", "base", 0).unwrap(), [1.0, 0.5, 2.0], [0.0; 3]);
        // From branch to branch: the LiDAR's origin is (0, -1, 0), which the radar has at (-1.5, 1, -2).
        close(&tree.lookup("radar", "lidar", 0).unwrap(), [0.0; 3], [-1.5, 1.0, -2.0]);
        assert_eq!(tree.lookup("base", "base", 0), Ok(Isometry3::identity()));
        assert_eq!(tree.frames(), ["base", "lidar", "mast", "odom", "radar"]);
    }

    #[test]
    fn moving_frames_are_interpolated() {
        let tree = vehicle();
        close(&tree.lookup("odom", "base", 50).unwrap(), [0.0; 3], [5.0, 0.0, 0.0]);
        close(&tree.lookup("odom", "base", 100).unwrap(), [0.0; 3], [10.0, 0.0, 0.0]);
        // Halfway into the turn: at (10, 5), looking 45 degrees to the left.
        let ahead = [10.0 + FRAC_1_SQRT_2, 5.0 + FRAC_1_SQRT_2, 0.0];
        close(&tree.lookup("odom", "base", 150).unwrap(), [1.0, 0.0, 0.0], ahead);
        let error = tree.lookup("odom", "radar", 201).unwrap_err();
        assert_eq!(error.to_string(), "base in odom: known from 0 to 200 ns, asked for at 201 ns");
        assert!(tree.lookup("odom", "base", -1).is_err() && tree.lookup("base", "radar", -1).is_ok());
    }

    /// A mast that turns on a base that moves, of which only a part of the drive is told.
    #[test]
    fn what_is_told_of_a_chain_is_held_beyond() {
        let mut tree = vehicle();
        for (t_ns, yaw) in [(20, 0.0), (60, 0.0), (80, 0.5)] {
            tree.add(&stamped("mast", "sonar", t_ns, [0.0; 3], yaw), Kind::Moving).unwrap();
        }
        let chain = tree.chain("base", "/sonar").unwrap();
        assert_eq!(chain.frames().collect::<Vec<_>>(), ["sonar", "mast"]);
        assert_eq!((chain.told([30, 70]), chain.told([20, 60])), (vec![60], vec![20, 60]));
        assert_eq!(chain.told([0, 40]), [20, 60, 80], "it isn't known at 0");
        assert_eq!((chain.held_at(-9), chain.held_at(99)), (chain.at(20).unwrap(), chain.at(80).unwrap()));
        assert!(chain.at(19).is_err() && chain.at(81).is_err());
        assert!(is_same_place(&chain.held_at(0), &chain.held_at(60)));
        assert!(!is_same_place(&chain.held_at(0), &chain.held_at(80)));
        assert_eq!(tree.chain("base", "lidar").unwrap().told([0, 40]), [0; 0]);
        // By its other quaternion, as 4-byte numbers hold it, and by a step of an encoder.
        let place = |x: f64, yaw: f64, sign: f64| {
            let turn = Quaternion::new(yaw.cos(), 0.0, 0.0, yaw.sin()) * sign;
            Isometry3::from_parts(Translation3::new(x, 0.0, 0.0), UnitQuaternion::new_normalize(turn))
        };
        let same = |x: f64, yaw: f64, sign: f64| is_same_place(&place(3.6, 0.3, 1.0), &place(x, yaw, sign));
        assert!(same(3.6, 0.3, -1.0) && same(f64::from(3.6_f32), f64::from(0.3_f32), 1.0));
        assert!(same(3.6046, 0.3 + 4e-4, 1.0) && !same(3.606, 0.3, 1.0) && !same(3.6, 0.301, 1.0));
    }

    #[test]
    fn circles_and_unknown_frames_are_told() {
        let mut tree = vehicle();
        let error = tree.lookup("base", "sonar", 0).unwrap_err().to_string();
        assert_eq!(error, "no frame `sonar`; known are base, lidar, mast, odom, radar");
        tree.add(&stamped("island", "palm", 0, [0.0; 3], 0.0), Kind::Static).unwrap();
        let error = tree.lookup("base", "palm", 0).unwrap_err().to_string();
        assert!(error.contains("nothing connects `base`") && error.contains("`island`"), "{error}");
        tree.add(&stamped("palm", "island", 0, [0.0; 3], 0.0), Kind::Static).unwrap();
        assert_eq!(tree.lookup("palm", "island", 0), Err(TfError::Cycle { frame: "palm".to_owned() }));
        assert!(tree.lookup("base", "island", 0).is_err());
    }

    #[test]
    fn contradictions_are_refused() {
        let mut tree = vehicle();
        let mut add = |transform, kind| tree.add(&transform, kind).map_err(|error| error.to_string());
        for (y, yaw) in [(-1.0, 0.0), (-1.000_000_02, 1e-8), (-1.0, std::f64::consts::TAU)] {
            assert_eq!(add(stamped("base", "lidar", 9, [0.0, y, 0.0], yaw), Kind::Static), Ok(()));
        }
        let error = add(stamped("base", "lidar", 9, [0.0, -2.0, 0.0], 0.0), Kind::Static).unwrap_err();
        assert!(error.contains("lidar in base"), "{error}");
        assert!(add(stamped("base", "lidar", 9, [0.0, -1.5, 0.0], 0.0), Kind::Moving).is_err());
        let error = add(stamped("mast", "lidar", 0, [0.0, -1.0, 0.0], 0.0), Kind::Static).unwrap_err();
        assert_eq!(error, "lidar: expected one parent, found base and mast");
        assert!(add(stamped("base", "base", 0, [0.0; 3], 0.0), Kind::Static).is_err());
        assert!(add(stamped("base", "", 0, [0.0; 3], 0.0), Kind::Static).is_err());
        assert!(add(stamped("base", "new", 0, [f64::NAN, 0.0, 0.0], 0.0), Kind::Static).is_err());
        let mut unturned = stamped("base", "new", 0, [0.0; 3], 0.0);
        unturned.transform.orientation = [0.0; 4];
        assert!(add(unturned, Kind::Static).unwrap_err().contains("unit quaternion"));
        assert!(!tree.frames().contains(&"new"));
    }

    #[test]
    fn what_stays_may_be_told_on_either_topic() {
        let mut tree = TfTree::default();
        let mut add =
            |x: f64, t_ns, kind| tree.add(&stamped("base", "radar", t_ns, [x, 0.0, 0.0], 0.0), kind);
        for (x, t_ns, kind) in [(3.0, 5, Kind::Moving), (3.001, 9, Kind::Moving), (3.0, 0, Kind::Static)] {
            assert_eq!(add(x, t_ns, kind), Ok(()));
        }
        assert_eq!(add(3.0, 12, Kind::Moving), Ok(()));
        assert!(add(3.1, 13, Kind::Moving).is_err(), "it was said to be static");
        close(&tree.lookup("base", "radar", -7).unwrap(), [0.0; 3], [3.0, 0.0, 0.0]);
        let mut moved = tree_of_a_moving_radar();
        assert!(moved.add(&stamped("base", "radar", 0, [3.0, 0.0, 0.0], 0.0), Kind::Static).is_err());
        let error = moved.lookup("base", "radar", 0).unwrap_err().to_string();
        assert!(error.contains("known from 5 to 9 ns"), "what was refused changes nothing: {error}");
    }

    fn tree_of_a_moving_radar() -> TfTree {
        tree(&[5, 9].map(|t_ns| (stamped("base", "radar", t_ns, [t_ns as f64, 0.0, 0.0], 0.0), Kind::Moving)))
    }

    #[test]
    fn rotations_typed_with_two_digits_are_turned_right() {
        let mut by_hand = stamped("base", "radar", 0, [0.0; 3], 0.0);
        by_hand.transform.orientation = [0.0, 0.0, 0.71, 0.71];
        let mut tree = TfTree::default();
        tree.add(&by_hand, Kind::Static).unwrap();
        close(&tree.lookup("base", "radar", 0).unwrap(), [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
    }
}
