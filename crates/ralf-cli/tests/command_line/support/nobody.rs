//! The program as somebody else.

use super::{Dataset, program};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

/// Somebody without any rights of their own.
const NOBODY: &str = "65534";

/// The program as somebody whom permissions bind, which root is not; they may write beside the recording.
pub(crate) fn as_nobody(dataset: &Dataset) -> Option<Command> {
    let everyone = |path: &Path, mode| fs::set_permissions(path, fs::Permissions::from_mode(mode)).unwrap();
    let folder = Path::new(&dataset.path).parent()?;
    everyone(folder, 0o777);
    let locked = folder.join("locked.txt");
    fs::write(&locked, "").unwrap();
    everyone(&locked, 0o000);
    if fs::read(&locked).is_err() {
        return Some(program());
    }
    // A copy, for nobody may look into the folder where it was built.
    let copy = folder.join("ralf");
    fs::copy(program().get_program(), &copy).unwrap();
    everyone(&copy, 0o755);
    let command = || {
        let mut command = Command::new("setpriv");
        command.args(["--reuid", NOBODY, "--clear-groups"]).arg(&copy);
        command
    };
    let works = || command().arg("--version").output().is_ok_and(|output| output.status.success());
    // A child of another test that starts right now may still hold the copy open for writing.
    let works = (0..20).any(|_| {
        works() || {
            sleep(Duration::from_millis(20));
            false
        }
    });
    works.then(command)
}
