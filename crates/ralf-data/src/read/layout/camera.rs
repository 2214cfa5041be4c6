//! Cameras as `sequence.toml` has them, turned into those of the method, and back.

use super::raw::{CameraToml, ModelToml, ViewToml};
use super::values::{Place, degrees, pose_toml};
use crate::error::DataError;
use ralf::sensors::{Camera, Intrinsics, MOST_PIXELS, View};

/// A camera, checked.
pub(super) fn camera(place: &Place<'_>, raw: &CameraToml) -> Result<Camera, DataError> {
    size(place, "width, height", raw.width, raw.height)?;
    Ok(Camera {
        name: raw.name.clone(),
        vehicle_from_camera: place.pose(raw.translation, raw.quaternion_xyzw)?,
        width: raw.width,
        height: raw.height,
        intrinsics: match raw.model {
            ModelToml::Pinhole => {
                let ([focal, center], distortion) = (straight(place, raw)?, distortion(place, raw)?);
                Intrinsics::Pinhole { focal, center, distortion }
            }
            ModelToml::KannalaBrandt => {
                let ([focal, center], distortion) = (straight(place, raw)?, distortion(place, raw)?);
                Intrinsics::KannalaBrandt { focal, center, distortion }
            }
            ModelToml::Scaramuzza => scaramuzza(place, raw)?,
        },
        views: raw.view.iter().map(|raw| view(place, raw)).collect::<Result<_, _>>()?,
    })
}

/// A camera as the file has it.
pub(super) fn camera_toml(camera: &Camera) -> CameraToml {
    let (translation, quaternion_xyzw) = pose_toml(&camera.vehicle_from_camera);
    let raw = CameraToml {
        name: camera.name.clone(),
        translation,
        quaternion_xyzw,
        width: camera.width,
        height: camera.height,
        model: ModelToml::Pinhole,
        fx: None,
        fy: None,
        cx: None,
        cy: None,
        distortion: vec![],
        polynomial: vec![],
        inverse_polynomial: vec![],
        center: None,
        affine: None,
        view: camera.views.iter().map(view_toml).collect(),
    };
    with_lens(raw, &camera.intrinsics)
}

fn with_lens(raw: CameraToml, intrinsics: &Intrinsics) -> CameraToml {
    let straight = |raw, [fx, fy]: [f64; 2], [cx, cy]: [f64; 2], distortion: &[f64]| CameraToml {
        fx: Some(fx),
        fy: Some(fy),
        cx: Some(cx),
        cy: Some(cy),
        distortion: distortion.to_vec(),
        ..raw
    };
    match intrinsics {
        Intrinsics::Pinhole { focal, center, distortion } => straight(raw, *focal, *center, distortion),
        Intrinsics::KannalaBrandt { focal, center, distortion } => {
            let raw = CameraToml { model: ModelToml::KannalaBrandt, ..raw };
            straight(raw, *focal, *center, distortion)
        }
        Intrinsics::Scaramuzza { polynomial, inverse_polynomial, center, affine } => CameraToml {
            model: ModelToml::Scaramuzza,
            polynomial: polynomial.clone(),
            inverse_polynomial: inverse_polynomial.clone(),
            center: Some(*center),
            affine: Some(*affine),
            ..raw
        },
    }
}

/// Focal lengths and principal point.
fn straight(place: &Place<'_>, raw: &CameraToml) -> Result<[[f64; 2]; 2], DataError> {
    let get = |key: &str, value: Option<f64>| {
        let value = value.ok_or_else(|| place.error(key, "a value for this model", "none"))?;
        place.finite(key, &[value])?;
        Ok::<_, DataError>(value)
    };
    let focal = [get("fx", raw.fx)?, get("fy", raw.fy)?];
    if let Some(found) = focal.iter().find(|value| **value <= 0.0) {
        return Err(place.error("fx, fy", "values above 0", found));
    }
    Ok([focal, [get("cx", raw.cx)?, get("cy", raw.cy)?]])
}

/// All `N` coefficients; those that aren't listed are 0.
fn distortion<const N: usize>(place: &Place<'_>, raw: &CameraToml) -> Result<[f64; N], DataError> {
    let listed = place.finite("distortion", &raw.distortion)?;
    let mut all = [0.0; N];
    let Some(start) = all.get_mut(..listed.len()) else {
        return Err(place.error("distortion", &format!("up to {N} coefficients"), listed.len()));
    };
    start.copy_from_slice(listed);
    Ok(all)
}

fn scaramuzza(place: &Place<'_>, raw: &CameraToml) -> Result<Intrinsics, DataError> {
    if raw.inverse_polynomial.is_empty() {
        return Err(place.error("inverse_polynomial", "coefficients", "none"));
    }
    let missing = |key: &str| place.error(key, "a value for this model", "none");
    let center = raw.center.ok_or_else(|| missing("center"))?;
    let affine = raw.affine.ok_or_else(|| missing("affine"))?;
    place.finite("center", &center)?;
    place.finite("affine", &affine)?;
    Ok(Intrinsics::Scaramuzza {
        polynomial: place.finite("polynomial", &raw.polynomial)?.to_vec(),
        inverse_polynomial: place.finite("inverse_polynomial", &raw.inverse_polynomial)?.to_vec(),
        center,
        affine,
    })
}

fn view(place: &Place<'_>, raw: &ViewToml) -> Result<View, DataError> {
    size(place, "view: width, height", raw.width, raw.height)?;
    place.finite("view: yaw_deg, pitch_deg", &[raw.yaw_deg, raw.pitch_deg])?;
    let fov = raw.horizontal_fov_deg;
    if !(fov > 0.0 && fov < 180.0) {
        return Err(place.error("view: horizontal_fov_deg", "an angle above 0 and below 180", fov));
    }
    Ok(View {
        yaw: raw.yaw_deg.to_radians(),
        pitch: raw.pitch_deg.to_radians(),
        horizontal_fov: fov.to_radians(),
        width: raw.width,
        height: raw.height,
    })
}

fn view_toml(view: &View) -> ViewToml {
    ViewToml {
        yaw_deg: degrees(view.yaw),
        pitch_deg: degrees(view.pitch),
        horizontal_fov_deg: degrees(view.horizontal_fov),
        width: view.width,
        height: view.height,
    }
}

fn size(place: &Place<'_>, key: &str, width: usize, height: usize) -> Result<(), DataError> {
    let expected = if width == 0 || height == 0 {
        "at least 1 x 1 pixels".to_owned()
    } else if width > MOST_PIXELS || height > MOST_PIXELS {
        format!("at most {MOST_PIXELS} x {MOST_PIXELS} pixels")
    } else {
        return Ok(());
    };
    Err(place.error(key, &expected, format!("{width} x {height}")))
}
