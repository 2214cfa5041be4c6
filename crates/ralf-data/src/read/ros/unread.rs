//! Messages that can't be read, topic by topic.

use super::messages::Messages;
use crate::error::DataError;
use std::collections::BTreeMap;

/// How many messages of each topic can't be read, and why the first of them can't.
#[derive(Default)]
pub(super) struct Unread(BTreeMap<usize, (usize, String)>);

impl Unread {
    /// Another message of a topic.
    pub(super) fn add(&mut self, topic: usize, error: &DataError) {
        self.0.entry(topic).or_insert_with(|| (0, error.to_string())).0 += 1;
    }

    /// Why the first message of a topic can't be read.
    pub(super) fn reason(&self, topic: usize) -> Option<&str> {
        self.0.get(&topic).map(|(_, reason)| reason.as_str())
    }

    /// What is said of the topics of this kind, a sentence for each reason.
    pub(super) fn sentences(&self, messages: &Messages, is_told: impl Fn(usize) -> bool) -> Vec<String> {
        let mut reasons = ByReason::default();
        for (topic, (count, reason)) in self.0.iter().filter(|(topic, _)| is_told(**topic)) {
            let name = &messages.container().topics()[*topic].name;
            reasons.add(reason, format!("{count} messages of {name}"));
        }
        reasons.sentences(|topics, reason| format!("{topics} can't be read; the first: {reason}"))
    }
}

/// What has the same reason, so that it is told once.
#[derive(Default)]
pub(super) struct ByReason(Vec<(String, String)>);

impl ByReason {
    /// Something with its reason.
    pub(super) fn add(&mut self, reason: &str, subject: String) {
        match self.0.iter_mut().find(|(known, _)| known == reason) {
            Some((_, subjects)) => *subjects += &format!(", {subject}"),
            None => self.0.push((reason.to_owned(), subject)),
        }
    }

    /// A sentence for each reason, of what has it and of the reason.
    pub(super) fn sentences(&self, sentence: impl Fn(&str, &str) -> String) -> Vec<String> {
        self.0.iter().map(|(reason, subjects)| sentence(subjects, reason)).collect()
    }
}
