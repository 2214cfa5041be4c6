//! `tasks.jsonl`: the tasks of all recordings that were planned into a folder, a line each.
//!
//! Whatever starts tasks knows them by the numbers of their lines. So a later plan leaves the lines of other recordings
//! where they are, and puts tasks of the same ones where theirs were.

use super::Task;
use crate::disk::alone::open_alone;
use crate::disk::files;
use crate::error::DataError;
use crate::result::is_under_way;
use ralf_files::Kind;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::path::Path;

/// In the output folder: a task per line.
const TASKS: &str = "tasks.jsonl";
/// Beside it while it is changed.
const LOCK: &str = ".tasks-lock";

/// A line of the list.
enum Line {
    /// Of a recording by its folder's name: to be left as it is.
    Taken(String),
    /// To be used by others; whose it was, where that is known.
    Free(Option<OsString>),
}

/// Writes down what was planned into the folder `out` now: the output folder of each recording, with its tasks. Of
/// other recordings the tasks stay that were planned before, until they are put together. Returns how many lines there
/// are up to the last task; one that is empty has nothing to do, and so have those after it that held tasks once. Where
/// nothing could be planned, and nothing was before, nothing is written.
///
/// # Errors
/// What can't be read or written.
pub fn write_tasks(out: &Path, planned: &[(&Path, Vec<Task>)]) -> Result<usize, DataError> {
    let (file, lock) = (out.join(TASKS), out.join(LOCK));
    if planned.is_empty() && !files::exists(&file)? {
        return Ok(0);
    }
    fs::create_dir_all(out).map_err(DataError::io(out))?;
    let alone = open_alone(&lock).map_err(DataError::io(&lock))?;
    let written = lines(&file, out, planned).and_then(|lines| {
        let text: String = lines.iter().flat_map(|line| [line.as_str(), "\n"]).collect();
        let tasks = lines.iter().rposition(|line| !line.is_empty()).map_or(0, |last| last + 1);
        files::write_whole(&file, text.as_bytes()).map(|()| tasks)
    });
    let removed = fs::remove_file(&lock).map_err(DataError::io(&lock));
    drop(alone);
    removed.and(written)
}

/// A task of a folder by its number, from 0; `None` where there is nothing to do under it.
///
/// # Errors
/// A number that no task has, and what can't be read.
pub fn read_task(out: &Path, number: usize) -> Result<Option<Task>, DataError> {
    let file = out.join(TASKS);
    let text = files::read_text(&file, Kind::Stream)?;
    let Some(line) = text.lines().nth(number) else {
        let expected = format!("a task below {}", text.lines().count());
        return Err(DataError::content(&file, "lines", expected, number.to_string()));
    };
    if line.is_empty() {
        return Ok(None);
    }
    let refused = |error: serde_json::Error| {
        DataError::content(&file, format!("line {}", number + 1), "a task", error.to_string())
    };
    serde_json::from_str(line).map(Some).map_err(refused)
}

/// The list after a plan.
fn lines(file: &Path, out: &Path, planned: &[(&Path, Vec<Task>)]) -> Result<Vec<String>, DataError> {
    let mut lines = match files::exists(file)? {
        true => earlier(&files::read_text(file, Kind::Stream)?, out, planned)?,
        false => Vec::new(),
    };
    let mut homeless = Vec::new();
    for (folder, tasks) in planned {
        let name = folder.file_name().unwrap_or_default();
        let texts = tasks.iter().map(|task| as_line(file, task)).collect::<Result<Vec<_>, _>>()?;
        homeless.extend(fill(&mut lines, texts, |whose| whose.is_some_and(|whose| whose == name)));
    }
    let left = fill(&mut lines, homeless, |_| true);
    lines.extend(left.into_iter().map(Line::Taken));
    let text = |line| match line {
        Line::Taken(text) => text,
        Line::Free(_) => String::new(),
    };
    Ok(lines.into_iter().map(text).collect())
}

/// The lines that are there: free are those of recordings that are planned anew or put together, and what is none.
fn earlier(text: &str, out: &Path, planned: &[(&Path, Vec<Task>)]) -> Result<Vec<Line>, DataError> {
    let mut last: Option<(OsString, bool)> = None;
    let mut lines = Vec::new();
    for line in text.lines() {
        let task: Option<Task> = serde_json::from_str(line).ok();
        let name = task.and_then(|task| task.job.out.file_name().map(OsStr::to_owned));
        let Some(name) = name else {
            lines.push(Line::Free(None));
            continue;
        };
        // Those of a recording follow each other.
        let stays = match last.take().filter(|(known, _)| *known == name) {
            Some((_, stays)) => stays,
            None => {
                let anew = planned.iter().any(|(folder, _)| folder.file_name() == Some(name.as_os_str()));
                !anew && is_under_way(&out.join(&name))?
            }
        };
        last = Some((name.clone(), stays));
        lines.push(if stays { Line::Taken(line.to_owned()) } else { Line::Free(Some(name)) });
    }
    Ok(lines)
}

/// Puts tasks where a line is free that they may have. Returns those that found none.
fn fill(lines: &mut [Line], texts: Vec<String>, may_have: impl Fn(Option<&OsString>) -> bool) -> Vec<String> {
    let mut texts = texts.into_iter();
    let free = |line: &&mut Line| matches!(line, Line::Free(whose) if may_have(whose.as_ref()));
    for line in lines.iter_mut().filter(free) {
        let Some(text) = texts.next() else { break };
        *line = Line::Taken(text);
    }
    texts.collect()
}

fn as_line(file: &Path, task: &Task) -> Result<String, DataError> {
    serde_json::to_string(task).map_err(|error| DataError::io(file)(error.into()))
}
