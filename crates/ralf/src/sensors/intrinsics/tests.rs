use super::*;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, PI};

/// A wide camera of 800 x 600 px of each model, and how well it returns to a pixel.
fn cameras() -> [(&'static str, Intrinsics, f64); 4] {
    let pinhole = Intrinsics::Pinhole {
        focal: [420.0, 418.0],
        center: [401.3, 297.8],
        distortion: [-0.28, 0.09, 3e-4, -5e-4, -0.011],
    };
    let kannala_brandt = Intrinsics::KannalaBrandt {
        focal: [230.0, 231.0],
        center: [398.2, 303.1],
        distortion: [0.05, -0.01, 1e-3, -2e-4],
    };
    // An equidistant lens, rho = 240 theta, written as the inverse polynomial alone.
    let inverse = Intrinsics::Scaramuzza {
        polynomial: vec![],
        inverse_polynomial: vec![240.0 * FRAC_PI_2, 240.0],
        center: [303.1, 398.2],
        affine: [1.002, -0.0003, 0.0004],
    };
    // A parabolic mirror, rho = 2 f tan(theta / 2): its direct polynomial is -f + rho^2 / (4 f), exactly, and its
    // inverse the Taylor series of 2 f tan((angle + pi/2) / 2) about the horizon, cut off in the midst of its last
    // term.
    let series = [1.0, 1.0, 1.0 / 2.0, 1.0 / 3.0, 5.0 / 24.0, 2.0 / 15.0, 61.0 / 720.0, 17.0 / 630.0];
    let both = Intrinsics::Scaramuzza {
        polynomial: vec![-120.0, 0.0, 1.0 / 480.0],
        inverse_polynomial: series.iter().map(|c| 240.0 * c).collect(),
        center: [303.1, 398.2],
        affine: [1.002, -0.0003, 0.0004],
    };
    [
        ("pinhole", pinhole, 1e-8),
        ("kannala-brandt", kannala_brandt, 1e-9),
        ("inverse", inverse, 1e-9),
        ("both", both, 5.0),
    ]
}

#[test]
fn every_model_returns_to_the_pixel() {
    for (name, intrinsics, tolerance) in cameras() {
        assert_eq!(intrinsics.check(800, 600), Ok(()), "{name}");
        let error = intrinsics.round_trip_error(800, 600, 41).unwrap();
        assert!(error < tolerance, "{name}: {error} px");
    }
}

#[test]
fn the_axis_is_the_centre() {
    for (name, intrinsics, _) in cameras() {
        assert_eq!(intrinsics.project(&Point::new(0.0, 0.0, 2.0)), Some(intrinsics.center()), "{name}");
        let axis = intrinsics.back_project(intrinsics.center()).unwrap();
        assert!((axis.into_inner() - Vector::z()).norm() < 1e-12, "{name}");
        // Just off the axis a pixel is worth 1 / f; the series of the last camera is coarse there.
        let [u, v] = intrinsics.center();
        let beside = intrinsics.back_project([u + 1.0, v]).unwrap();
        assert!((beside.x * intrinsics.focal_on_axis() - 1.0).abs() < 0.01, "{name}: {beside:?}");
    }
}

#[test]
fn behind_and_at_the_camera() {
    for (name, intrinsics, _) in cameras() {
        let sees = |x, y, z| intrinsics.project(&Point::new(x, y, z)).is_some();
        assert!(!sees(0.0, 0.0, 0.0), "{name}: the centre itself");
        assert!(!sees(0.0, 0.0, -1.0), "{name}: straight behind");
        assert!(!sees(f64::NAN, 0.0, 1.0) && !sees(0.0, 0.0, f64::NAN), "{name}: nowhere");
        assert_eq!(sees(1.0, 0.2, -0.1), name != "pinhole", "{name}: slightly behind");
        assert!(intrinsics.back_project([f64::NAN, 0.0]).is_none(), "{name}");
        assert!(intrinsics.limit() <= if name == "pinhole" { FRAC_PI_2 } else { PI }, "{name}");
    }
}

proptest! {
    #[test]
    fn directions_return(yaw in -0.6..0.6, pitch in -0.5..0.5, distance in 0.1..100.0) {
        let direction = Vector::new(f64::tan(yaw), f64::tan(pitch), 1.0).normalize();
        for (name, intrinsics, _) in &cameras()[..3] {
            let pixel = intrinsics.project(&Point::from(direction * distance)).unwrap();
            let back = intrinsics.back_project(pixel).unwrap();
            prop_assert!((back.into_inner() - direction).norm() < 1e-9, "{name}: {direction:?} {back:?}");
        }
    }
}
