//! Sensors of public recordings that carry no measurement uncertainties: what their makers and papers say of them.
//!
//! Radar makers state an accuracy or a resolution, not a standard deviation. An accuracy is taken as one standard
//! deviation, a resolution as two. Whoever knows better says so in the table `sensors` of the settings.

use ralf::sensors::{Elevation, Lidar, Radar, Reliability};
use ralf::space::Transform;

/// What is known of a type of radar.
#[derive(Debug, Clone, Copy)]
pub(crate) struct RadarModel {
    /// Whether theta is measured.
    pub(crate) elevation: Elevation,
    /// Full horizontal field of view, degrees.
    pub(crate) fov_azimuth_deg: f64,
    /// Full vertical field of view, degrees.
    pub(crate) fov_elevation_deg: f64,
    /// `s_r`, m.
    pub(crate) sigma_range_m: f64,
    /// `s_phi`, degrees.
    pub(crate) sigma_azimuth_deg: f64,
    /// `s_theta`, degrees; 0 where elevation isn't measured.
    pub(crate) sigma_elevation_deg: f64,
}

/// What is known of a type of LiDAR.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LidarModel {
    /// `s_r,lidar`, m.
    pub(crate) sigma_range_m: f64,
    /// `alpha_l`: depression of the lowest beam, degrees.
    pub(crate) lowest_beam_deg: f64,
    /// Farthest return, m, where it is known.
    pub(crate) max_range_m: Option<f64>,
}

/// Continental ARS 408-21, all five radars of nuScenes. Its data sheet has a near and a far scan:
///
/// | | far | near |
/// | --- | --- | --- |
/// | range accuracy | 0.40 m | 0.10 m |
/// | azimuth accuracy | 0.1 deg | 0.3 deg at 0, 1 deg at 45, 5 deg at 60 deg |
/// | azimuth field of view | 18 deg | 120 deg |
/// | elevation field of view | 14 deg | 20 deg |
///
/// The recording doesn't say which scan a detection is from: the wider field and the worse range accuracy hold
/// for both, and 1 deg for all but the outermost azimuths.
pub(crate) const ARS_408_21: RadarModel = RadarModel {
    elevation: Elevation::None,
    fov_azimuth_deg: 120.0,
    fov_elevation_deg: 20.0,
    sigma_range_m: 0.40,
    sigma_azimuth_deg: 1.0,
    sigma_elevation_deg: 0.0,
};

/// ZF FRGen21, the radar of View-of-Delft. The data set's paper (Palffy et al., RA-L 2022) gives the resolutions
/// 0.2 m in range and 1.5 deg in azimuth and elevation, of which half are taken. The fields of view are those that
/// the published scans fill: 90 deg to either side, 17 deg up and down.
pub(crate) const ZF_FRGEN21: RadarModel = RadarModel {
    elevation: Elevation::Measured,
    fov_azimuth_deg: 180.0,
    fov_elevation_deg: 34.0,
    sigma_range_m: 0.10,
    sigma_azimuth_deg: 0.75,
    sigma_elevation_deg: 0.75,
};

/// Continental ARS 548, the radars of MAN TruckScenes as far as scans tell. Data sheet, as the Dual-Radar data set
/// quotes it: 0.22 m, 1.2 deg in azimuth up to 15 deg from the axis and 1.68 deg at 45, 2.3 deg in elevation. They are
/// resolutions: half of them is taken, of the azimuth's worse one. Fields of view 120 by 28 deg (8 beyond 140 m).
pub(crate) const ARS_548: RadarModel = RadarModel {
    elevation: Elevation::Measured,
    fov_azimuth_deg: 120.0,
    fov_elevation_deg: 28.0,
    sigma_range_m: 0.11,
    sigma_azimuth_deg: 0.84,
    sigma_elevation_deg: 1.15,
};

/// Velodyne HDL-32E, the LiDAR of nuScenes. Data sheet: 2 cm accuracy (one standard deviation at 25 m), beams from
/// +10.67 to -30.67 deg, usable returns up to 100 m.
pub(crate) const HDL_32E: LidarModel =
    LidarModel { sigma_range_m: 0.02, lowest_beam_deg: 30.67, max_range_m: Some(100.0) };

/// Velodyne HDL-64E S3, the LiDAR of View-of-Delft. Data sheet: accuracy better than 2 cm (one standard deviation),
/// beams from +2 to -24.9 deg, 120 m.
pub(crate) const HDL_64E_S3: LidarModel =
    LidarModel { sigma_range_m: 0.02, lowest_beam_deg: 24.9, max_range_m: Some(120.0) };

/// Hesai Pandar64, the LiDAR of aiMotive. Data sheet: 2 cm accuracy, beams from +15 to -25 deg, 200 m at 10 %.
pub(crate) const PANDAR64: LidarModel =
    LidarModel { sigma_range_m: 0.02, lowest_beam_deg: 25.0, max_range_m: Some(200.0) };

/// Velodyne VLS-128, the LiDAR on the roof of ZOD's cars. Data sheet: 3 cm accuracy, beams from +15 to -25 deg, 245 m.
pub(crate) const VLS_128: LidarModel =
    LidarModel { sigma_range_m: 0.03, lowest_beam_deg: 25.0, max_range_m: Some(245.0) };

/// smartmicro UMRR-11 type 132, both radars of aiMotive. Fields of view are those that scans of a motorway fill,
/// 17.3 deg to either side and 7.8 deg up and down; sigmas what they scatter by about guard rails in the LiDAR's map.
pub(crate) const UMRR_11: RadarModel = RadarModel {
    elevation: Elevation::Measured,
    fov_azimuth_deg: 36.0,
    fov_elevation_deg: 16.0,
    sigma_range_m: 0.10,
    sigma_azimuth_deg: 0.25,
    sigma_elevation_deg: 0.55,
};

/// The 77 GHz radars of the Radar Ghost Dataset, which don't measure elevation. Its paper gives a field of view of
/// 70 deg to either side; accuracies aren't published and are those of [`GENERIC_RADAR`].
pub(crate) const GHOST_RADAR: RadarModel = RadarModel {
    elevation: Elevation::None,
    fov_azimuth_deg: 140.0,
    fov_elevation_deg: 20.0,
    sigma_elevation_deg: 0.0,
    ..GENERIC_RADAR
};

/// The LiDAR of the Radar Ghost Dataset, behind the bumper: its type isn't published.
pub(crate) const GHOST_LIDAR: LidarModel = GENERIC_LIDAR;

/// The four radars of RadarScenes, which don't measure elevation. The data set's page gives a field of view of 60 deg
/// to either side and the resolutions 0.15 m in range and 0.5 deg (ahead) to 2 deg (at the edge) in azimuth, of which
/// half are taken, in azimuth of 1 deg.
pub(crate) const RADARSCENES: RadarModel = RadarModel {
    elevation: Elevation::None,
    fov_azimuth_deg: 120.0,
    fov_elevation_deg: 20.0,
    sigma_range_m: 0.075,
    sigma_azimuth_deg: 0.5,
    sigma_elevation_deg: 0.0,
};

/// A radar of which nothing is known: what most 77 GHz radars for vehicles have or surpass. Whoever has the data sheet
/// says better in the settings.
pub(crate) const GENERIC_RADAR: RadarModel = RadarModel {
    elevation: Elevation::Measured,
    fov_azimuth_deg: 120.0,
    fov_elevation_deg: 30.0,
    sigma_range_m: 0.20,
    sigma_azimuth_deg: 1.0,
    sigma_elevation_deg: 1.0,
};

/// The radars of NVIDIA's PhysicalAI-AV, of nineteen names and several makes, which aren't told: see [`GENERIC_RADAR`].
pub(crate) const NVIDIA_RADAR: RadarModel = GENERIC_RADAR;

/// Those of them that give every detection the elevation 0.
pub(crate) const NVIDIA_RADAR_2D: RadarModel =
    RadarModel { elevation: Elevation::None, sigma_elevation_deg: 0.0, ..GENERIC_RADAR };

/// A LiDAR of which nothing is known: a rotating one on a roof.
pub(crate) const GENERIC_LIDAR: LidarModel =
    LidarModel { sigma_range_m: 0.02, lowest_beam_deg: 25.0, max_range_m: None };

/// What stands for a sensor of which nothing is known.
pub(crate) const GENERIC: &str = "generic";

/// By the names that settings have for them.
pub(crate) const RADARS: [(&str, RadarModel); 7] = [
    (GENERIC, GENERIC_RADAR),
    ("ars408-21", ARS_408_21),
    ("ars548", ARS_548),
    ("frgen21", ZF_FRGEN21),
    ("radar-ghost", GHOST_RADAR),
    ("radarscenes", RADARSCENES),
    ("umrr-11", UMRR_11),
];

/// By the names that settings have for them.
pub(crate) const LIDARS: [(&str, LidarModel); 5] = [
    (GENERIC, GENERIC_LIDAR),
    ("hdl-32e", HDL_32E),
    ("hdl-64e-s3", HDL_64E_S3),
    ("pandar64", PANDAR64),
    ("vls-128", VLS_128),
];

/// Parts of names that tell a sensor's type, in small letters and without what separates them, with its model.
const TELLING: [(&str, &str); 8] = [
    ("ars408", "ars408-21"),
    ("ars548", "ars548"),
    ("frgen21", "frgen21"),
    ("umrr11", "umrr-11"),
    ("hdl32", "hdl-32e"),
    ("hdl64", "hdl-64e-s3"),
    ("pandar64", "pandar64"),
    ("vls128", "vls-128"),
];

/// The one of these models that a topic's or a frame's name tells of; the generic one where it tells of none.
pub(crate) fn named_in<M>(names: &[&str], models: &[(&'static str, M)]) -> &'static str {
    let told = |name: &str| {
        let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
        let plain = plain.to_ascii_lowercase();
        let told = TELLING.iter().filter(|(part, _)| plain.contains(part));
        told.map(|(_, model)| *model).find(|model| models.iter().any(|(known, _)| known == model))
    };
    names.iter().copied().find_map(told).unwrap_or(GENERIC)
}

impl RadarModel {
    /// A radar of this type.
    pub(crate) fn mounted(
        self,
        name: &str,
        fields: &[impl AsRef<str>],
        vehicle_from_radar: Transform,
    ) -> Radar {
        Radar {
            name: name.to_owned(),
            fields: fields.iter().map(|field| field.as_ref().to_owned()).collect(),
            vehicle_from_radar,
            elevation: self.elevation,
            fov_azimuth: self.fov_azimuth_deg.to_radians(),
            fov_elevation: self.fov_elevation_deg.to_radians(),
            sigma_range: self.sigma_range_m,
            sigma_azimuth: self.sigma_azimuth_deg.to_radians(),
            sigma_elevation: self.sigma_elevation_deg.to_radians(),
            reliability: Reliability::default(),
        }
    }
}

impl LidarModel {
    /// A LiDAR of this type.
    pub(crate) fn mounted(self, name: &str, vehicle_from_lidar: Transform) -> Lidar {
        Lidar {
            name: name.to_owned(),
            vehicle_from_lidar,
            sigma_range: self.sigma_range_m,
            lowest_beam: self.lowest_beam_deg.to_radians(),
            max_range: self.max_range_m,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_the_one_that_topic_or_frame_tells() {
        for (names, expected) in [
            (["/ars408_front/points", "radar"], "ars408-21"),
            (["/radar", "ARS-408-21_link"], "ars408-21"),
            (["/radar", "frgen_21"], "frgen21"),
            (["/hdl_32e/points", "velodyne"], GENERIC),
            (["/radar/points", "base_link"], GENERIC),
        ] {
            assert_eq!(named_in(&names, &RADARS), expected, "{names:?}");
        }
        assert_eq!(named_in(&["/velodyne_hdl32/points"], &LIDARS), "hdl-32e");
    }

    #[test]
    fn every_model_is_a_sensor() {
        for (_, model) in RADARS {
            assert_eq!(model.mounted("radar", &["x", "y", "z"], Transform::identity()).check(), Ok(()));
        }
        for (_, model) in LIDARS {
            assert_eq!(model.mounted("lidar", Transform::identity()).check(), Ok(()));
        }
    }
}
