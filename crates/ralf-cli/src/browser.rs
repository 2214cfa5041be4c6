//! Opening an address with a secret in it: what a program is started with, everybody on the machine can read.

use std::ffi::OsStr;
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::{Builder, TempDir};

/// Asks the system to open something in the browser.
pub(crate) fn open(what: &OsStr) -> io::Result<()> {
    let mut command = match std::env::consts::OS {
        "macos" => Command::new("open"),
        "windows" => Command::new("explorer"),
        _ => Command::new("xdg-open"),
    };
    let command = command.arg(what).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().map(drop)
}

/// A page that leads to an address, for this user's eyes alone, until it is dropped.
pub(crate) struct Detour {
    folder: TempDir,
}

impl Detour {
    /// Makes the page, in a folder of its own that nobody else can look into.
    pub(crate) fn to(url: &str) -> io::Result<Self> {
        let mut private = Builder::new();
        private.prefix("ralf-review-");
        #[cfg(unix)]
        private.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o700));
        let detour = Self { folder: private.tempdir()? };
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        options.open(detour.page())?.write_all(page(url).as_bytes())?;
        Ok(detour)
    }

    /// Where it lies.
    pub(crate) fn page(&self) -> PathBuf {
        Path::join(self.folder.path(), "open.html")
    }
}

fn page(url: &str) -> String {
    let url = url.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
    format!(
        "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<meta name=\"referrer\" content=\"no-referrer\">\n\
         <meta http-equiv=\"refresh\" content=\"0; url={url}\">\n<title>RALF</title>\n\
         <a href=\"{url}\">to the review</a>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_stays_one_in_a_page() {
        let page = page("http://[::1]:8642/?token=0a&b=\"<");
        assert!(page.contains("content=\"0; url=http://[::1]:8642/?token=0a&amp;b=&quot;&lt;\""), "{page}");
    }

    #[cfg(unix)]
    #[test]
    fn nobody_else_reads_the_page_and_it_is_gone_in_the_end() {
        use std::os::unix::fs::PermissionsExt;
        let detour = Detour::to("http://127.0.0.1:1/?token=0").unwrap();
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
        assert_eq!((mode(&detour.page()), mode(detour.folder.path())), (0o600, 0o700));
        let page = detour.page();
        drop(detour);
        assert!(!page.exists() && !page.parent().unwrap().exists());
    }
}
