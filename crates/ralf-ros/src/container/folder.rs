//! Folders that ROS 2 records into: `metadata.yaml` beside one or several files.

use super::error::ContainerError;
use super::loss::Loss;
use super::{bag_format, beginning, db3};
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// What such a folder holds.
pub(super) const METADATA: &str = "metadata.yaml";

/// The files that the folder's `metadata.yaml` lists, in its order; what it lists and the folder lacks is a loss.
pub(super) fn files(folder: &Path, losses: &mut Vec<Loss>) -> Result<Vec<PathBuf>, ContainerError> {
    let metadata = folder.join(METADATA);
    let text = ralf_files::read_text(&metadata, Kind::Settings).map_err(ContainerError::io(&metadata))?;
    let names = listed(&text);
    if names.is_empty() {
        let expected = "a list of files";
        return Err(ContainerError::content(&metadata, "relative_file_paths", expected, "none"));
    }
    let mut files = Vec::new();
    for name in names {
        // Recorders write names; early ones of ROS 2 wrote paths from where they were started.
        let name = Path::new(&name).file_name().unwrap_or_default().to_owned();
        if Path::new(&name).extension().is_some_and(|extension| extension == "zstd") {
            let expected = "files that aren't compressed as a whole (`zstd -d` makes them so)";
            return Err(ContainerError::content(
                &metadata,
                "relative_file_paths",
                expected,
                name.display().to_string(),
            ));
        }
        let file = folder.join(name);
        if file.is_file() {
            files.push(file);
        } else {
            losses.push(Loss::hiding(format!("{}: {} is not there", metadata.display(), file.display())));
        }
    }
    if files.is_empty() {
        let expected = "files that are there";
        return Err(ContainerError::content(&metadata, "relative_file_paths", expected, "none of them"));
    }
    without_unwritten(files, losses)
}

/// Without a last file that was not begun: where the power went just after the one before was full, it is there and
/// holds nothing. What is wrong with any other is told when it's opened.
fn without_unwritten(
    mut files: Vec<PathBuf>,
    losses: &mut Vec<Loss>,
) -> Result<Vec<PathBuf>, ContainerError> {
    let Some(last) = files.last().filter(|_| files.len() > 1) else { return Ok(files) };
    let found = beginning(last).map_err(ContainerError::io(last))?;
    let is_part = |magic: &&[u8]| found.len() < magic.len() && magic.starts_with(&found);
    if [db3::MAGIC, bag_format::MAGIC, mcap::MAGIC].iter().any(is_part) {
        losses.push(Loss::hiding(format!("{}: holds no beginning of a recording", last.display())));
        files.pop();
    }
    Ok(files)
}

/// The entries of the list `relative_file_paths`, each on a line of its own, as every recorder writes it.
fn listed(text: &str) -> Vec<String> {
    let after = text.lines().skip_while(|line| line.trim() != "relative_file_paths:").skip(1);
    let entries = after.map_while(|line| line.trim().strip_prefix("- "));
    entries.map(|entry| entry.trim().trim_matches(['"', '\'']).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const TEXT: &str = "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n    - drive_0.db3\n    \
                        - \"drive_1.db3\"\n  duration:\n    nanoseconds: 5\n";

    #[test]
    fn what_is_listed_and_missing_is_told() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(METADATA), TEXT).unwrap();
        let error = files(folder.path(), &mut Vec::new()).unwrap_err().to_string();
        assert!(error.contains("expected files that are there"), "{error}");
        fs::write(folder.path().join("drive_1.db3"), "").unwrap();
        let mut losses = Vec::new();
        assert_eq!(files(folder.path(), &mut losses).unwrap(), [folder.path().join("drive_1.db3")]);
        assert!(losses.len() == 1 && losses[0].sentence.contains("drive_0.db3 is not there"), "{losses:?}");
    }

    #[test]
    fn a_file_that_was_not_begun_is_told_and_the_others_are_read() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(METADATA), TEXT).unwrap();
        let [first, second] = ["drive_0.db3", "drive_1.db3"].map(|name| folder.path().join(name));
        fs::write(&first, crate::container::db3::MAGIC).unwrap();
        for begun in ["", "SQLi"] {
            fs::write(&second, begun).unwrap();
            let mut losses = Vec::new();
            assert_eq!(files(folder.path(), &mut losses).unwrap(), std::slice::from_ref(&first));
            assert!(
                losses[0].hides_messages && losses[0].sentence.contains("drive_1.db3: holds no beginning")
            );
        }
    }

    #[test]
    fn files_compressed_as_a_whole_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join(METADATA), TEXT.replace("_0.db3", "_0.db3.zstd")).unwrap();
        assert!(files(folder.path(), &mut Vec::new()).unwrap_err().to_string().contains("zstd -d"));
    }
}
