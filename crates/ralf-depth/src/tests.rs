//! Whole estimates with tiny networks, worked out by hand, and files of every wrong kind.

use crate::testing::{FLOAT, INT64, Value, channel_sum, conv, node, onnx, weights};
use crate::{DepthEstimator, OnnxModel};
use ralf::sensors::{CameraImage, DepthOutput};
use tempfile::TempDir;

/// Fed as they are: value / 1 - 0, / 1.
const PLAIN: &str = "input = { width = 4, height = 2 }\nfit = \"stretch\"\nchannels = \"rgb\"\ndivide_by = 1\n\
                     mean = [0, 0, 0]\nstd = [1, 1, 1]\noutput = \"depth\"\n";

/// `PLAIN` with some keys replaced by those of `lines`.
fn card(lines: &str) -> String {
    let key = |line: &str| line.split(' ').next().unwrap_or_default().to_owned();
    let kept = PLAIN.lines().filter(|line| !lines.lines().any(|own| key(own) == key(line)));
    format!("{}\n{lines}", kept.collect::<Vec<_>>().join("\n"))
}

fn load(network: &[u8], card: &str) -> Result<OnnxModel, String> {
    let folder = TempDir::new().unwrap();
    let model = folder.path().join("net.onnx");
    std::fs::write(&model, network).unwrap();
    std::fs::write(folder.path().join("net.toml"), card).unwrap();
    OnnxModel::load(&model, None).map_err(|error| error.to_string())
}

fn view(width: usize, height: usize, pixel: impl Fn(usize, usize) -> [u8; 3]) -> CameraImage {
    let rgb = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
    CameraImage { width, height, rgb }
}

fn estimate(network: &[u8], card: &str, view: &CameraImage) -> Vec<f32> {
    let depth = load(network, card).unwrap().estimate(view, 500.0).unwrap();
    assert_eq!((depth.width, depth.height), (view.width, view.height));
    depth.values
}

fn close(found: &[f32], expected: &[f32]) {
    assert_eq!(found.len(), expected.len());
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() < 1e-4 * e.abs().max(1.0), "found {found:?}, expected {expected:?}");
    }
}

/// `depth(x) = red(x - 1)`, 0 at the left edge.
fn shift() -> Vec<u8> {
    let mut kernel = [0.0; 9];
    kernel[0] = 1.0;
    onnx(
        &[conv("depth", 1)],
        &[weights("w", &[1, 3, 1, 3], &kernel)],
        &[("image", FLOAT, &[1, 3, 0, 0])],
        &[("depth", FLOAT, &[1, 1, 0, 0])],
    )
}

#[test]
fn channels_are_ordered_divided_and_normalised() {
    let view = view(4, 2, |x, y| [10 * x as u8, 100, y as u8]);
    let pixels = || (0..2).flat_map(|y| (0..4).map(move |x| (10.0 * x as f32, 100.0, y as f32)));
    let plain: Vec<f32> = pixels().map(|(r, g, b)| r + 2.0 * g + 50.0 * b).collect();
    close(&estimate(&channel_sum([1.0, 2.0, 50.0]), PLAIN, &view), &plain);
    let settings = "channels = \"bgr\"\ndivide_by = 10\nmean = [0.5, 1, 2]\nstd = [0.5, 2, 4]";
    let fed: Vec<f32> = pixels()
        .map(|(r, g, b)| {
            (b / 10.0 - 0.5) / 0.5 + 2.0 * ((g / 10.0 - 1.0) / 2.0) + 50.0 * ((r / 10.0 - 2.0) / 4.0)
        })
        .collect();
    close(&estimate(&channel_sum([1.0, 2.0, 50.0]), &card(settings), &view), &fed);
}

#[test]
fn flip_is_the_mean_with_the_mirrored_estimate_of_the_mirror_image() {
    let view = view(4, 2, |x, _| [[10, 20, 40, 80][x], 0, 0]);
    close(&estimate(&shift(), PLAIN, &view)[..4], &[0.0, 10.0, 20.0, 40.0]);
    // Mirrored, the right neighbour comes through: (left + right) / 2.
    close(&estimate(&shift(), &card("flip = true"), &view)[..4], &[10.0, 25.0, 50.0, 20.0]);
}

#[test]
fn views_are_resized_to_the_network_and_back() {
    // Two columns of the view to one of the network: (0.75 * 2 pixels, 0.25 * the next) / 1.75 at the edge.
    let view = view(8, 4, |x, _| [if x < 4 { 0 } else { 70 }, 0, 0]);
    let depth = estimate(&channel_sum([1.0, 0.0, 0.0]), PLAIN, &view);
    // Columns of the network: 0, 1/8 of 70, 7/8 of 70, 70; back by thirds and quarters: 3/4 and 1/4.
    let expected = [0.0, 2.1875, 6.5625, 21.875, 48.125, 63.4375, 67.8125, 70.0];
    close(&depth, &expected.repeat(4));
    let scaled = card("input = { size = 2, multiple_of = 2, side = \"short\" }");
    close(&estimate(&channel_sum([1.0, 0.0, 0.0]), &scaled, &view), &depth);
}

#[test]
fn squares_are_estimated_apart_and_blended() {
    let view = view(8, 4, |x, _| [8 + x as u8, 0, 0]);
    let squares = "input = { width = 4, height = 4 }\nfit = \"squares\"";
    let expected: Vec<f32> = (0..4).flat_map(|_| (8..16).map(|red| red as f32)).collect();
    for output in ["depth", "disparity", "metric"] {
        let card = card(&format!("{squares}\noutput = \"{output}\""));
        close(&estimate(&channel_sum([1.0, 0.0, 0.0]), &card, &view), &expected);
    }
    let tall = CameraImage { width: 4, height: 8, ..view };
    let error = load(&channel_sum([1.0; 3]), &card(squares)).unwrap().estimate(&tall, 1.0).unwrap_err();
    assert!(error.to_string().contains("at least as wide as high"), "{error}");
}

#[test]
fn padding_is_cut_off_and_canonical_depth_follows_the_focal_length() {
    let view = view(8, 2, |x, y| [(x / 2 + 4 * y) as u8, 0, 0]);
    // 8 x 2 fits into 4 x 4 as 4 x 1 in row 1; the colour of the rest would show in `depth`.
    let settings = "input = { width = 4, height = 4 }\nfit = { pad = [255, 0, 0] }\noutput = \"metric\"";
    let raw = estimate(&channel_sum([1.0, 0.0, 0.0]), &card(settings), &view);
    assert!(raw.iter().all(|value| (2.0..6.0).contains(value)), "{raw:?}");
    // One network pixel covers two of the view: 500 px become 250, 250 / 1000 of the canonical camera's.
    let canonical = card(&format!("{settings}\ncanonical_focal = 1000"));
    let metric = estimate(&channel_sum([1.0, 0.0, 0.0]), &canonical, &view);
    close(&metric, &raw.iter().map(|value| value / 4.0).collect::<Vec<_>>());
    let model = load(&channel_sum([1.0; 3]), &canonical).unwrap();
    assert!(model.estimate(&view, f64::NAN).unwrap_err().to_string().contains("above 0 px, found NaN"));
}

#[test]
fn outputs_may_lack_the_leading_sizes_of_one() {
    let view = view(4, 2, |x, _| [x as u8, 0, 0]);
    for (axes, shape) in [(&[0_u64] as &[u64], &[1_u64, 2, 4] as &[u64]), (&[0, 1], &[2, 4])] {
        let network = onnx(
            &[conv("sum", 0), node("Squeeze", &["sum"], "depth", &[("axes", axes)])],
            &[weights("w", &[1, 3, 1, 1], &[1.0, 0.0, 0.0])],
            &[("image", FLOAT, &[1, 3, 2, 4])],
            &[("depth", FLOAT, shape)],
        );
        close(&estimate(&network, PLAIN, &view), &[0.0, 1.0, 2.0, 3.0].repeat(2));
    }
}

#[test]
fn the_fingerprint_is_the_networks_and_the_cards() {
    let print = |network: &[u8], card: &str| load(network, card).unwrap().fingerprint().to_owned();
    let own = print(&channel_sum([1.0; 3]), PLAIN);
    assert_eq!(own.len(), 64);
    assert_eq!(own, print(&channel_sum([1.0; 3]), &format!("# a remark\n{PLAIN}flip = false")));
    assert_ne!(own, print(&channel_sum([1.0, 1.0, 2.0]), PLAIN));
    assert_ne!(own, print(&channel_sum([1.0; 3]), &card("flip = true")));
    assert_eq!(load(&channel_sum([1.0; 3]), PLAIN).unwrap().output(), DepthOutput::Depth);
}

#[test]
fn estimates_are_the_same_side_by_side() {
    let view = view(64, 48, |x, y| [(x * y) as u8, x as u8, y as u8]);
    let model = load(&shift(), &card("input = { width = 33, height = 21 }\nflip = true")).unwrap();
    let alone = model.estimate(&view, 1.0).unwrap();
    std::thread::scope(|scope| {
        let estimates: Vec<_> = (0..4).map(|_| scope.spawn(|| model.estimate(&view, 1.0).unwrap())).collect();
        estimates.into_iter().for_each(|estimate| assert_eq!(estimate.join().unwrap(), alone));
    });
}

/// The one-operator networks that don't go with `PLAIN`.
fn wrong(input: &[Value<'_>], output: &[Value<'_>]) -> Vec<u8> {
    onnx(&[conv("depth", 0)], &[weights("w", &[1, 3, 1, 1], &[1.0; 3])], input, output)
}

#[test]
fn networks_that_the_card_does_not_describe_are_refused() {
    let image: Value<'_> = ("image", FLOAT, &[1, 3, 2, 4]);
    let depth: Value<'_> = ("depth", FLOAT, &[1, 1, 2, 4]);
    let colours =
        onnx(&[node("Relu", &["image"], "depth", &[])], &[], &[image], &[("depth", FLOAT, &[1, 3, 2, 4])]);
    let scaled = card("input = { size = 2, multiple_of = 2, side = \"short\" }");
    let named = card("output_name = \"normals\"");
    for (network, card, parts) in [
        (
            wrong(&[("image", FLOAT, &[1, 3, 4])], &[depth]),
            PLAIN,
            ["input `image`", "found float32 [1, 3, 4]"],
        ),
        (
            wrong(&[("image", FLOAT, &[1, 1, 2, 4])], &[depth]),
            PLAIN,
            ["expected float32 [1, 3, 2, 4], as the card says", "found float32 [1, 1, 2, 4]"],
        ),
        (
            wrong(&[("image", FLOAT, &[2, 3, 2, 4])], &[depth]),
            PLAIN,
            ["input `image`", "found float32 [2, 3, 2, 4]"],
        ),
        (wrong(&[("image", FLOAT, &[1, 3, 48, 48])], &[depth]), PLAIN, ["[1, 3, 2, 4]", "[1, 3, 48, 48]"]),
        (wrong(&[("image", FLOAT, &[1, 2, 4, 3])], &[depth]), PLAIN, ["input `image`", "[1, 2, 4, 3]"]),
        (wrong(&[image], &[depth]), &scaled, ["float32 [1, 3, H, W] of free H and W", "[1, 3, 2, 4]"]),
        (
            wrong(&[("image", INT64, &[1, 3, 2, 4])], &[depth]),
            PLAIN,
            ["input `image`", "found other than float32"],
        ),
        (
            wrong(&[image, ("focal", FLOAT, &[1])], &[depth]),
            PLAIN,
            ["inputs: expected one", "2: `image`, `focal`"],
        ),
        (
            colours,
            PLAIN,
            ["output `depth`: expected float32 [1, 1, H, W], [1, H, W] or", "found float32 [1, 3, 2, 4]"],
        ),
        (
            wrong(&[image], &[depth, image]),
            PLAIN,
            ["outputs: expected one, or the card's `output_name`", "`image`"],
        ),
        (wrong(&[image], &[depth]), &named, ["expected `normals`, as the card says", "found `depth`"]),
    ] {
        let error = load(&network, card).expect_err(parts[0]);
        assert!(parts.iter().all(|part| error.contains(part)), "{error}\nlacks one of {parts:?}");
        assert!(error.contains("net.onnx: "), "{error}");
    }
    assert!(load(&wrong(&[image], &[depth, image]), &card("output_name = \"depth\"")).is_ok());
}

#[test]
fn files_that_are_no_networks_are_refused() {
    let network = channel_sum([1.0; 3]);
    let unknown = onnx(
        &[node("NoSuchOperator", &["image"], "depth", &[])],
        &[],
        &[("image", FLOAT, &[1, 3, 2, 4])],
        &[("depth", FLOAT, &[1, 1, 2, 4])],
    );
    for (bytes, part) in [
        (b"PK\x03\x04 certainly no network".to_vec(), "cannot load it as an ONNX network"),
        (b"{\"a\": 1}".to_vec(), "cannot load it as an ONNX network"),
        (vec![], "cannot load it as an ONNX network"),
        (b"RTEN\x02\x00\x00\x00".to_vec(), "cannot load it as an ONNX network"),
        (unknown, "NoSuchOperator"),
    ] {
        let error = load(&bytes, PLAIN).unwrap_err();
        assert!(error.contains(part) && error.contains("net.onnx"), "{error}");
    }
    for length in 0..network.len() {
        // A cut that ends with a whole field can still be a network; none may estimate other than the whole.
        let Ok(model) = load(&network[..length], PLAIN) else { continue };
        let view = view(4, 2, |x, _| [x as u8, 1, 2]);
        let cut = model.estimate(&view, 1.0).map(|depth| depth.values);
        assert!(cut.is_err() || cut.unwrap() == estimate(&network, PLAIN, &view), "cut to {length}");
    }
    let missing = OnnxModel::load("nowhere/net.onnx".as_ref(), None).unwrap_err();
    assert!(missing.to_string().starts_with("nowhere/net.onnx: "), "{missing}");
}

#[test]
fn outputs_that_are_no_depth_are_errors() {
    let then = |operator: &str, attributes: &[(&str, &[u64])], factor: f32| {
        onnx(
            &[conv("sum", 0), node(operator, &["sum"], "depth", attributes)],
            &[weights("w", &[1, 3, 1, 1], &[factor, 0.0, 0.0])],
            &[("image", FLOAT, &[1, 3, 2, 4])],
            &[("depth", FLOAT, &[0, 0, 0, 0])],
        )
    };
    let pool: &[(&str, &[u64])] = &[("kernel_shape", &[1, 2]), ("strides", &[1, 2])];
    let view = view(4, 2, |x, y| [(x + 4 * y) as u8, 0, 0]);
    for (network, part) in [
        (then("Sqrt", &[], -1.0), "output `depth`: expected finite values, found NaN in row 0, column 1"),
        (then("Log", &[], 1.0), "found -inf in row 0, column 0"),
        (
            then("MaxPool", pool, 1.0),
            "output `depth`: expected [1, 1, 2, 4] or the same smaller, found [1, 1, 2, 2]",
        ),
    ] {
        let error = load(&network, PLAIN).unwrap().estimate(&view, 1.0).unwrap_err().to_string();
        assert!(error.contains(part), "{error} lacks {part}");
    }
    // Half of the resolution, in the same proportions, is depth.
    let half: &[(&str, &[u64])] = &[("kernel_shape", &[2, 2]), ("strides", &[2, 2])];
    close(&estimate(&then("MaxPool", half, 1.0), PLAIN, &view), &[5.0, 5.5, 6.5, 7.0].repeat(2));
}

#[test]
fn absurd_attributes_are_errors_even_where_the_runtime_panics() {
    let view = view(4, 2, |x, _| [x as u8, 0, 0]);
    for (kernel, strides, pads) in [
        ([1, 1], [0, 0], [0; 4]),
        ([0, 0], [1, 1], [0; 4]),
        ([9, 9], [1, 1], [0; 4]),
        ([u64::MAX; 2], [1, 1], [0; 4]),
        // rten adds these up without a look at the sum.
        ([1, 1], [1, 1], [u64::MAX / 4; 4]),
    ] {
        let attributes: &[(&str, &[u64])] =
            &[("kernel_shape", &kernel), ("strides", &strides), ("pads", &pads)];
        let network = onnx(
            &[conv("sum", 0), node("MaxPool", &["sum"], "depth", attributes)],
            &[weights("w", &[1, 3, 1, 1], &[1.0; 3])],
            &[("image", FLOAT, &[1, 3, 0, 0])],
            &[("depth", FLOAT, &[0, 0, 0, 0])],
        );
        let estimate = load(&network, PLAIN)
            .and_then(|model| model.estimate(&view, 1.0).map_err(|error| error.to_string()));
        assert!(estimate.unwrap_err().contains("net.onnx: rten "), "{attributes:?}");
    }
}
