//! Builds the page from `web/` with Node and npm, and has it embedded. Without them the program builds all the
//! same, and its page says what is missing.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is built, and what it is built from.
const OUTPUT: &str = "dist";
/// Folders of `web/` that are no sources.
const NOT_COPIED: [&str; 4] = ["node_modules", "dist", "dist-tests", "tests"];

fn main() -> io::Result<()> {
    let from = |name| std::env::var_os(name).map(PathBuf::from).ok_or_else(|| io::Error::other(name));
    let (web, out) = (from("CARGO_MANIFEST_DIR")?.join("web"), from("OUT_DIR")?);
    println!("cargo::rerun-if-changed=build.rs");
    watch(&web)?;
    let files = match build(&web, &out.join("web")) {
        Ok(folder) => files_below(&folder)?,
        Err(missing) => {
            println!("cargo::warning=the review page is not built: {missing}");
            // A file that is never there has cargo try again next time, when what is missing may be installed.
            println!("cargo::rerun-if-changed={}", out.join("never").display());
            vec![("/index.html".to_owned(), message(&out, &missing)?)]
        }
    };
    fs::write(out.join("page_files.rs"), listing(&files))
}

/// Has cargo look at every source of the page; of a folder it would look at what npm leaves there, too.
fn watch(web: &Path) -> io::Result<()> {
    if !web.is_dir() {
        println!("cargo::rerun-if-changed={}", web.display());
        return Ok(());
    }
    for (_, file) in sources(web)? {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    println!("cargo::rerun-if-changed={}", web.join("src").display());
    Ok(())
}

/// Copies the sources and builds them there, so that nothing is left in the tree. The error is what to install
/// or to mend.
fn build(web: &Path, copy: &Path) -> Result<PathBuf, String> {
    if !web.join("package.json").is_file() {
        return Err("crates/ralf-review/web/package.json is missing; expected the page's sources".into());
    }
    copy_sources(web, copy).map_err(|error| format!("{}: {error}", copy.display()))?;
    if !is_installed(copy) {
        npm(copy, &["ci", "--no-audit", "--no-fund", "--ignore-scripts"])?;
        fs::copy(copy.join(LOCK), copy.join(INSTALLED)).map_err(|error| format!("{INSTALLED}: {error}"))?;
    }
    npm(copy, &["run", "build"])?;
    let folder = copy.join(OUTPUT);
    if folder.join("index.html").is_file() {
        Ok(folder)
    } else {
        Err("`npm run build` made no dist/index.html".into())
    }
}

const LOCK: &str = "package-lock.json";
/// A copy of the lock file that the installed packages are of.
const INSTALLED: &str = "installed-lock.json";

fn is_installed(copy: &Path) -> bool {
    let [lock, installed] = [LOCK, INSTALLED].map(|name| fs::read(copy.join(name)).ok());
    lock.is_some() && lock == installed && copy.join("node_modules").is_dir()
}

fn npm(folder: &Path, arguments: &[&str]) -> Result<(), String> {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let command = format!("npm {}", arguments.join(" "));
    let ran = Command::new(program).args(arguments).current_dir(folder).output();
    let output =
        ran.map_err(|error| format!("`{command}`: {error}; install Node.js 20 or newer, with npm"))?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let said: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).take(6).collect();
    Err(format!("`{command}` failed ({}): {}", output.status, said.join(" | ")))
}

/// Replaces the copy's sources; what npm installed there stays.
fn copy_sources(web: &Path, copy: &Path) -> io::Result<()> {
    for stale in ["src", OUTPUT] {
        match fs::remove_dir_all(copy.join(stale)) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => return Err(error),
            _ => {}
        }
    }
    for (name, file) in sources(web)? {
        let to = copy.join(name);
        to.parent().map_or(Ok(()), fs::create_dir_all)?;
        fs::copy(file, to)?;
    }
    Ok(())
}

/// Every source below `web/`: its path there, and the file; sorted.
fn sources(web: &Path) -> io::Result<Vec<(PathBuf, PathBuf)>> {
    let mut found = Vec::new();
    for entry in fs::read_dir(web)? {
        let entry = entry?;
        let name = entry.file_name();
        if NOT_COPIED.iter().all(|other| name != *other) {
            collect(&entry.path(), Path::new(&name), &mut found)?;
        }
    }
    found.sort();
    Ok(found)
}

fn collect(at: &Path, name: &Path, found: &mut Vec<(PathBuf, PathBuf)>) -> io::Result<()> {
    if at.is_file() {
        found.push((name.to_owned(), at.to_owned()));
        return Ok(());
    }
    for entry in fs::read_dir(at)? {
        let entry = entry?;
        collect(&entry.path(), &name.join(entry.file_name()), found)?;
    }
    Ok(())
}

/// What was built: addresses and files, sorted.
fn files_below(folder: &Path) -> io::Result<Vec<(String, PathBuf)>> {
    let mut found = Vec::new();
    collect(folder, Path::new(""), &mut found)?;
    let address = |name: &Path| format!("/{}", name.to_string_lossy().replace('\\', "/"));
    let mut files: Vec<_> = found.into_iter().map(|(name, file)| (address(&name), file)).collect();
    files.sort();
    Ok(files)
}

/// A page that says what is missing.
fn message(out: &Path, missing: &str) -> io::Result<PathBuf> {
    let file = out.join("message.html");
    let missing = missing.replace('&', "&amp;").replace('<', "&lt;");
    let text = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<title>ralf review</title>\n\
         <h1>The review page is not in this build</h1>\n<p>{missing}</p>\n\
         <p>Install Node.js 20 or newer with npm, then build <code>ralf</code> again. The labels and corrections \
         are served all the same: see <code>docs/review-api.md</code>.</p>\n</html>\n"
    );
    fs::write(&file, text).map(|()| file)
}

/// The source text of `FILES`.
fn listing(files: &[(String, PathBuf)]) -> String {
    let entry = |(address, file): &(String, PathBuf)| {
        format!("    ({address:?}, {:?}, include_bytes!({:?})),\n", kind(address), file.display().to_string())
    };
    let entries: String = files.iter().map(entry).collect();
    format!("const FILES: &[(&str, &str, &[u8])] = &[\n{entries}];\n")
}

fn kind(address: &str) -> &'static str {
    match Path::new(address).extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js" | "mjs") => "text/javascript; charset=utf-8",
        Some("css") => "text/css; charset=utf-8",
        Some("json" | "map") => "application/json",
        Some("svg") => "image/svg+xml",
        Some("png") => "image/png",
        Some("ico") => "image/x-icon",
        Some("woff2") => "font/woff2",
        Some("wasm") => "application/wasm",
        _ => "application/octet-stream",
    }
}
