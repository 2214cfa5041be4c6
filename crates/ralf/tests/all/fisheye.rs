//! Camera models against real calibrations: the folder `fisheye` of RALF_TEST_DATA.
use ralf::sensors::Intrinsics;
use ralf::space::{Point, Vector};
use std::path::{Path, PathBuf};

const SKIPPED: &str = "skipped: RALF_TEST_DATA is not set";

fn folder() -> Option<PathBuf> {
    std::env::var_os("RALF_TEST_DATA").map(|root| Path::new(&root).join("fisheye"))
}

/// The lens of an OCamCalib file, in the order that its README gives, and the image's height and width.
fn ocamcalib(path: &Path) -> (Intrinsics, [usize; 2]) {
    let text = std::fs::read_to_string(path).unwrap();
    let lines = text.lines().filter(|line| !line.starts_with('#') && !line.trim().is_empty());
    let rows: Vec<Vec<f64>> =
        lines.map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect()).collect();
    let intrinsics = Intrinsics::Scaramuzza {
        polynomial: rows[0][1..].to_vec(),
        inverse_polynomial: rows[1][1..].to_vec(),
        center: [rows[2][0], rows[2][1]],
        affine: [rows[3][0], rows[3][1], rows[3][2]],
    };
    (intrinsics, [rows[4][0] as usize, rows[4][1] as usize])
}

fn without_direct(intrinsics: &Intrinsics) -> Intrinsics {
    let Intrinsics::Scaramuzza { inverse_polynomial, center, affine, .. } = intrinsics.clone() else {
        panic!("Scaramuzza's model, found {intrinsics:?}")
    };
    Intrinsics::Scaramuzza { polynomial: vec![], inverse_polynomial, center, affine }
}

#[test]
fn ocamcalibs_check_values() {
    let Some(folder) = folder() else { return println!("{SKIPPED}") };
    let (lens, [height, width]) = ocamcalib(&folder.join("ocamcalib/calib_results.txt"));
    assert_eq!(lens.check(width, height), Ok(()));
    let close = |found: [f64; 2], expected: [f64; 2]| {
        let distance = (found[0] - expected[0]).hypot(found[1] - expected[1]);
        assert!(distance < 1e-4, "{found:?} {expected:?}");
    };
    close(lens.project(&Point::new(1.0, 1.0, 2.0)).unwrap(), [1004.8295, 1001.1595]);
    close(lens.project(&Point::new(0.0, 0.0, 2.0)).unwrap(), [798.1757, 794.3087]);
    let direction = lens.back_project([502.0, 900.0]).unwrap().into_inner();
    assert!((direction - Vector::new(-0.5776824, 0.2059931, 0.7898417)).norm() < 1e-7, "{direction}");
    assert!((lens.focal_on_axis() - 471.4441).abs() < 1e-9);
    // Without the direct polynomial the slope of the inverse one stands in.
    assert!((without_direct(&lens).focal_on_axis() / 471.4441 - 1.0).abs() < 2e-3);
}

#[test]
fn both_polynomials_agree_over_the_whole_image() {
    let Some(folder) = folder() else { return println!("{SKIPPED}") };
    let (lens, [height, width]) = ocamcalib(&folder.join("ocamcalib/calib_results.txt"));
    // Farthest apart in the corners, 128 degrees off the axis; within 120 degrees they agree to 0.006 px.
    let error = lens.round_trip_error(width, height, 81).unwrap();
    assert!(error < 0.025, "{error} px");
    let inverse = without_direct(&lens);
    assert!(inverse.round_trip_error(width, height, 81).unwrap() < 1e-9);
    for pixel in [[-0.5, -0.5], [1599.5, 0.0], [0.0, 1599.5], [1599.5, 1599.5], [798.0, -0.5], [640.0, 410.0]]
    {
        let [a, b] = [&lens, &inverse].map(|lens| lens.back_project(pixel).unwrap().into_inner());
        assert!((a - b).norm() < 5e-5, "{pixel:?}: {a} {b}");
    }
    assert!(lens.back_project([-0.5, -0.5]).unwrap().z < -0.45, "corners look backward");
}

#[test]
fn the_surround_cameras_are_usable_by_their_inverse_polynomials_alone() {
    let Some(folder) = folder() else { return println!("{SKIPPED}") };
    for name in ["Front", "Left", "Back", "Right"] {
        let lens = pjlab(&folder.join(format!("pjlab/intrinsic/{name}.json")));
        assert_eq!(lens.check(1280, 960), Ok(()), "{name}");
        let error = lens.round_trip_error(1280, 960, 41).unwrap();
        assert!(error < 1e-8, "{name}: {error} px");
        assert!((250.0..400.0).contains(&lens.focal_on_axis()), "{name}: {}", lens.focal_on_axis());
        let side = lens.project(&Point::new(1.0, 0.0, 0.0)).unwrap();
        assert!(side[0] > 1200.0 && (side[1] - lens.center()[1]).abs() < 1.0, "{name}: {side:?}");
    }
}

/// `cam_K` has the column first where OCamCalib has the row, as the README of the data explains.
fn pjlab(path: &Path) -> Intrinsics {
    let text = std::fs::read_to_string(path).unwrap();
    let json: serde_json::Value = serde_json::from_str(&text).unwrap();
    let param = &json.as_object().unwrap().values().next().unwrap()["param"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let k = |row: usize, column: usize| number(&param["cam_K"]["data"][row][column]);
    let [c, d, e] = [k(0, 0), k(0, 1), k(1, 0)];
    let coefficients = param["cam_dist"]["data"][0].as_array().unwrap();
    Intrinsics::Scaramuzza {
        polynomial: vec![],
        inverse_polynomial: coefficients.iter().map(|b| number(b) * c).collect(),
        center: [k(1, 2), k(0, 2)],
        affine: [1.0 / c, e / c, d / c],
    }
}
