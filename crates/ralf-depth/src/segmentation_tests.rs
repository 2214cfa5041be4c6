//! Whole segmentations with tiny networks, worked out by hand, and networks of every wrong kind.

use crate::testing::{FLOAT, INT64, Value, conv, flagged, node, onnx, weights};
use crate::{Runtime, SegmentationModel};
use ralf::sensors::CameraImage;
use tempfile::TempDir;

const CLASSES: &str =
    "classes = [{ name = \"sky\", id = 0 }, { name = \"car\", id = 10 }, { name = \"wall\", id = 51 }]";

fn card(input: &str, fit: &str) -> String {
    format!(
        "input = {input}\nfit = {fit}\nchannels = \"rgb\"\ndivide_by = 1\nmean = [0, 0, 0]\nstd = [1, 1, 1]\n{CLASSES}"
    )
}

fn plain() -> String {
    card("{ width = 4, height = 2 }", "\"stretch\"")
}

fn load(network: &[u8], card: &str) -> Result<SegmentationModel, String> {
    let folder = TempDir::new().unwrap();
    let model = folder.path().join("net.onnx");
    std::fs::write(&model, network).unwrap();
    std::fs::write(folder.path().join("net.toml"), card).unwrap();
    SegmentationModel::load(Runtime::default(), &model, None).map_err(|error| error.to_string())
}

/// The score of each of so many classes is a colour: red, green, blue.
fn colours(classes: u64) -> Vec<u8> {
    let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let weights = weights("w", &[classes, 3, 1, 1], &unit[..3 * classes as usize]);
    let input: Value<'_> = ("image", FLOAT, &[1, 3, 0, 0]);
    onnx(&[conv("scores", 0)], &[weights], &[input], &[("scores", FLOAT, &[1, classes, 0, 0])])
}

/// The place of the largest colour.
fn places() -> Vec<u8> {
    let input: Value<'_> = ("image", FLOAT, &[1, 3, 0, 0]);
    let largest = flagged("ArgMax", "image", "places", &[("axis", 1), ("keepdims", 0)]);
    onnx(&[largest], &[], &[input], &[("places", INT64, &[1, 0, 0])])
}

/// The sum of the colours, as the place of a class.
fn sums() -> Vec<u8> {
    onnx(
        &[conv("places", 0)],
        &[weights("w", &[1, 3, 1, 1], &[1.0; 3])],
        &[("image", FLOAT, &[1, 3, 0, 0])],
        &[("places", FLOAT, &[1, 1, 0, 0])],
    )
}

fn view(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [u8; 3]) -> CameraImage {
    let rgb = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    CameraImage { width, height, rgb }
}

/// Sky, car and wall from left to right, a column each.
fn columns(width: usize) -> CameraImage {
    view(width, 2, |x, _| [[9, 1, 0], [2, 8, 7], [0, 0, 5]][x * 3 / width])
}

#[test]
fn the_largest_score_wins() {
    for network in [colours(3), places()] {
        let model = load(&network, &plain()).unwrap();
        let found = model.segment(&view(4, 2, |x, y| [[9, 0, 0], [0, 9, 8], [0, 0, 1]][(x + y) % 3]));
        assert_eq!(found.unwrap().ids, [0, 10, 51, 0, 10, 51, 0, 10]);
    }
    let equal = load(&colours(3), &plain()).unwrap().segment(&view(4, 2, |_, _| [7; 3])).unwrap();
    assert_eq!(equal.ids, [0; 8], "of equal ones the first");
    let places = view(4, 2, |x, y| [x as u8 % 3, 0, y as u8 * (x as u8 % 2)]);
    let found = load(&sums(), &plain()).unwrap().segment(&places).unwrap();
    assert_eq!(found.ids, [0, 10, 51, 0, 0, 51, 51, 10]);
}

#[test]
fn views_are_resized_and_padded_and_come_back_in_their_size() {
    let fixed = "{ width = 6, height = 6 }";
    for fit in ["\"stretch\"", "{ pad = [0, 255, 0] }"] {
        for network in [colours(3), places()] {
            let found = load(&network, &card(fixed, fit)).unwrap().segment(&columns(12)).unwrap();
            assert_eq!((found.width, found.height), (12, 2));
            // At the seams the colours of both sides are mixed; the middle of each third is not.
            let middles = |row: usize| [1, 6, 10].map(|column| found.ids[12 * row + column]);
            assert_eq!([middles(0), middles(1)], [[0, 10, 51]; 2], "{fit}");
        }
    }
}

#[test]
fn what_is_no_class_is_an_error() {
    let error = load(&sums(), &plain()).unwrap().segment(&view(4, 2, |x, _| [x as u8, 0, 0])).unwrap_err();
    let parts = ["net.onnx: output `places`", "from 0 to 2", "found 3 in row 0, column 3"];
    assert!(parts.iter().all(|part| error.to_string().contains(part)), "{error}");
    let pool: &[(&str, &[u64])] = &[("kernel_shape", &[1, 2]), ("strides", &[1, 2])];
    let narrow = onnx(
        &[node("MaxPool", &["image"], "scores", pool)],
        &[],
        &[("image", FLOAT, &[1, 3, 0, 0])],
        &[("scores", FLOAT, &[0, 0, 0, 0])],
    );
    let error = load(&narrow, &plain()).unwrap().segment(&columns(4)).unwrap_err().to_string();
    assert!(
        error.contains("expected [1, 3, 2, 4], [1, 2, 4] or the same smaller, found [1, 3, 2, 2]"),
        "{error}"
    );
    let logarithm = onnx(
        &[node("Log", &["image"], "scores", &[])],
        &[],
        &[("image", FLOAT, &[1, 3, 0, 0])],
        &[("scores", FLOAT, &[0, 0, 0, 0])],
    );
    let error = load(&logarithm, &plain()).unwrap().segment(&columns(4)).unwrap_err().to_string();
    assert!(error.contains("expected finite values, found -inf"), "{error}");
}

#[test]
fn networks_that_the_card_does_not_describe_are_refused() {
    let error = load(&colours(2), &plain()).unwrap_err();
    let parts = ["output `scores`: expected scores, float32 [1, 3, H, W]", "found float32 [1, 2, ?, ?]"];
    assert!(parts.iter().all(|part| error.contains(part)), "{error}");
    let named = format!("{}\noutput_name = \"logits\"", plain());
    let error = load(&places(), &named).unwrap_err();
    assert!(error.contains("outputs: expected `logits`, as the card says, found `places`"), "{error}");
    assert!(
        load(b"certainly no network", &plain()).unwrap_err().contains("cannot load it as an ONNX network")
    );
}

#[test]
fn network_and_card_are_told_by_the_fingerprint() {
    let print = |network: &[u8], card: &str| load(network, card).unwrap().fingerprint().to_owned();
    let own = print(&places(), &plain());
    assert_eq!(own, print(&places(), &format!("# a remark\n{}", plain())));
    assert_ne!(own, print(&sums(), &plain()));
    assert_ne!(own, print(&places(), &plain().replace("id = 51", "id = 50")));
}
