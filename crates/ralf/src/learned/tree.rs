//! A decision tree: questions about one feature each, and a number at every end.

use thiserror::Error;

/// Most nodes that a tree may have: a file from outside can't ask for more than its size lets expect.
const MOST_NODES: usize = 2 * Tree::MOST_LEAVES - 1;

/// A question: is the feature at most the threshold? Yes leads to the next node, no to the node `right`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// The feature's place in the row.
    pub feature: u16,
    /// Compared with the feature.
    pub threshold: f32,
    /// Whether a feature that was not observed counts as yes.
    pub absent_is_yes: bool,
    /// Where no leads to.
    pub right: u16,
}

/// An end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Leaf {
    /// What the tree answers, log odds.
    pub value: f32,
    /// Weight of the training rows that came here.
    pub cover: f32,
}

/// A node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Node {
    /// A question.
    Split(Split),
    /// An end.
    Leaf(Leaf),
}

/// Nodes in preorder: after a question come the nodes of its yes, then those of its no.
#[derive(Debug, Clone, PartialEq)]
pub struct Tree {
    nodes: Vec<Node>,
}

/// Why nodes are no tree.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
pub enum TreeError {
    /// Some question lacks one of its answers, or there are nodes that no question leads to.
    #[error("expected a whole tree in preorder, found one that breaks off or goes on behind its end")]
    Shape,
    /// More than [`Tree::MOST_LEAVES`] allow.
    #[error("expected at most {MOST_NODES} nodes")]
    TooLarge,
    /// A threshold, value or cover that is infinite, not a number, or a cover below 0.
    #[error("expected finite numbers")]
    NotFinite,
}

impl Split {
    /// Whether a row of features gets a yes.
    pub fn is_yes(&self, row: &[f32]) -> bool {
        let value = row[usize::from(self.feature)];
        if value.is_nan() { self.absent_is_yes } else { value <= self.threshold }
    }
}

impl Tree {
    /// Most leaves of a tree.
    pub const MOST_LEAVES: usize = 256;

    /// A tree of nodes in preorder. Where the questions' `right` lead follows from the order, and is set.
    ///
    /// # Errors
    /// Nodes that are no whole tree, too many of them, or numbers that are not finite.
    pub fn new(mut nodes: Vec<Node>) -> Result<Self, TreeError> {
        if nodes.len() > MOST_NODES {
            return Err(TreeError::TooLarge);
        }
        let finite = nodes.iter().all(|node| match node {
            Node::Split(split) => split.threshold.is_finite(),
            Node::Leaf(leaf) => leaf.value.is_finite() && leaf.cover.is_finite() && leaf.cover >= 0.0,
        });
        if !finite {
            return Err(TreeError::NotFinite);
        }
        // Questions whose no has not begun yet.
        let mut open: Vec<usize> = Vec::new();
        for at in 0..nodes.len() {
            if matches!(nodes[at], Node::Split(_)) {
                open.push(at);
                continue;
            }
            let last = at + 1 == nodes.len();
            match open.pop() {
                None if last => return Ok(Self { nodes }),
                Some(question) if !last => {
                    if let Node::Split(split) = &mut nodes[question] {
                        split.right = (at + 1) as u16;
                    }
                }
                _ => return Err(TreeError::Shape),
            }
        }
        Err(TreeError::Shape)
    }

    /// A tree that answers 0 to everything.
    pub fn none() -> Self {
        Self { nodes: vec![Node::Leaf(Leaf { value: 0.0, cover: 0.0 })] }
    }

    /// The nodes.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The largest place of a feature that is asked for, and 1 more; 0 for a tree without questions.
    pub fn width(&self) -> usize {
        let questions = self.nodes.iter().filter_map(|node| match node {
            Node::Split(split) => Some(usize::from(split.feature) + 1),
            Node::Leaf(_) => None,
        });
        questions.max().unwrap_or(0)
    }

    /// What the tree answers to a row of features.
    pub fn answer(&self, row: &[f32]) -> f32 {
        let mut at = 0;
        loop {
            match &self.nodes[at] {
                Node::Split(split) if split.is_yes(row) => at += 1,
                Node::Split(split) => at = usize::from(split.right),
                Node::Leaf(leaf) => return leaf.value,
            }
        }
    }

    /// The question before each node; of the first one itself.
    pub(super) fn parents(&self) -> Vec<usize> {
        let mut parents = vec![0; self.nodes.len()];
        for (at, node) in self.nodes.iter().enumerate() {
            if let Node::Split(split) = node {
                (parents[at + 1], parents[usize::from(split.right)]) = (at, at);
            }
        }
        parents
    }

    /// The cover of every node: what came to its leaves.
    pub fn covers(&self) -> Vec<f64> {
        let mut covers = vec![0.0; self.nodes.len()];
        for at in (0..self.nodes.len()).rev() {
            covers[at] = match &self.nodes[at] {
                Node::Split(split) => covers[at + 1] + covers[usize::from(split.right)],
                Node::Leaf(leaf) => f64::from(leaf.cover),
            };
        }
        covers
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use rand::RngExt;

    pub(in crate::learned) fn split(feature: u16, threshold: f32, absent_is_yes: bool) -> Node {
        Node::Split(Split { feature, threshold, absent_is_yes, right: 0 })
    }

    pub(in crate::learned) fn leaf(value: f32, cover: f32) -> Node {
        Node::Leaf(Leaf { value, cover })
    }

    /// A random tree of some depth over features.
    pub(in crate::learned) fn grow(
        random: &mut rand_pcg::Pcg64,
        depth: usize,
        features: u16,
        nodes: &mut Vec<Node>,
    ) {
        if depth == 0 || random.random_bool(0.15) {
            nodes.push(leaf(random.random_range(-1.0..1.0), random.random_range(1.0..9.0)));
            return;
        }
        let threshold = random.random_range(-0.5..0.5);
        nodes.push(split(random.random_range(0..features), threshold, random.random()));
        grow(random, depth - 1, features, nodes);
        grow(random, depth - 1, features, nodes);
    }

    #[test]
    fn questions_are_answered_and_absence_goes_where_it_went_in_training() {
        let nodes =
            vec![split(0, 1.0, false), leaf(1.0, 3.0), split(1, 0.0, true), leaf(2.0, 1.0), leaf(3.0, 4.0)];
        let tree = Tree::new(nodes).unwrap();
        assert_eq!(tree.answer(&[1.0, f32::NAN]), 1.0);
        assert_eq!(tree.answer(&[1.5, 0.0]), 2.0);
        assert_eq!(tree.answer(&[1.5, 0.1]), 3.0);
        assert_eq!(tree.answer(&[f32::NAN, f32::NAN]), 2.0);
        assert_eq!(tree.covers(), [8.0, 3.0, 5.0, 1.0, 4.0]);
        assert_eq!(tree.width(), 2);
    }

    #[test]
    fn what_is_no_tree_is_refused() {
        let refused = |nodes| Tree::new(nodes).unwrap_err();
        assert_eq!(refused(vec![]), TreeError::Shape);
        assert_eq!(refused(vec![split(0, 1.0, true), leaf(1.0, 1.0)]), TreeError::Shape);
        assert_eq!(refused(vec![leaf(1.0, 1.0), leaf(1.0, 1.0)]), TreeError::Shape);
        assert_eq!(refused(vec![leaf(f32::NAN, 1.0)]), TreeError::NotFinite);
        assert_eq!(refused(vec![leaf(1.0, -1.0)]), TreeError::NotFinite);
        assert_eq!(refused(vec![leaf(1.0, 1.0); MOST_NODES + 1]), TreeError::TooLarge);
    }
}
