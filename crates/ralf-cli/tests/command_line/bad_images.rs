//! Images and depth that can't be used make failed views, are named in `run.json` and summed up, and never end a run.

use crate::support::{Dataset, ralf};
use std::fs;

/// Labels a recording with a camera after some harm was done to it, of which it says this: `run.json`, and what `ralf
/// inspect OUT` then says.
fn labelled(told: &str, harm: impl Fn(&Dataset)) -> (String, String) {
    let dataset = Dataset::new().with_camera(3);
    harm(&dataset);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says([told]);
    let inspected = ralf(["inspect", &dataset.out]).exits(0).says_nothing().prints(["radar_front"]);
    (fs::read_to_string(format!("{}/run.json", dataset.out)).unwrap(), inspected.stdout)
}

/// Replaces a part of a file by another of the same length.
fn replace(dataset: &Dataset, name: &str, part: &str, by: &str) {
    let mut bytes = fs::read(dataset.file(name)).unwrap();
    let at = bytes.windows(part.len()).position(|window| window == part.as_bytes()).unwrap();
    bytes[at..at + part.len()].copy_from_slice(by.as_bytes());
    fs::write(dataset.file(name), bytes).unwrap();
}

#[test]
fn a_truncated_image_is_a_failed_view() {
    let (record, inspected) = labelled("labelled without: 00 camera_front image 1: ", |dataset| {
        let image = dataset.file("camera_front/000001.png");
        let bytes = fs::read(&image).unwrap();
        fs::write(&image, &bytes[..bytes.len() / 2]).unwrap();
    });
    assert!(record.contains("000001.png"), "{record}");
    assert!(inspected.contains("1 unusable"), "{inspected}");
}

#[test]
fn an_image_of_another_size_than_the_calibration_says_is_a_failed_view() {
    let (record, inspected) =
        labelled("labelled without: 00 camera_front image 0 and 2 others: ", |dataset| {
            replace(dataset, "sequence.toml", "width = 160", "width = 161");
        });
    assert!(
        record.contains("image size: expected 161 x 120 px, as the camera has, found 160 x 120 px"),
        "{record}"
    );
    assert!(inspected.contains("3 unusable"), "{inspected}");
}

#[test]
fn depth_of_another_shape_is_a_failed_view() {
    let (record, inspected) = labelled("labelled without: 00 camera_front image 2: ", |dataset| {
        replace(dataset, "camera_front/depth/000002.npy", "(120, 160)", "(160, 120)");
    });
    assert!(record.contains("a depth image of 160 x 120 px for view 0, found 120 x 160 px"), "{record}");
    assert!(inspected.contains("1 unusable"), "{inspected}");
}

#[test]
fn without_depth_a_camera_is_absent_and_sets_no_flag() {
    let (record, inspected) = labelled("", |dataset| {
        fs::remove_dir_all(dataset.file("camera_front/depth")).unwrap();
    });
    assert!(record.contains("\"images\": []"), "{record}");
    assert!(
        inspected.contains("1 camera(s) not matched, for no image that has depth is near a radar scan"),
        "{inspected}"
    );
}
