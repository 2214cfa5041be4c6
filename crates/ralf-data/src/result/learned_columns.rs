//! The columns of what a model says besides its plausibility (docs/learned.md).

use super::schema::{Column, Group, Kind};
use ralf::evidence::GROUPS;
use ralf::learned::{Answer, NEIGHBOURS};
use std::sync::Arc;

const NOVELTY: &str = "novelty";
const CAUSE: &str = "cause";
const CAUSE_PROBABILITY: &str = "cause_probability";
const REASON: &str = "reason";
const VISIBILITY: &str = "visibility";
const LACKING: &str = "lacking";
/// Before the name of a group.
const SHARE: &str = "reason_";

/// The columns, in their order.
pub(crate) fn learned_columns() -> Vec<Column> {
    let number = |name: String, unit, meaning| Column {
        name: name.into(),
        kind: Kind::F32,
        unit,
        meaning,
        group: Group::Evidence,
    };
    let mut columns = vec![number(
        NOVELTY.to_owned(),
        "1",
        "The share of the evidence, by its worth to the model, that is unlike what the model was trained on.",
    )];
    for group in GROUPS {
        let meaning = "What the evidence of this group adds to the log odds that the detection is plausible.";
        columns.push(number(share_column(group), "log odds", meaning));
    }
    let meaning =
        "What a net adds to these log odds that hears of the detections around; null of a model without one.";
    columns.push(number(share_column(NEIGHBOURS), "log odds", meaning));
    let meaning = "The share of the cause among all causes.";
    columns.push(number(CAUSE_PROBABILITY.to_owned(), "1", meaning));
    columns.extend(words_told());
    columns
}

/// The columns of words.
fn words_told() -> Vec<Column> {
    let text = |name: &'static str, meaning| Column {
        name: name.into(),
        kind: Kind::Text,
        unit: "",
        meaning,
        group: Group::Words,
    };
    vec![
        text(CAUSE, "Why the detection is an artifact, or that it is unclear; empty where it is none."),
        text(
            VISIBILITY,
            "How most of the LiDAR scans around see its place: free space, on a surface, occluded, or not looked at.",
        ),
        text(LACKING, "Groups of evidence of which nothing was observed; empty where the model had all."),
        text(REASON, "What adds most to the log odds that the detection is plausible, in words."),
    ]
}

/// The column of what a group of evidence adds to the log odds: that of `LiDAR rays` is `reason_lidar_rays`.
pub fn share_column(group: &str) -> String {
    format!("{SHARE}{}", group.to_lowercase().replace(' ', "_"))
}

/// A column's number of each detection; `None` of a column that is no number of a model's.
pub(crate) fn numbers(name: &str, answers: &[Answer]) -> Option<Vec<f32>> {
    // This is asked of every column of every scan: names are made only where one of them can be meant.
    let is_share = name.starts_with(SHARE);
    let mut all = GROUPS.into_iter().chain([NEIGHBOURS]);
    let group = all.position(|group| is_share && share_column(group) == name);
    if group.is_none() && name != NOVELTY && name != CAUSE_PROBABILITY {
        return None;
    }
    let mut numbers = Vec::with_capacity(answers.len());
    for answer in answers {
        let number = match group {
            Some(group) => answer.shares.get(group).copied(),
            None if name == NOVELTY => answer.novelty,
            None => answer.cause.as_ref().map(|cause| cause.probability),
        };
        numbers.push(number.map_or(f32::NAN, |number| number as f32));
    }
    Some(numbers)
}

/// A column's words of each detection; `None` of a column that holds none.
pub(crate) fn words(name: &str, answers: &[Answer]) -> Option<Vec<Arc<str>>> {
    let of = |answer: &Answer| -> Option<Arc<str>> {
        match name {
            CAUSE => Some(answer.cause.as_ref().map_or("", |cause| &cause.name).into()),
            REASON => Some(answer.reason.as_str().into()),
            VISIBILITY => Some(answer.visibility.map_or("", |visibility| visibility.name()).into()),
            LACKING => Some(names_of(&answer.lacking).into()),
            _ => None,
        }
    };
    answers.iter().map(of).collect()
}

/// Names of groups, by their places.
fn names_of(groups: &[usize]) -> String {
    let names: Vec<&str> = groups.iter().filter_map(|group| GROUPS.get(*group).copied()).collect();
    names.join(", ")
}
