//! A tree of boxes around solids, so that a ray asks only those that are near it.

use super::shape::Ray;
use ralf::space::{Point, Vector};

/// Solids in a leaf at most.
const LEAF: usize = 3;

/// An axis-parallel box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Bounds {
    fn joined(self, other: Self) -> Self {
        Self { low: self.low.inf(&other.low), high: self.high.sup(&other.high) }
    }

    /// Whether the ray passes through before `limit`.
    #[inline]
    fn is_crossed(&self, ray: &Ray, inverse: &Vector, limit: f64) -> bool {
        let (mut enter, mut leave) = (0.0_f64, limit);
        for axis in 0..3 {
            let a = (self.low[axis] - ray.origin[axis]) * inverse[axis];
            let b = (self.high[axis] - ray.origin[axis]) * inverse[axis];
            enter = enter.max(a.min(b));
            leave = leave.min(a.max(b));
        }
        enter <= leave
    }
}

#[derive(Debug)]
enum Content {
    /// A range of `order`.
    Leaf(usize, usize),
    /// The first child follows its parent; this is the second.
    Inner(usize),
}

/// The tree.
#[derive(Debug, Default)]
pub(super) struct Tree {
    nodes: Vec<(Bounds, Content)>,
    order: Vec<usize>,
}

impl Tree {
    /// Over boxes, named by their index.
    pub(super) fn new(bounds: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::new(), order: (0..bounds.len()).collect() };
        if !bounds.is_empty() {
            tree.split(bounds, 0, bounds.len());
        }
        tree
    }

    /// Makes the node of a range of `order`: halves by the centres along the longest side.
    fn split(&mut self, bounds: &[Bounds], from: usize, to: usize) {
        let all = self.order[from..to].iter().map(|i| bounds[*i]).reduce(Bounds::joined);
        let Some(all) = all else { return };
        let node = self.nodes.len();
        self.nodes.push((all, Content::Leaf(from, to)));
        if to - from <= LEAF {
            return;
        }
        let axis = (all.high - all.low).imax();
        let center = |i: &usize| bounds[*i].low[axis] + bounds[*i].high[axis];
        self.order[from..to].sort_by(|a, b| center(a).total_cmp(&center(b)).then(a.cmp(b)));
        let middle = from.midpoint(to);
        self.split(bounds, from, middle);
        self.nodes[node].1 = Content::Inner(self.nodes.len());
        self.split(bounds, middle, to);
    }

    /// Visits every box that the ray crosses before a limit, which the visit may lower. The last limit is returned.
    pub(super) fn visit(&self, ray: &Ray, mut limit: f64, mut visit: impl FnMut(usize, f64) -> f64) -> f64 {
        let inverse = ray.direction.map(|value| 1.0 / if value == 0.0 { 1e-300 } else { value });
        // Deep enough for any tree of halves over fewer than 2^32 boxes, and small, for it is cleared for every ray.
        let mut stack = [0_u32; 33];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let node = stack[height] as usize;
            let (bounds, content) = &self.nodes[node];
            if !bounds.is_crossed(ray, &inverse, limit) {
                continue;
            }
            match *content {
                Content::Leaf(from, to) => {
                    for index in &self.order[from..to] {
                        limit = visit(*index, limit);
                    }
                }
                Content::Inner(second) => {
                    stack[height] = second as u32;
                    stack[height + 1] = node as u32 + 1;
                    height += 2;
                }
            }
        }
        limit
    }
}
