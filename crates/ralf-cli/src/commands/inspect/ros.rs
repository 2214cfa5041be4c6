//! The topics of a ROS recording, and a first guess of which sensor each of them is.

use crate::arguments::{DatasetArgs, check_output};
use crate::outcome::{Outcome, UsageError};
use crate::progress::say;
use crate::text::{aligned, grouped, shell_path};
use ralf_data::read::ros::{Guess, RosInspection, TopicInspection, Topics, inspect, is_ros, topics_toml};
use std::path::Path;

/// What a look at all messages told.
pub(super) struct Look {
    pub(super) inspection: RosInspection,
    guess: Guess,
}

impl Look {
    /// `None` of a recording that isn't one of ROS.
    pub(super) fn at(dataset: &DatasetArgs) -> anyhow::Result<Option<Self>> {
        let asked = dataset.format.as_deref().is_none_or(|format| format == "ros");
        if !asked || !is_ros(&dataset.dataset) {
            return Ok(None);
        }
        let (inspection, guess) = inspect(&dataset.dataset)?;
        Ok(Some(Self { inspection, guess }))
    }

    /// The topics, and the guess where the settings have no table.
    pub(super) fn page(&self, topics: &Topics) -> anyhow::Result<String> {
        let head = ["topic", "type", "encoding", "count", "rate", "jitter", "delay", "frame"];
        let mut rows = vec![head.map(str::to_owned).to_vec()];
        rows.extend(self.inspection.topics.iter().map(row));
        let mut page = aligned(&rows) + "\n";
        for loss in &self.inspection.losses {
            page += &format!("lost: {loss}\n");
        }
        if topics.is_empty() {
            page += &format!("{}\n", topics_toml(&self.guess)?);
        }
        Ok(page)
    }
}

/// Writes the guess into a file that isn't there yet: it may hold what someone wrote with care. A link that leads
/// nowhere is somebody's, too. Whether there is room for a file is asked before all messages are looked at.
pub(super) fn write_topics(dataset: &DatasetArgs, file: &Path) -> anyhow::Result<Outcome> {
    if file.symlink_metadata().is_ok() {
        let file = file.display();
        return Err(UsageError(format!("--write-topics: {file} is there already, and is kept")).into());
    }
    check_output("--write-topics", file, &[])?;
    let look = Look::at(dataset)?;
    let look = look.ok_or_else(|| UsageError("--write-topics: expected a ROS recording".into()))?;
    ralf_data::write_named(file, topics_toml(&look.guess)?.as_bytes())?;
    say(&format!("wrote {}: check it, then `ralf label --config {}`", file.display(), shell_path(file)));
    Ok(Outcome::Done)
}

fn row(topic: &TopicInspection) -> Vec<String> {
    let value =
        |value: Option<f64>, unit: &str| value.map_or("-".to_owned(), |value| format!("{value:.1} {unit}"));
    vec![
        topic.topic.clone(),
        topic.type_name.clone(),
        topic.encoding.clone(),
        grouped(topic.count as u64),
        value(topic.rate_hz, "Hz"),
        value(topic.jitter_ms, "ms"),
        value(topic.delay_ms, "ms"),
        topic.frame.clone().unwrap_or_else(|| "-".to_owned()),
    ]
}
