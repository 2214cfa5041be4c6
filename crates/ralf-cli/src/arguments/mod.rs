//! What several commands take: the recording, the settings.

mod dataset;
mod settings;

pub(crate) use dataset::{DatasetArgs, the_only};
pub(crate) use settings::{SettingsArgs, threads};
