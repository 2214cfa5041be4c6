//! Where a path leads that need not exist yet.

use std::fs;
use std::path::{Path, PathBuf};

/// Links that are followed one after the other, at most: they may lead in a circle.
const MOST_LINKS: u32 = 40;

/// The path with all links followed, those that lead to nothing yet, too.
pub fn real_path(path: &Path) -> PathBuf {
    followed(path, MOST_LINKS)
}

/// The place to write to where a person names this one: what a link leads to, so that the link stays.
pub(crate) fn through_link(named: &Path) -> PathBuf {
    if named.is_symlink() { real_path(named) } else { named.to_owned() }
}

fn followed(path: &Path, links: u32) -> PathBuf {
    let (real, parent, name) = (path.canonicalize(), path.parent(), path.file_name());
    let (parent, name) = match (real, parent, name) {
        (Ok(real), _, _) => return real,
        (Err(_), Some(parent), Some(name)) => (parent, name),
        _ => return path.to_owned(),
    };
    let parent = if parent.as_os_str().is_empty() { Path::new(".") } else { parent };
    let folder = followed(parent, links);
    let place = folder.join(name);
    match fs::read_link(&place) {
        Ok(target) if links > 0 => followed(&folder.join(target), links - 1),
        _ => place,
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_are_followed_to_what_is_not_there_and_never_in_circles() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path().canonicalize().unwrap();
        let place = |name: &str| folder.join(name);
        fs::create_dir(place("there")).unwrap();
        symlink("there", place("link")).unwrap();
        symlink("../new", place("there/dangling")).unwrap();
        symlink("circle", place("circle")).unwrap();
        assert_eq!(real_path(&place("link/a/b")), place("there/a/b"));
        assert_eq!(real_path(&place("link/dangling")), place("new"));
        assert_eq!(real_path(&place("circle")), place("circle"));
        assert_eq!(real_path(Path::new("no/such")), Path::new(".").canonicalize().unwrap().join("no/such"));
    }
}
