//! Links of a recording that lead to other files: what is none of a recording's goes into no copy of it.

use crate::dataset::{tiny, write};
use ralf_data::{DataError, LayoutSequence, write_sequence};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;

/// What the copy of a sequence has in a file.
fn copied(sequence: &Path, file: &str) -> Result<Vec<u8>, DataError> {
    let out = tempfile::tempdir().unwrap();
    write_sequence(&LayoutSequence::open(sequence).unwrap(), out.path(), &|_| ())?;
    Ok(fs::read(out.path().join("sequences/00").join(file)).unwrap())
}

#[test]
fn a_list_of_causes_that_leads_to_another_file_is_not_copied() {
    let (folder, path) = tiny();
    let secret = folder.path().join("secret");
    fs::write(&secret, "-----BEGIN KEY-----").unwrap();
    symlink(&secret, path.join("ground_truth/causes.txt")).unwrap();
    let copied = || copied(&path, "ground_truth/causes.txt");
    let error = copied().unwrap_err().to_string();
    assert!(error.contains("causes.txt: line 1: expected `none`"), "{error}");
    fs::write(&secret, "none\nclutter\n").unwrap();
    assert!(copied().unwrap() == b"none\nclutter\n");
}

#[test]
fn labels_causes_and_images_that_lead_to_another_file_are_not_copied() {
    let secret = "root:x:0:0:root:/root:/bin/sh\n::";
    for (file, told, own) in [
        (
            "ground_truth/radar_front/000000.label",
            "size: expected 2 uint32, one per detection, found 8",
            None,
        ),
        (
            "ground_truth/radar_front/000000.cause",
            "number of codes: expected 2, one for each",
            Some(&[0, 1][..]),
        ),
        ("lidar_top/000000.label", "size: expected 2 uint32, one per point", None),
        ("camera_front/000000.png", "content: expected a whole JPEG or PNG image", None),
    ] {
        let (folder, path) = tiny();
        write(&path.join("ground_truth/causes.txt"), "none\nclutter\n");
        let (file, target) = (path.join(file), folder.path().join("elsewhere"));
        match own {
            Some(bytes) => write(&target, bytes),
            None => fs::rename(&file, &target).unwrap(),
        }
        symlink(&target, &file).unwrap();
        let name = file.strip_prefix(&path).unwrap().to_str().unwrap();
        assert_eq!(copied(&path, name).unwrap(), fs::read(&target).unwrap(), "links are read through");
        fs::write(&target, secret).unwrap();
        let error = copied(&path, name).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains(told), "{error}");
    }
}

#[test]
fn codes_of_causes_without_names_are_not_copied() {
    let (_folder, path) = tiny();
    let name = "ground_truth/radar_front/000000.cause";
    write(&path.join(name), b"::");
    for names in [None, Some("none\nclutter\n")] {
        names.iter().for_each(|names| write(&path.join("ground_truth/causes.txt"), names));
        let error = copied(&path, name).unwrap_err().to_string();
        assert!(error.contains(name) && error.contains("byte 0: expected a code below"), "{error}");
    }
}
