//! Links in folders that the program writes to: nothing is written or removed through one that leads out.

use crate::error::DataError;
use std::fs;
use std::path::Path;

/// Refuses a folder `name` in `root` that is, or holds down to `levels` below it, a link to a folder outside `root`, or
/// to nowhere. `root` itself may be a link: a person has named it. Links to files are no danger, for a file that is
/// written takes the place of what was there.
///
/// # Errors
/// The first such link by name, and where it leads.
pub(crate) fn refuse_links_out(root: &Path, name: &str, levels: usize) -> Result<(), DataError> {
    let folder = root.join(name);
    if !folder.is_dir() && !folder.is_symlink() {
        return Ok(());
    }
    let inside = root.canonicalize().map_err(DataError::io(root))?;
    refuse(&folder, &inside, levels)
}

/// Refuses a link to a folder outside `root`, or to nowhere, on the way from there: each part of it is the name of a
/// folder in the one before. What else lies there is not looked at.
///
/// # Errors
/// The first such link, and where it leads.
pub(crate) fn refuse_links_on_way(root: &Path, way: &[&str]) -> Result<(), DataError> {
    let mut folder = root.to_owned();
    for name in way {
        folder.push(name);
        if folder.is_symlink() {
            refuse_link(&folder, &root.canonicalize().map_err(DataError::io(root))?)?;
        }
    }
    Ok(())
}

fn refuse_link(link: &Path, inside: &Path) -> Result<(), DataError> {
    let found = match link.canonicalize() {
        Ok(target) if target.starts_with(inside) => return Ok(()),
        Ok(target) => format!("a link to {}", target.display()),
        // What is written there is not there before.
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => "a link to nowhere".to_owned(),
        Err(error) => return Err(DataError::io(link)(error)),
    };
    let expected = format!("a folder, or a link to one in {}", inside.display());
    Err(DataError::content(link, "link", expected, found))
}

fn refuse(folder: &Path, inside: &Path, levels: usize) -> Result<(), DataError> {
    if folder.is_symlink() {
        return refuse_link(folder, inside);
    }
    if levels == 0 {
        return Ok(());
    }
    let entries = fs::read_dir(folder).map_err(DataError::io(folder))?;
    let mut folders = Vec::new();
    for entry in entries {
        let entry = entry.map_err(DataError::io(folder))?;
        let (kind, path) = (entry.file_type().map_err(DataError::io(folder))?, entry.path());
        if kind.is_dir() || kind.is_symlink() && !path.is_file() {
            folders.push(path);
        }
    }
    folders.sort_unstable();
    folders.iter().try_for_each(|folder| refuse(folder, inside, levels - 1))
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::symlink;

    #[test]
    fn links_that_lead_out_are_refused_and_others_not() {
        let place = tempfile::tempdir().unwrap();
        let (root, victim) = (place.path().join("out"), place.path().join("victim"));
        fs::create_dir_all(root.join("sequences/00/front")).unwrap();
        fs::create_dir_all(root.join("kept")).unwrap();
        fs::create_dir(&victim).unwrap();
        let check = || refuse_links_out(&root, "sequences", 2);
        // Within the folder, to a file; deeper than anything is written.
        symlink(root.join("kept"), root.join("sequences/01")).unwrap();
        fs::write(victim.join("file"), "mine").unwrap();
        symlink(victim.join("file"), root.join("sequences/00/notes.txt")).unwrap();
        symlink(&victim, root.join("sequences/00/front/deep")).unwrap();
        check().unwrap();
        refuse_links_out(&root, "other", 2).unwrap();
        symlink(&victim, root.join("sequences/00/rear")).unwrap();
        let error = check().unwrap_err().to_string();
        assert!(error.contains("00/rear: link: expected a folder") && error.contains("victim"), "{error}");
        let on_way = |way: &[&str]| refuse_links_on_way(&root, way);
        assert!(on_way(&["sequences", "00", "rear", "depth"]).unwrap_err().to_string().contains("victim"));
        on_way(&["sequences", "00", "front"]).unwrap();
        on_way(&["sequences", "01", "front"]).unwrap();
        on_way(&["nothing", "yet"]).unwrap();
        fs::remove_file(root.join("sequences/00/rear")).unwrap();
        // To nowhere.
        symlink(place.path().join("nothing"), root.join("sequences/02")).unwrap();
        assert!(check().unwrap_err().to_string().contains("sequences/02: link: expected a folder"));
        assert!(on_way(&["sequences", "02"]).unwrap_err().to_string().contains("found a link to nowhere"));
        fs::remove_file(root.join("sequences/02")).unwrap();
        // The folder that a person names may be a link itself.
        symlink(&root, place.path().join("named")).unwrap();
        refuse_links_out(&place.path().join("named"), "sequences", 2).unwrap();
        fs::rename(root.join("sequences"), victim.join("sequences")).unwrap();
        symlink(victim.join("sequences"), root.join("sequences")).unwrap();
        assert!(check().is_err());
    }
}
