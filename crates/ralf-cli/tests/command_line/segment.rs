//! `ralf segment`, and labels with what it stored.

use crate::support::{Dataset, Ran, Shape, network, nuscenes, program, ralf, schema, tree};
use std::fs;
use std::path::Path;

const CARD: &str = "input = { width = 32, height = 16 }\nfit = \"stretch\"\nchannels = \"rgb\"\ndivide_by = 255\n\
                    mean = [0, 0, 0]\nstd = [1, 1, 1]\nclasses = [{ name = \"sky\", id = 0 }, \
                    { name = \"car\", id = 10 }, { name = \"wall\", id = 51 }]\n";

/// A network whose classes are the colours, beside the dataset.
fn colours(dataset: &Dataset) -> String {
    use network::{FLOAT, INT64, flagged, onnx};
    let largest = flagged("ArgMax", "image", "places", &[("axis", 1), ("keepdims", 0)]);
    let [image, places] = [("image", FLOAT, &[1, 3, 0, 0][..]), ("places", INT64, &[1, 0, 0][..])];
    let file = dataset.beside("colours.onnx");
    fs::write(&file, onnx(&[largest], &[], &[image], &[places])).unwrap();
    fs::write(dataset.beside("colours.toml"), CARD).unwrap();
    file
}

#[test]
fn images_are_segmented_once_and_tell_where_classes_are_from() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    let model = colours(&dataset);
    let store = dataset.beside("classes");
    ralf(["segment", &dataset.path, "--model", &model, "-o", &store]).exits(0).prints_nothing();
    let first = format!("{store}/sequences/00/camera_front/segmentation/000000.png");
    let made = fs::metadata(&first).unwrap().modified().unwrap();
    ralf(["segment", &dataset.path, "--model", &model, "-o", &store]).exits(0);
    assert_eq!(fs::metadata(&first).unwrap().modified().unwrap(), made, "what is stored is kept");
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let plain = dataset.result("plausibility.parquet");
    assert!(!schema(plain).iter().any(|column| column.contains("class_from")));
    let out = dataset.beside("with-classes");
    ralf(["label", &dataset.path, "-o", &out, "--segmentation", &store]).exits(0);
    let told = schema(format!("{out}/sequences/00/plausibility.parquet"));
    assert!(told.iter().any(|column| column.contains("class_from")), "{told:?}");
    // Of an image that has changed they are made again; a store that was not filled to its end is told of.
    fs::remove_file(dataset.file("camera_front/000001.png")).unwrap();
    dataset.put("camera_front/000001.png", grey(90));
    let again = "segmentation of 00: computed again of 1 image, ";
    ralf(["segment", &dataset.path, "--model", &model, "-o", &store]).exits(0).says([again]);
    fs::remove_file(&first).unwrap();
    let lacking = "no segmentation of 1 of 3 images of 00 camera_front, the first is 0";
    ralf(["label", &dataset.path, "-o", &out, "--segmentation", &store]).exits(0).says([&store, lacking]);
    let many = dataset.beside("many");
    let plan = ralf(["cluster", "plan", "-q", &dataset.path, "-o", &many, "--segmentation", &store]);
    plan.exits(0).says([lacking]);
    // Without -o they lie in the dataset itself, and labelling finds them there.
    ralf(["segment", &dataset.path, "--model", &model]).exits(0);
    assert!(dataset.file("camera_front/segmentation/000002.png").exists());
}

/// With `sequences` in it, a recording of another format would be taken for one of RALF's own layout.
#[test]
fn a_recording_of_another_format_takes_no_stores() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    let model = colours(&dataset);
    let other = dataset.beside("nuscenes");
    nuscenes(Path::new(&other));
    let refused = ralf(["segment", &dataset.path, "--model", &model, "-o", &other]);
    refused.exits(1).says([&other, "found a recording of the format nuscenes"]);
    let own = ralf(["segment", &other, "--model", &model, "-o", &other]);
    own.exits(2).says(["expected -o FOLDER, for a recording of the format nuscenes is only read"]);
    assert!(!Path::new(&other).join("sequences").exists());
    // What is the recording's own place is so by name, too.
    ralf(["segment", &dataset.path, "--model", &model, "-o", &dataset.path]).exits(0);
    assert!(dataset.file("camera_front/segmentation/000002.png").exists());
}

/// An image of one colour.
fn grey(value: u8) -> Vec<u8> {
    let mut pixels = tiny_skia::Pixmap::new(160, 120).unwrap();
    pixels.fill(tiny_skia::Color::from_rgba8(value, value, value, 255));
    pixels.encode_png().unwrap()
}

/// What somebody has linked into a store, or into the recording that takes it, is not written to; what is only read may
/// be linked from anywhere.
#[cfg(unix)]
#[test]
fn nothing_is_written_through_a_link_that_leads_out() {
    use std::os::unix::fs::symlink;
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() }).with_camera(2);
    let (model, victim) = (colours(&dataset), dataset.beside("victim"));
    fs::create_dir(&victim).unwrap();
    let [classes, camera] = ["camera_front/segmentation", "camera_front"];
    for (link, target) in [(classes, "victim"), (classes, "nowhere"), (camera, "moved")] {
        let link = dataset.file(link);
        if target == "moved" {
            fs::rename(&link, dataset.beside(target)).unwrap();
        }
        symlink(dataset.beside(target), &link).unwrap();
        let target = dataset.beside(target);
        let is_there = Path::new(&target).exists();
        let before = is_there.then(|| tree(&target));
        let refused = ralf(["segment", &dataset.path, "--model", &model]).exits(1);
        refused.says(["expected -o FOLDER", "camera_front", "link: expected a folder", "found a link to"]);
        assert!(Path::new(&target).exists() == is_there && is_there.then(|| tree(&target)) == before);
        if link.ends_with("segmentation") {
            fs::remove_file(link).unwrap();
        }
    }
    // Whose camera lies on another disk is read, and what belongs to it is written elsewhere.
    ralf(["segment", &dataset.path, "--model", &model, "-o", &dataset.beside("classes")]).exits(0);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
}

#[cfg(unix)]
#[test]
fn depth_among_labels_goes_through_no_link_that_leads_out() {
    use network::{FLOAT, conv, onnx, weights};
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() }).with_camera(2);
    let (model, victim) = (dataset.beside("depth.onnx"), dataset.beside("victim"));
    let [image, depth] = [("image", FLOAT, &[1, 3, 0, 0][..]), ("depth", FLOAT, &[1, 1, 0, 0][..])];
    let red = weights("w", &[1, 3, 1, 1], &[1.0, 0.0, 0.0]);
    fs::write(&model, onnx(&[conv("depth", 0)], &[red], &[image], &[depth])).unwrap();
    let card = CARD.split("classes").next().unwrap().to_owned() + "output = \"depth\"\n";
    fs::write(dataset.beside("depth.toml"), card).unwrap();
    let label = || ralf(["label", &dataset.path, "-o", &dataset.out, "--depth-model", &model]);
    for folder in [&victim, &dataset.out] {
        fs::create_dir(folder).unwrap();
    }
    let link = format!("{}/depth", dataset.out);
    std::os::unix::fs::symlink(&victim, &link).unwrap();
    label().exits(1).ends_with_error(["out/depth: link: expected a folder", "victim"]);
    assert_eq!(fs::read_dir(&victim).unwrap().count(), 0);
    fs::remove_file(&link).unwrap();
    label().exits(0);
    assert_eq!(fs::read_dir(&link).unwrap().count(), 1);
    // Nor does that of the recording itself: another place is asked for.
    let own = dataset.file("camera_front/depth");
    fs::remove_dir_all(&own).unwrap();
    std::os::unix::fs::symlink(&victim, own).unwrap();
    let depth = ralf(["depth", &dataset.path, "--depth-model", &model]).exits(1);
    depth.ends_with_error([
        "expected -o FOLDER, for ",
        "camera_front/depth: link: expected a folder",
        "victim",
    ]);
    assert_eq!(fs::read_dir(&victim).unwrap().count(), 0);
}

#[test]
fn files_of_which_nothing_tells_whose_they_are_do_not_become_a_networks() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    let model = colours(&dataset);
    fs::create_dir(dataset.file("camera_front/segmentation")).unwrap();
    dataset.put("camera_front/segmentation/000001.png", grey(10));
    let refused = ralf(["segment", &dataset.path, "--model", &model]).exits(1);
    refused.says([
        "segmentation.toml: network: expected",
        "or another folder",
        "camera_front/segmentation/000001.png",
    ]);
    assert!(!Path::new(&dataset.path).join("segmentation.toml").exists());
}

#[test]
fn what_is_wrong_with_network_card_and_store_is_named() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    let model = colours(&dataset);
    let card = dataset.beside("colours.toml");
    let segment = || ralf(["segment", &dataset.path, "--model", &model]).exits(1);
    fs::write(&card, CARD.replace("id = 51", "id = 7")).unwrap();
    segment().says(["colours.toml: classes: expected", "found 7 of `wall`"]);
    fs::remove_file(&card).unwrap();
    segment().says(["colours.toml: not found", "cityscapes"]);
    fs::write(&card, CARD).unwrap();
    let store = dataset.beside("classes");
    fs::create_dir_all(&store).unwrap();
    fs::write(format!("{store}/segmentation.toml"), "network = \"another\"\n").unwrap();
    let refused = ralf(["segment", &dataset.path, "--model", &model, "-o", &store]).exits(1);
    refused
        .says(["segmentation.toml: network: expected segmentation of the network", "found that of another"]);
}

/// What is typed beside the recording is found from every other folder: by the commands that follow, and by a run that
/// goes on.
#[test]
fn a_store_and_a_trajectory_that_are_named_from_their_folder_are_found_from_another() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    let folder = dataset.beside("");
    colours(&dataset);
    fs::write(dataset.beside("poses.tum"), "1600000000 0 0 0 0 0 0 1\n1600000009 18 0 0 0 0 0 1\n").unwrap();
    let here = |arguments: &str| {
        Ran::of(&program().current_dir(&folder).args(arguments.split(' ')).output().unwrap())
    };
    here("segment dataset --model colours.onnx -o classes").exits(0);
    here("label dataset -o out --segmentation classes --trajectory poses.tum").exits(0);
    here("export dataset out --to npz -o near").exits(0);
    let labels = dataset.result("plausibility.parquet");
    let made = fs::metadata(&labels).unwrap().modified().unwrap();
    let [poses, classes, far] = ["poses.tum", "classes", "far"].map(|name| dataset.beside(name));
    let whole = ["--segmentation", &classes, "--trajectory", &poses];
    ralf(["label", &dataset.path, "-o", &dataset.out, whole[0], whole[1], whole[2], whole[3]]).exits(0);
    assert_eq!(fs::metadata(&labels).unwrap().modified().unwrap(), made, "nothing has changed");
    fs::rename(&classes, dataset.beside("used")).unwrap();
    ralf(["export", &dataset.path, &dataset.out, "--to", "npz", "-o", &far]).exits(0);
    fs::write(&poses, "1600000000 0 0 0 0 0 0 1\n1600000009 9 0 0 0 0 0 1\n").unwrap();
    let changed =
        ralf(["export", &dataset.path, &dataset.out, "--to", "npz", "-o", &far, "--force"]).exits(1);
    changed.says(["poses.tum: expected what was labelled"]);
}
