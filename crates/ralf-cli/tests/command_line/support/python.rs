//! What programs that know nothing of RALF read from its files.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// What an export holds, read by `testdata/read_export.py` with the interpreter that `RALF_TEST_PYTHON` names. `None`,
/// and said so, where it or its packages are not there.
pub(crate) fn read_export(format: &str, path: &str) -> Option<Value> {
    let Some(python) = std::env::var_os("RALF_TEST_PYTHON") else {
        println!("skipped: RALF_TEST_PYTHON is not set");
        return None;
    };
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/read_export.py");
    let read = Command::new(python).arg(script).args([format, path]).output().unwrap();
    let errors = String::from_utf8_lossy(&read.stderr);
    if errors.contains("ModuleNotFoundError") {
        println!("skipped: {errors}");
        return None;
    }
    assert!(read.status.success(), "{format}: {errors}");
    Some(serde_json::from_slice(&read.stdout).unwrap())
}
