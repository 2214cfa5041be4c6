//! `ralf depth`, and labels with what it stored or with what a network says now.

use crate::support::{Dataset, Ran, Shape, network, program, ralf};
use std::fs;
use std::path::Path;

const CARD: &str = "input = { width = 32, height = 24 }\nfit = \"stretch\"\nchannels = \"rgb\"\ndivide_by = 255\n\
                    mean = [0, 0, 0]\nstd = [1, 1, 1]\n";

fn dataset() -> Dataset {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    fs::remove_dir_all(dataset.file("camera_front/depth")).unwrap();
    dataset
}

/// A network that takes the brightness for depth, times a factor, beside the dataset.
fn brightness(dataset: &Dataset, name: &str, factor: f32, output: &str) -> String {
    let file = dataset.beside(&format!("{name}.onnx"));
    fs::write(&file, network::channel_sum([factor; 3])).unwrap();
    fs::write(dataset.beside(&format!("{name}.toml")), format!("{CARD}output = \"{output}\"\n")).unwrap();
    file
}

fn record(out: &str) -> String {
    fs::read_to_string(format!("{out}/run.json")).unwrap()
}

#[test]
fn an_image_that_a_network_could_not_be_fed_with_is_told_and_asked_for_again() {
    let dataset = dataset();
    let model = brightness(&dataset, "net", 1.0, "depth");
    let whole = fs::read(dataset.file("camera_front/000001.png")).unwrap();
    dataset.put("camera_front/000001.png", &whole[..whole.len() / 2]);
    let label = || ralf(["label", &dataset.path, "-o", &dataset.out, "--depth-model", &model]).exits(0);
    label().says(["labelled without: 00 camera_front image 1: "]);
    let told: serde_json::Value = serde_json::from_str(&record(&dataset.out)).unwrap();
    let lacks = &told["sequences"][0]["not_read"][0];
    assert_eq!((lacks["kind"].as_str(), lacks["scan"].as_u64()), (Some("camera"), Some(1)), "{told}");
    assert!(lacks["reason"].as_str().unwrap().contains("000001.png"), "{lacks}");
    label().says(["nothing to do"]);
    fs::write(dataset.file("camera_front/000001.png"), whole).unwrap();
    label();
    assert!(!record(&dataset.out).contains("not_read"));
}

#[test]
fn no_network_runs_for_a_recording_whose_labels_have_no_place() {
    let dataset = dataset();
    let other = Dataset::of_another_drive(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    let model = brightness(&dataset, "net", 1.0, "depth");
    ralf(["label", "--no-check", &dataset.path, "-o", &dataset.out]).exits(0);
    let label = ["label", "--no-check", &other.path, "-o", &dataset.out, "--depth-model", &model];
    ralf(label).exits(1).ends_with_error(["found those of another recording, "]);
    assert!(!Path::new(&dataset.out).join("depth").exists(), "depth was computed");
}

#[test]
fn depth_of_another_image_is_not_used() {
    let dataset = dataset();
    let (model, store) = (brightness(&dataset, "net", 1.0, "depth"), dataset.beside("store"));
    ralf(["depth", &dataset.path, "--depth-model", &model, "-o", &store]).exits(0);
    let label = || ralf(["label", &dataset.path, "-o", &dataset.out, "--depth", &store]).exits(0);
    let says = label().stderr;
    assert!(!says.contains("labelled without"), "{says}");
    let png = |file: &str| fs::read(dataset.file(file)).unwrap();
    let mut other = png("camera_front/000000.png");
    // A chunk after the end changes the file, and no pixel of it.
    other.push(0);
    dataset.put("camera_front/000002.png", other);
    label().says(["labelled without: 00 camera_front image 2: ", "000002.npy: origin: ", "000002.png"]);
    assert!(record(&dataset.out).contains("of another image, or of other views"));
    // The dataset's own is compared as well.
    ralf(["depth", &dataset.path, "--depth-model", &model]).exits(0);
    dataset.put("camera_front/000001.png", [png("camera_front/000001.png"), vec![0]].concat());
    ralf(["label", &dataset.path, "-o", &dataset.out])
        .exits(0)
        .says(["labelled without: 00 camera_front image 1: "]);
}

#[test]
fn a_network_that_never_works_leaves_no_claim() {
    let dataset = dataset();
    let (broken, store) = (brightness(&dataset, "broken", f32::NAN, "depth"), dataset.beside("store"));
    ralf(["depth", &dataset.path, "--depth-model", &broken, "-o", &store]).exits(3).says(["no depth: 00: "]);
    assert!(!Path::new(&store).join("depth.toml").exists());
    let works = brightness(&dataset, "works", 1.0, "depth");
    ralf(["depth", &dataset.path, "--depth-model", &works, "-o", &store]).exits(0);
    let other = brightness(&dataset, "other", 2.0, "depth");
    let refused = ralf(["depth", &dataset.path, "--depth-model", &other, "-o", &store]).exits(1);
    refused.says(["depth.toml: network: expected"]);
}

#[test]
fn what_the_network_gives_and_what_the_sequence_says_may_not_differ_silently() {
    let dataset = dataset();
    let toml = fs::read_to_string(dataset.file("sequence.toml")).unwrap();
    dataset.put("sequence.toml", toml.clone() + "\n[depth]\noutput = \"disparity\"\n");
    let model = brightness(&dataset, "net", 1.0, "disparity");
    ralf(["depth", &dataset.path, "--depth-model", &model]).exits(0);
    let agreeing = ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).stderr;
    assert!(!agreeing.contains("[depth]"), "{agreeing}");
    dataset.put("sequence.toml", toml);
    ralf(["label", &dataset.path, "-o", &dataset.out])
        .exits(0)
        .says(["sequence.toml: [depth] output: expected `disparity`", "depth.toml, found `depth`"]);
    let refused = ralf(["depth", &dataset.path, "--depth-model", &model]).exits(1);
    refused.says(["[depth] output: expected `disparity` as the network's card says, found `depth`"]);
}

#[test]
fn views_of_different_sizes_are_refused_before_anything_is_computed() {
    let dataset = dataset();
    let toml = fs::read_to_string(dataset.file("sequence.toml")).unwrap();
    let view = |width| {
        format!(
            "[[camera.view]]\nyaw_deg = 0\npitch_deg = 0\nhorizontal_fov_deg = 50\nwidth = {width}\nheight = 20\n"
        )
    };
    dataset.put("sequence.toml", toml + &view(32) + &view(40));
    let model = brightness(&dataset, "net", f32::NAN, "depth");
    let refused = ralf(["depth", &dataset.path, "--depth-model", &model]).exits(1);
    refused.says(["views of camera_front that are alike", "32 x 20 and 40 x 20 px"]);
}

#[test]
fn a_plot_finds_the_depth_that_the_labels_were_made_with() {
    let dataset = dataset();
    let (model, store) = (brightness(&dataset, "net", 1.0, "depth"), dataset.beside("store"));
    ralf(["depth", &dataset.path, "--depth-model", &model, "-o", &store]).exits(0);
    ralf(["label", &dataset.path, "-o", &dataset.out, "--depth", &store]).exits(0);
    let picture = dataset.beside("camera.png");
    let plot = |further: &[&str]| {
        let fixed = ["plot", &dataset.path, &dataset.out, "--scan", "1", "--camera", "camera_front"];
        Ran::of(&program().args(fixed).args(["-o", &picture]).args(further).output().unwrap()).exits(0);
        fs::read(&picture).unwrap()
    };
    let named = plot(&["--depth", &store]);
    assert!(plot(&[]) == named);
    fs::remove_dir_all(&store).unwrap();
    assert!(plot(&[]) != named, "without depth");
}

#[cfg(unix)]
#[test]
fn what_is_complete_asks_for_no_right_to_write() {
    use crate::support::{as_nobody, tree};
    use std::os::unix::fs::PermissionsExt;
    let dataset = dataset();
    let model = brightness(&dataset, "net", 1.0, "depth");
    let arguments = ["label", &dataset.path, "-o", &dataset.out, "--depth-model", &model];
    ralf(arguments).exits(0);
    let Some(mut nobody) = as_nobody(&dataset) else { return println!("skipped: root without setpriv") };
    let folders: Vec<String> =
        tree(&dataset.out).into_iter().filter_map(|(name, file)| file.is_none().then_some(name)).collect();
    let allow = |mode| {
        let all = folders.iter().map(|name| Path::new(&dataset.out).join(name));
        let all = all.chain([Path::new(&dataset.out).to_owned()]);
        all.for_each(|folder| fs::set_permissions(folder, fs::Permissions::from_mode(mode)).unwrap());
    };
    let before = tree(&dataset.out);
    nobody.args(arguments);
    let mut label = || Ran::of(&nobody.output().unwrap());
    allow(0o555);
    label().exits(0).says(["nothing to do"]);
    allow(0o755);
    assert!(tree(&dataset.out) == before);
    // What would have to be written is named.
    let missing = before.keys().find(|name| name.ends_with("000001.npy")).unwrap();
    fs::remove_file(Path::new(&dataset.out).join(missing)).unwrap();
    allow(0o555);
    label().exits(1).says(["depth of 00", "Permission denied"]);
    allow(0o755);
}

#[test]
fn depth_that_is_damaged_is_computed_again_and_a_check_names_what_it_leaves_out() {
    let dataset = dataset();
    let model = brightness(&dataset, "net", 1.0, "depth");
    let compute = || ralf(["depth", &dataset.path, "--depth-model", &model]).exits(0);
    let check = || ralf(["depth", &dataset.path, "--check"]).exits(0).prints(["camera_front"]);
    compute();
    assert!(!check().stderr.contains("left out"));
    let whole = fs::read(dataset.file("camera_front/depth/000001.npy")).unwrap();
    dataset.cut("camera_front/depth/000001.npy", 100);
    check().says(["left out: 00 camera_front image 1: ", "depth/000001.npy"]);
    compute().says(["depth of 00: computed again of 1 image, for what was stored is damaged"]);
    assert!(fs::read(dataset.file("camera_front/depth/000001.npy")).unwrap() == whole);
    assert!(!check().stderr.contains("left out") && compute().stderr.is_empty());
    let image = fs::read(dataset.file("camera_front/000002.png")).unwrap();
    dataset.put("camera_front/000002.png", &image[..image.len() / 2]);
    check().says(["left out: 00 camera_front image 2: "]);
}
