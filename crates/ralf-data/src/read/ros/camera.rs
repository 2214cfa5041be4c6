//! Cameras from `sensor_msgs/CameraInfo`.

use nalgebra::Matrix3;
use ralf::sensors::Intrinsics;
use ralf_ros::message::{CameraInfo, RegionOfInterest};
use ralf_ros::tf::SAME_PLACE;

/// The camera model of raw images, or of rectified ones. The error is what was expected and what was found.
///
/// | distortion model | becomes |
/// | --- | --- |
/// | `plumb_bob` k1 k2 p1 p2 k3 | pinhole with the same |
/// | `rational_polynomial` k1 k2 p1 p2 k3 k4 k5 k6 | the same, if k4 to k6 are 0; else refused |
/// | `equidistant` or `fisheye` k1 k2 k3 k4 | Kannala-Brandt with the same |
/// | none, or all 0 | pinhole without distortion |
pub(super) fn intrinsics(info: &CameraInfo, rectified: bool) -> Result<Intrinsics, (String, String)> {
    whole_image(info)?;
    let [fx, skew, cx, a, fy, cy, b, c, one] = if rectified {
        let [p0, p1, p2, _, p4, p5, p6, _, p8, p9, p10, _] = info.p;
        [p0, p1, p2, p4, p5, p6, p8, p9, p10]
    } else {
        info.k
    };
    let name = if rectified { "P" } else { "K" };
    let plain = skew == 0.0 && a == 0.0 && b == 0.0 && c == 0.0 && one == 1.0 && fx > 0.0 && fy > 0.0;
    if !plain || ![fx, fy, cx, cy].iter().all(|value| value.is_finite()) {
        let expected = format!("{name} = fx, 0, cx; 0, fy, cy; 0, 0, 1 with fx and fy above 0");
        return Err((expected, format!("{fx}, {skew}, {cx}; {a}, {fy}, {cy}; {b}, {c}, {one}")));
    }
    let (focal, center) = ([fx, fy], [cx, cy]);
    if rectified || info.d.iter().all(|value| *value == 0.0) && !is_fisheye(info) {
        return Ok(Intrinsics::Pinhole { focal, center, distortion: [0.0; 5] });
    }
    let refused =
        |expected: &str| Err((expected.to_owned(), format!("`{}` with {:?}", info.distortion_model, info.d)));
    match (info.distortion_model.as_str(), info.d.as_slice()) {
        ("plumb_bob" | "rational_polynomial", &[k1, k2, p1, p2, k3]) => {
            Ok(Intrinsics::Pinhole { focal, center, distortion: [k1, k2, p1, p2, k3] })
        }
        ("rational_polynomial", &[k1, k2, p1, p2, k3, k4, k5, k6, ..]) => {
            if [k4, k5, k6] != [0.0; 3] || info.d[8..].iter().any(|value| *value != 0.0) {
                return refused(
                    "k4, k5, k6 and all that follows to be 0 (rectified images have no distortion)",
                );
            }
            Ok(Intrinsics::Pinhole { focal, center, distortion: [k1, k2, p1, p2, k3] })
        }
        (_, &[k1, k2, k3, k4]) if is_fisheye(info) => {
            Ok(Intrinsics::KannalaBrandt { focal, center, distortion: [k1, k2, k3, k4] })
        }
        _ => refused("plumb_bob with 5, rational_polynomial with 8 or equidistant with 4 coefficients"),
    }
}

/// What a calibration says of where the camera of its rectified images is, and is left to the tree of frames: some
/// drivers name the frame of the raw image there, or of a pair's first camera, and some that of the rectified image
/// itself.
pub(super) fn left_to_frames(info: &CameraInfo) -> Option<String> {
    let rectified_from_raw = Matrix3::from_row_slice(&info.r);
    // Drivers without a rectification leave it at zero.
    let is_told = rectified_from_raw != Matrix3::zeros();
    let turn = ((rectified_from_raw.trace() - 1.0) / 2.0).clamp(-1.0, 1.0).acos();
    let [right, down] = [0.0 - info.p[3] / info.p[0], 0.0 - info.p[7] / info.p[5]];
    let [metres, radians] = SAME_PLACE;
    let turned = (is_told && turn > radians).then(|| format!("turned by {:.1} deg (`R`)", turn.to_degrees()));
    let moved = (right.hypot(down) > metres)
        .then(|| format!("seen from {right:.3} m to the right and {down:.3} m below (`P`)"));
    let told: Vec<String> = turned.into_iter().chain(moved).collect();
    let told = (!told.is_empty()).then(|| told.join(" and "))?;
    Some(format!("by its calibration rectified images are {told}, which is not applied"))
}

/// Whether two calibrations are the same, whenever they were sent; numbers that are none are as good as each other.
pub(super) fn is_same(a: &CameraInfo, b: &CameraInfo) -> bool {
    let same = |a: &[f64], b: &[f64]| {
        a.len() == b.len() && a.iter().zip(b).all(|(a, b)| a == b || a.is_nan() && b.is_nan())
    };
    let all = [(&a.d[..], &b.d[..]), (&a.k, &b.k), (&a.r, &b.r), (&a.p, &b.p)];
    let whole = |info: &CameraInfo| {
        (info.height, info.width, info.distortion_model.clone(), info.binning_x, info.binning_y, info.roi)
    };
    whole(a) == whole(b) && all.into_iter().all(|(a, b)| same(a, b))
}

fn is_fisheye(info: &CameraInfo) -> bool {
    matches!(info.distortion_model.as_str(), "equidistant" | "fisheye")
}

/// Refuses calibrations of another image than the one that is published.
fn whole_image(info: &CameraInfo) -> Result<(), (String, String)> {
    let RegionOfInterest { x_offset, y_offset, height, width, .. } = info.roi;
    let whole = (width == 0 || width == info.width) && (height == 0 || height == info.height);
    if (x_offset, y_offset) == (0, 0) && whole && info.binning_x <= 1 && info.binning_y <= 1 {
        return Ok(());
    }
    let found = format!("binning {} x {} and {:?}", info.binning_x, info.binning_y, info.roi);
    Err(("the calibration of a whole image without binning".to_owned(), found))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn info(model: &str, d: &[f64]) -> CameraInfo {
        CameraInfo {
            width: 640,
            height: 480,
            distortion_model: model.to_owned(),
            d: d.to_vec(),
            k: [500.0, 0.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0],
            p: [400.0, 0.0, 300.0, 0.0, 0.0, 410.0, 200.0, 0.0, 0.0, 0.0, 1.0, 0.0],
            ..CameraInfo::default()
        }
    }

    #[test]
    fn each_model_becomes_one_of_ours() {
        let (focal, center) = ([500.0, 510.0], [320.0, 240.0]);
        let pinhole = |distortion| Ok(Intrinsics::Pinhole { focal, center, distortion });
        let five = [0.1, 0.2, 0.3, 0.4, 0.5];
        assert_eq!(intrinsics(&info("plumb_bob", &five), false), pinhole(five));
        assert_eq!(intrinsics(&info("", &[]), false), pinhole([0.0; 5]));
        let eight = [0.1, 0.2, 0.3, 0.4, 0.5, 0.0, 0.0, 0.0];
        assert_eq!(intrinsics(&info("rational_polynomial", &eight), false), pinhole(five));
        let fisheye = Intrinsics::KannalaBrandt { focal, center, distortion: [0.1, 0.2, 0.3, 0.4] };
        assert_eq!(intrinsics(&info("equidistant", &[0.1, 0.2, 0.3, 0.4]), false), Ok(fisheye));
        let straight = Intrinsics::KannalaBrandt { focal, center, distortion: [0.0; 4] };
        assert_eq!(intrinsics(&info("equidistant", &[0.0; 4]), false), Ok(straight));
        let rectified =
            Intrinsics::Pinhole { focal: [400.0, 410.0], center: [300.0, 200.0], distortion: [0.0; 5] };
        assert_eq!(intrinsics(&info("plumb_bob", &five), true), Ok(rectified));
    }

    #[test]
    fn what_a_rectification_moves_is_told() {
        let (sin, cos) = 0.05_f64.sin_cos();
        let turned = [cos, 0.0, sin, 0.0, 1.0, 0.0, -sin, 0.0, cos];
        let alike = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let told = |r: [f64; 9], shift: [f64; 2]| {
            let mut info = CameraInfo { r, ..info("plumb_bob", &[0.0; 5]) };
            [info.p[3], info.p[7]] = shift;
            left_to_frames(&info)
        };
        assert_eq!(
            [told(alike, [0.0; 2]), told([0.0; 9], [0.0; 2]), told([f64::NAN; 9], [-0.4, 0.0])],
            [(); 3].map(|()| None)
        );
        let begin = "by its calibration rectified images are";
        let expected = format!("{begin} turned by 2.9 deg (`R`), which is not applied");
        assert_eq!(told(turned, [0.0; 2]), Some(expected));
        let shift = "seen from 0.500 m to the right and 0.000 m below (`P`), which is not applied";
        assert_eq!(told(alike, [-200.0, 0.0]), Some(format!("{begin} {shift}")));
        assert_eq!(told(turned, [-200.0, 0.0]), Some(format!("{begin} turned by 2.9 deg (`R`) and {shift}")));
    }

    #[test]
    fn calibrations_are_compared_number_by_number() {
        let header = ralf_ros::message::Header { stamp_ns: 7, ..Default::default() };
        let first = info("plumb_bob", &[f64::NAN, 0.0]);
        assert!(is_same(&first, &CameraInfo { header, ..first.clone() }));
        for d in [&[0.5, 0.0][..], &[f64::NAN, 0.1], &[f64::NAN]] {
            assert!(!is_same(&first, &info("plumb_bob", d)), "{d:?}");
        }
        assert!(!is_same(&first, &info("equidistant", &[f64::NAN, 0.0])));
        assert!(!is_same(&first, &CameraInfo { width: 641, ..first.clone() }));
    }

    #[test]
    fn what_no_model_holds_is_refused() {
        let eight = [0.1, 0.2, 0.3, 0.4, 0.5, 0.0, 0.0, 0.7];
        let error = |info: &CameraInfo| intrinsics(info, false).unwrap_err().0;
        assert!(error(&info("rational_polynomial", &eight)).contains("k4, k5, k6"));
        assert!(error(&info("plumb_bob", &[0.1])).contains("plumb_bob with 5"));
        let skewed = CameraInfo { k: [500.0, 1.0, 320.0, 0.0, 510.0, 240.0, 0.0, 0.0, 1.0], ..info("", &[]) };
        assert!(error(&skewed).contains("K = fx, 0, cx"));
        assert!(error(&CameraInfo { binning_x: 2, ..info("", &[]) }).contains("binning"));
        assert!(error(&CameraInfo { k: [0.0; 9], ..info("", &[]) }).contains("above 0"));
    }
}
