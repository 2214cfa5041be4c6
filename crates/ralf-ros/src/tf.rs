//! The tree of frames, from the messages of `/tf` and `/tf_static`.
//!
//! A transform `a_from_b` takes coordinates in frame b to frame a. Between two messages positions are interpolated linearly
//! and rotations by slerp; outside their span nothing is known, and this is said.

use crate::message::TransformStamped;
use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use std::collections::BTreeMap;
use thiserror::Error;

/// How far the length of a rotation's quaternion may be from 1.
const UNIT_TOLERANCE: f64 = 1e-3;

/// What is wrong with a tree, or why it doesn't know a transform.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TfError {
    /// A frame without a name.
    #[error("expected the names of two frames, found `{parent}` and `{child}`")]
    Names {
        /// Of the message.
        parent: String,
        /// Of the message.
        child: String,
    },
    /// Numbers that are no transform.
    #[error("{child} in {parent}: expected finite numbers and a unit quaternion x y z w, found {found}")]
    NoTransform {
        /// Of the message.
        parent: String,
        /// Of the message.
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
            (Motion::Static(known), Kind::Static) if *known == parent_from_child => {}
            (Motion::Moving(known), Kind::Moving) => {
                insert(known, message.header.stamp_ns, parent_from_child)
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
        let [target, source] = [target, source].map(frame_name);
        let (above_target, above_source) = (self.way_up(target)?, self.way_up(source)?);
        let shared = above_target.iter().find(|frame| above_source.contains(frame)).ok_or_else(|| {
            let root = |way: &[&str]| way.last().map_or_else(String::new, |root| (*root).to_owned());
            let (a, b) = (target.to_owned(), source.to_owned());
            TfError::NotConnected { a, b, root_a: root(&above_target), root_b: root(&above_source) }
        })?;
        let shared_from_target = self.down_from(shared, &above_target, t_ns)?;
        let shared_from_source = self.down_from(shared, &above_source, t_ns)?;
        Ok(shared_from_target.inv_mul(&shared_from_source))
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
            let known = self.frames().join(", ");
            return Err(TfError::Unknown { frame: frame.to_owned(), known });
        }
        Ok(way)
    }

    /// `top_from_frame` of the frame at which the way up begins.
    fn down_from(&self, top: &str, way: &[&str], t_ns: i64) -> Result<Isometry3<f64>, TfError> {
        let mut top_from_frame = Isometry3::identity();
        for child in way.iter().take_while(|frame| **frame != top) {
            if let Some(edge) = self.edges.get(*child) {
                top_from_frame = edge.at(child, t_ns)? * top_from_frame;
            }
        }
        Ok(top_from_frame)
    }
}

impl Edge {
    fn at(&self, child: &str, t_ns: i64) -> Result<Isometry3<f64>, TfError> {
        let known = match &self.parent_from_child {
            Motion::Static(parent_from_child) => return Ok(*parent_from_child),
            Motion::Moving(known) => known,
        };
        let after = known.partition_point(|(t, _)| *t < t_ns);
        match (after.checked_sub(1).map(|before| known[before]), known.get(after)) {
            (_, Some((t, exactly))) if *t == t_ns => Ok(*exactly),
            (Some((t0, a)), Some((t1, b))) => Ok(interpolate(&a, b, (t_ns - t0) as f64 / (t1 - t0) as f64)),
            _ => Err(TfError::OutsideSpan {
                parent: self.parent.clone(),
                child: child.to_owned(),
                first_ns: known.first().map_or(0, |(t, _)| *t),
                last_ns: known.last().map_or(0, |(t, _)| *t),
                t_ns,
            }),
        }
    }
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
