//! The tree of frames, with the transforms that it can't take: who needs one of their frames is refused.

use super::messages::Messages;
use crate::error::DataError;
use ralf_ros::container::MessageRef;
use ralf_ros::message::TransformStamped;
use ralf_ros::tf::{Chain, Kind, TfError, TfTree};
use std::collections::BTreeMap;

/// What messages tell of frames.
#[derive(Default)]
pub(super) struct Frames {
    tree: TfTree,
    /// By the frame that they place.
    refused: BTreeMap<String, Refused>,
}

/// Transforms of a frame that are none, or that contradict the others.
struct Refused {
    count: usize,
    first: MessageRef,
    reason: String,
}

impl Frames {
    /// Takes a transform; one that the tree refuses is kept in mind.
    pub(super) fn add(&mut self, message: &MessageRef, transform: &TransformStamped, kind: Kind) {
        let Err(error) = self.tree.add(transform, kind) else { return };
        let child = transform.child_frame_id.trim_start_matches('/').to_owned();
        let first = || Refused { count: 0, first: *message, reason: error.to_string() };
        self.refused.entry(child).or_insert_with(first).count += 1;
    }

    /// The transforms from one frame to another.
    pub(super) fn chain<'a>(&'a self, target: &'a str, source: &'a str) -> Result<Chain<'a>, TfError> {
        self.tree.chain(target, source)
    }

    /// Refuses a chain that needs a frame of which refused transforms tell.
    pub(super) fn check(&self, messages: &Messages, chain: &Chain) -> Result<(), DataError> {
        chain
            .frames()
            .find_map(|frame| self.refused.get(frame))
            .map_or(Ok(()), |found| Err(found.error(messages)))
    }

    /// What is said of the transforms that the tree couldn't take.
    pub(super) fn left_out(&self, messages: &Messages) -> Vec<String> {
        let sentence = |(frame, found): (&String, &Refused)| {
            let (count, first) = (found.count, found.error(messages));
            format!("{count} transforms of the frame `{frame}` are not used; the first: {first}")
        };
        self.refused.iter().map(sentence).collect()
    }
}

impl Refused {
    fn error(&self, messages: &Messages) -> DataError {
        let (frames, reason) = self.reason.split_once(": ").unwrap_or(("", &self.reason));
        let place = ["transforms", frames].join(" ");
        messages.refused(&self.first, place.trim_end(), reason)
    }
}
