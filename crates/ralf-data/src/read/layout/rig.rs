//! Sensors as `sequence.toml` has them, checked and turned into those of the method, and back: degrees there, radians
//! here.

use super::camera::{camera, camera_toml};
use super::is_folder_name;
use super::raw::{CameraToml, ElevationToml, LidarToml, RadarToml, SequenceToml};
use super::values::{Place, degrees, pose_toml};
use crate::error::DataError;
use crate::tree::GROUND_TRUTH;
use ralf::sensors::{Elevation, Lidar, Radar, Reliability, Rig, check_fields};
use std::path::Path;

/// Columns of the output: a radar's further fields are kept beside them, and can't be called the same.
const OUTPUT_COLUMNS: [&str; 15] = [
    "radar", "scan", "point", "t_ns", "d_lm", "d_cm", "d_tr", "w_lm", "w_cm", "w_tr", "w_opt", "w", "label",
    "flags", "semantic",
];

/// The sensors of a `sequence.toml`.
pub(crate) fn rig(file: &Path, toml: &SequenceToml) -> Result<Rig, DataError> {
    if toml.format != 1 {
        return Err(DataError::content(file, "format", "1", toml.format.to_string()));
    }
    let place = |table, name| Place { file, table, name };
    let radars = toml.radar.iter().map(|raw| radar(&place("radar", &raw.name), raw));
    let lidars = toml.lidar.iter().map(|raw| lidar(&place("lidar", &raw.name), raw));
    let cameras = toml.camera.iter().map(|raw| camera(&place("camera", &raw.name), raw));
    let rig = Rig {
        radars: radars.collect::<Result<_, _>>()?,
        lidars: lidars.collect::<Result<_, _>>()?,
        cameras: cameras.collect::<Result<_, _>>()?,
    };
    check_names(file, &rig)?;
    Ok(rig)
}

/// A `sequence.toml`'s sensors: `radar`, `lidar` and `camera`.
pub(crate) fn rig_toml(rig: &Rig) -> (Vec<RadarToml>, Vec<LidarToml>, Vec<CameraToml>) {
    (
        rig.radars.iter().map(radar_toml).collect(),
        rig.lidars.iter().map(lidar_toml).collect(),
        rig.cameras.iter().map(camera_toml).collect(),
    )
}

fn radar(place: &Place<'_>, raw: &RadarToml) -> Result<Radar, DataError> {
    let (elevation, sigma_elevation_deg) = match (raw.elevation, raw.sigma_elevation_deg) {
        (ElevationToml::Measured, None) => {
            return Err(place.error("sigma_elevation_deg", "a value where elevation is measured", "none"));
        }
        (ElevationToml::Measured, Some(sigma)) => (Elevation::Measured, sigma),
        (ElevationToml::None, sigma) => (Elevation::None, sigma.unwrap_or(0.0)),
    };
    let table = raw.reliability.iter().map(|[azimuth_deg, value]| (azimuth_deg.to_radians(), *value));
    let radar = Radar {
        name: raw.name.clone(),
        fields: raw.fields.clone(),
        vehicle_from_radar: place.pose(raw.translation, raw.quaternion_xyzw)?,
        elevation,
        fov_azimuth: raw.fov_azimuth_deg.to_radians(),
        fov_elevation: raw.fov_elevation_deg.to_radians(),
        sigma_range: raw.sigma_range_m,
        sigma_azimuth: raw.sigma_azimuth_deg.to_radians(),
        sigma_elevation: sigma_elevation_deg.to_radians(),
        reliability: Reliability::new(table.collect()).map_err(|why| place.refused("reliability", &why))?,
    };
    radar.check().map_err(|why| place.refused("values", &why))?;
    check_fields(&radar).map_err(|why| place.refused("fields", &why))?;
    check_field_names(place, &radar)?;
    Ok(radar)
}

fn check_field_names(place: &Place<'_>, radar: &Radar) -> Result<(), DataError> {
    let name = |name: &str| format!("`{name}`");
    let repeated = radar.fields.iter().enumerate().find(|(at, field)| radar.fields[..*at].contains(field));
    if let Some((_, field)) = repeated {
        return Err(place.error("fields", "each name once", name(field)));
    }
    let mut further = radar.further_fields();
    match further.find(|(_, field)| field.is_empty() || OUTPUT_COLUMNS.contains(field)) {
        Some((_, field)) => Err(place.error("fields", "names that no column of the output has", name(field))),
        None => Ok(()),
    }
}

fn radar_toml(radar: &Radar) -> RadarToml {
    let measured = radar.elevation == Elevation::Measured;
    let (translation, quaternion_xyzw) = pose_toml(&radar.vehicle_from_radar);
    RadarToml {
        name: radar.name.clone(),
        fields: radar.fields.clone(),
        translation,
        quaternion_xyzw,
        elevation: if measured { ElevationToml::Measured } else { ElevationToml::None },
        fov_azimuth_deg: degrees(radar.fov_azimuth),
        fov_elevation_deg: degrees(radar.fov_elevation),
        sigma_range_m: radar.sigma_range,
        sigma_azimuth_deg: degrees(radar.sigma_azimuth),
        sigma_elevation_deg: (measured || radar.sigma_elevation > 0.0)
            .then(|| degrees(radar.sigma_elevation)),
        reliability: radar.reliability.table().iter().map(|(azimuth, v)| [degrees(*azimuth), *v]).collect(),
    }
}

fn lidar(place: &Place<'_>, raw: &LidarToml) -> Result<Lidar, DataError> {
    if let Some(range) = raw.max_range_m.filter(|range| !(range.is_finite() && *range > 0.0)) {
        return Err(place.error("max_range_m", "a finite number above 0", range));
    }
    let lidar = Lidar {
        name: raw.name.clone(),
        vehicle_from_lidar: place.pose(raw.translation, raw.quaternion_xyzw)?,
        sigma_range: raw.sigma_range_m,
        lowest_beam: raw.lowest_beam_deg.to_radians(),
        max_range: raw.max_range_m,
    };
    lidar.check().map_err(|why| place.refused("values", &why))?;
    Ok(lidar)
}

fn lidar_toml(lidar: &Lidar) -> LidarToml {
    let (translation, quaternion_xyzw) = pose_toml(&lidar.vehicle_from_lidar);
    LidarToml {
        name: lidar.name.clone(),
        translation,
        quaternion_xyzw,
        sigma_range_m: lidar.sigma_range,
        lowest_beam_deg: degrees(lidar.lowest_beam),
        max_range_m: lidar.max_range,
    }
}

/// A sensor's name is its folder's: it leads nowhere else, and belongs to one sensor.
fn check_names(file: &Path, rig: &Rig) -> Result<(), DataError> {
    let radars = rig.radars.iter().map(|radar| ("radar", radar.name.as_str()));
    let lidars = rig.lidars.iter().map(|lidar| ("lidar", lidar.name.as_str()));
    let cameras = rig.cameras.iter().map(|camera| ("camera", camera.name.as_str()));
    let mut seen: Vec<&str> = Vec::new();
    for (table, name) in radars.chain(lidars).chain(cameras) {
        let place = Place { file, table, name };
        if !is_folder_name(name) || name == GROUND_TRUTH {
            return Err(place.error(
                "name",
                "the plain name of the sensor's own folder",
                format!("`{name}`"),
            ));
        }
        if seen.contains(&name) {
            return Err(place.error("name", "a name that no other sensor has", format!("`{name}`")));
        }
        seen.push(name);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::layout::values::quaternion_xyzw;
    use ralf::space::transform_from_parts;

    #[test]
    fn angles_and_rotations_come_back_as_they_were_written() {
        for written in [160.0, 0.6, 1.2, -80.0, 25.0, 0.1, 179.999, 1e-3, 12.345678901234] {
            assert_eq!(degrees(f64::to_radians(written)), written);
        }
        let back = [0.0, 0.0, 1.0, 6.123233995736766e-17];
        let others = [[-0.5, 0.5, -0.5, 0.5], [0.0, 0.0, 0.38268343, 0.92387953], [0.1, 0.2, 0.3, 0.927]];
        for written in others.into_iter().chain([back]) {
            let pose = transform_from_parts([0.0; 3], written).unwrap();
            assert_eq!(quaternion_xyzw(&pose.rotation), written);
        }
    }

    /// Reading makes a quaternion's length 1, which rounds: of some rotations once more each time.
    #[test]
    fn what_is_written_of_a_rotation_is_read_as_the_same() {
        let read = |parts| transform_from_parts([0.0; 3], parts).unwrap().rotation;
        for n in 0..2000 {
            let angle = |step: f64| f64::from(n) * step;
            let drawn =
                nalgebra::UnitQuaternion::from_euler_angles(angle(0.7).sin(), angle(0.3).cos(), angle(0.011));
            let once = read(drawn.coords.into());
            assert_eq!(read(quaternion_xyzw(&once)), once, "{n}");
        }
    }

    #[test]
    fn names_lead_nowhere_else() {
        for name in ["", ".", "..", "../a", "a/b", "/a", "a\\b", ".a", "C:", "a\nb", "a\0"] {
            assert!(!is_folder_name(name), "{name:?}");
        }
        assert!(is_folder_name("radar_front") && is_folder_name("Radar vorn-1"));
    }
}
