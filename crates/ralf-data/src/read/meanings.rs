//! What the columns of each format's radars mean, and what becomes of them: for people, in `ralf inspect` and
//! `docs/recordings.md`.

use super::{
    aimotive, layout, nuscenes, nvidia, radar_ghost, radar_scenes, ros, truckscenes, view_of_delft, zod,
};
use serde::Serialize;

/// What a format says of its radars' measurements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Meanings {
    /// The format's name.
    #[serde(skip)]
    format: &'static str,
    /// Which range rate it is, and by what it is compensated.
    pub doppler: &'static str,
    /// Whether LiDAR points are brought to one time, and by what.
    pub lidar: &'static str,
    /// Fields that tell how good a detection is, each with its meaning. RALF keeps all of them and filters by none.
    pub quality: &'static [(&'static str, &'static str)],
}

const OWN: &str = "`doppler` is raw; `doppler_compensated` is RALF's, by the vehicle's motion";

const MEANINGS: [Meanings; 10] = [
    Meanings {
        format: layout::NAME,
        doppler: "`doppler` is raw and `doppler_compensated` without the vehicle's motion, as the fields say; RALF \
                  derives the missing one by the vehicle's motion",
        lidar: "points are motion-corrected to the scan's time; `.time` files tell when each was measured",
        quality: &[],
    },
    Meanings {
        format: nuscenes::NAME,
        doppler: "`doppler` is raw, `doppler_compensated` without the vehicle's motion: the radial parts of (vx, vy) \
                  and (vx_comp, vy_comp), which nuScenes compensated itself",
        lidar: "points are published motion-corrected to the scan's time, the revolution's end; no own times",
        quality: &[
            ("is_quality_valid", "1: the radar holds the detection for valid"),
            (
                "invalid_state",
                "0: valid; 1 to 17: why the cluster is doubted (low RCS, near field, mirror ...)",
            ),
            ("ambig_state", "3: the range rate is unambiguous; 1, 4: ambiguous, staggered; 2: staggered"),
            (
                "dyn_prop",
                "0 moving, 1 stationary, 2 oncoming, 3 candidate, 4 unknown, 5 and 6 crossing, 7 stopped",
            ),
            ("pdh0", "class of the probability to be a false alarm, 1: below 25 % up to 7: 100 %"),
            ("x_rms", "class of the deviation along x (vx_rms, y_rms, vy_rms alike), not metres"),
        ],
    },
    Meanings {
        format: truckscenes::NAME,
        doppler: "`doppler` is raw: the radial vector (vrel_x, vrel_y, vrel_z) along the ray, and may be ambiguous on \
                  motorways, which no field tells; `doppler_compensated` is RALF's, by the cab's speed and yaw rate",
        lidar: "points are brought to the scan's time with the poses, each from its own `timestamp`",
        quality: &[],
    },
    Meanings {
        format: view_of_delft::NAME,
        doppler: "`doppler` is raw and `doppler_compensated` without the vehicle's motion, both as published",
        lidar: "points are published brought to the camera's time, without own times",
        quality: &[("time", "which of the accumulated scans a row is from, 0 the latest")],
    },
    Meanings {
        format: aimotive::NAME,
        doppler: OWN,
        lidar: "points are brought to the frame's time with the vehicle's motion, each from its own time",
        quality: &[("snr", "dB: power minus noise, the only measure of quality")],
    },
    Meanings {
        format: zod::NAME,
        doppler: OWN,
        lidar: "points are brought to the scan's time with the poses, each from its own time, unless the list says \
                that they are",
        quality: &[
            ("validity", "1: the radar holds the detection for valid; rows with 0 are kept"),
            ("quality", "0 low, 1 medium, 2 high"),
            ("mode", "0 to 2 with the vehicle's speed; changes the field of view"),
            ("amplitude", "dB: signal to noise"),
        ],
    },
    Meanings {
        format: radar_ghost::NAME,
        doppler: "`doppler` is raw; the vehicle stands, so that the compensated one is the same",
        lidar: "points are as published; the vehicle stands",
        quality: &[],
    },
    Meanings {
        format: radar_scenes::NAME,
        doppler: "`doppler` is raw and `doppler_compensated` without the vehicle's motion, by the data set's authors; \
                  by RALF where they give none, while the vehicle stands",
        lidar: "there is none",
        quality: &[],
    },
    Meanings {
        format: nvidia::NAME,
        doppler: OWN,
        lidar: "it is not read",
        quality: &[
            ("exist_probb", "what the radar itself believes, 0 to 100"),
            ("doppler_ambiguity", "as published; its unit is not documented"),
        ],
    },
    Meanings {
        format: ros::NAME,
        doppler: "`doppler` is raw, `doppler_compensated` without the vehicle's motion, as the fields say, or the \
                  radial parts of (vx, vy) and (vx_comp, vy_comp); RALF derives the missing one by its motion",
        lidar: "points with a field t, time, timestamp, time_stamp or offset_time are brought to the header's time \
                with the vehicle's motion, unless `motion_corrected` says that they are; others stay as they are",
        quality: &[],
    },
];

/// What a format says of its radars' measurements; `None` of one that isn't listed.
pub fn meanings(format: &str) -> Option<Meanings> {
    MEANINGS.into_iter().find(|meanings| meanings.format == format)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_tells_and_the_documents_have_every_field() {
        let page = include_str!("../../../../docs/recordings.md");
        for format in crate::formats() {
            let told = meanings(format).unwrap();
            for (name, _) in told.quality {
                assert!(page.contains(&format!("`{name}`")), "{format}: {name}");
            }
        }
    }
}
