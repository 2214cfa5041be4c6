//! What several commands take: the recording, what to do where it has changed, the settings.

mod changed;
mod dataset;
mod method;
mod output;
mod settings;
mod stored;

pub(crate) use changed::ChangedArgs;
pub(crate) use dataset::{DatasetArgs, open_and_tell, tell_held_motion, tell_left_out, the_only};
pub(crate) use method::MethodArgs;
pub(crate) use output::{check_editable, check_model, check_output, check_page, check_picture, refuse_same};
pub(crate) use settings::{SettingsArgs, check_trajectory, threads};
pub(crate) use stored::{STORED_CLASSES, STORED_DEPTH};
