//! Which quantities are looked at.

/// Something that is measured, or follows from measurements alone, whose distribution tells recordings apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quantity {
    /// How many detections a radar scan has.
    Detections,
    /// Range of detections.
    Range,
    /// Azimuth of detections.
    Azimuth,
    /// Elevation of detections.
    Elevation,
    /// Height of detections above the ground.
    Height,
    /// Strength of detections relative to their scan.
    Amplitude,
    /// Range rate of detections without the vehicle's own motion.
    DopplerResidual,
    /// How exactly a scan measures the range rates of what stands.
    DopplerSpread,
    /// From a detection to the nearest other one.
    NearestDetection,
    /// From a detection to the nearest LiDAR point.
    NearestLidar,
    /// How much of a scan lies where LiDAR rays pass.
    FreeSpace,
    /// How often a detection is there in the scans around.
    Persistence,
    /// The same of what lies where LiDAR rays pass.
    FreePersistence,
    /// How many points a LiDAR scan has.
    LidarPoints,
    /// How much of a LiDAR scan is ground.
    LidarGround,
    /// Range of LiDAR points.
    LidarRange,
    /// How fast the vehicle drives.
    Speed,
}

/// Unit of what lies between 0 and 1.
const SHARE: &str = "share";

/// A quantity, for people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Description {
    /// In two or three words.
    pub name: &'static str,
    /// Unit: `share` of shares, empty of counts.
    pub unit: &'static str,
    /// What a value is, in a sentence.
    pub meaning: &'static str,
    /// What a recording must have for it.
    pub needs: &'static str,
}

impl Description {
    /// Whether values are shares, from 0 to 1.
    pub fn is_share(&self) -> bool {
        self.unit == SHARE
    }
}

impl Quantity {
    /// All of them, in the order in which they are told.
    pub const ALL: [Self; 17] = [
        Self::Detections,
        Self::Range,
        Self::Azimuth,
        Self::Elevation,
        Self::Height,
        Self::Amplitude,
        Self::DopplerResidual,
        Self::DopplerSpread,
        Self::NearestDetection,
        Self::NearestLidar,
        Self::FreeSpace,
        Self::Persistence,
        Self::FreePersistence,
        Self::LidarPoints,
        Self::LidarGround,
        Self::LidarRange,
        Self::Speed,
    ];

    /// What it is.
    pub fn description(self) -> &'static Description {
        &DESCRIPTIONS[self as usize]
    }
}

/// In the order of [`Quantity::ALL`].
const DESCRIPTIONS: [Description; Quantity::ALL.len()] = [
    Description {
        name: "detections per scan",
        unit: "",
        meaning: "Detections of a radar scan.",
        needs: "a radar scan",
    },
    Description {
        name: "range",
        unit: "m",
        meaning: "Range of a detection, from its radar.",
        needs: "a detection",
    },
    Description {
        name: "azimuth",
        unit: "degrees",
        meaning: "Azimuth of a detection in its radar's frame, positive to the left.",
        needs: "a detection",
    },
    Description {
        name: "elevation",
        unit: "degrees",
        meaning: "Elevation of a detection in its radar's frame.",
        needs: "a radar that measures elevation",
    },
    Description {
        name: "height",
        unit: "m",
        meaning: "Height of a detection above the ground that LiDAR points show.",
        needs: "a radar that measures elevation, and a LiDAR that sees ground",
    },
    Description {
        name: "amplitude",
        unit: "dB",
        meaning: "Radar cross-section of a detection less the median of its scan; power becomes one by range to \
                  the fourth.",
        needs: "a column rcs, power, snr, amplitude or intensity",
    },
    Description {
        name: "Doppler residual",
        unit: "m/s",
        meaning: "Range rate of a detection less that of a standing thing in its place.",
        needs: "range rates, and the vehicle's motion where they are raw",
    },
    Description {
        name: "Doppler noise",
        unit: "m/s",
        meaning: "1.48 times the median size of a scan's Doppler residuals below 1 m/s, of eight or more.",
        needs: "range rates, and the vehicle's motion where they are raw",
    },
    Description {
        name: "to the next detection",
        unit: "m",
        meaning: "From a detection to the nearest other one of its scan, 20 m at most.",
        needs: "two detections in a scan",
    },
    Description {
        name: "to the next LiDAR point",
        unit: "m",
        meaning: "From a detection to the nearest LiDAR point above the ground, 20 m at most; horizontally for a radar \
        without elevation.",
        needs: "a LiDAR scan near in time",
    },
    Description {
        name: "in free space",
        unit: SHARE,
        meaning: "Of a scan's detections that LiDAR rays reach, the share where three or more pass and none ends \
        within 1 m.",
        needs: "a LiDAR scan near in time",
    },
    Description {
        name: "persistence",
        unit: SHARE,
        meaning: "Share of the five scans before and the five after that have a detection within 1 m of a place that \
        stands, or within 2 % of its range.",
        needs: "four neighbouring scans, and the vehicle's motion",
    },
    Description {
        name: "persistence in free space",
        unit: SHARE,
        meaning: "The same, of detections in free space alone.",
        needs: "four neighbouring scans, the vehicle's motion, and a LiDAR scan near in time",
    },
    Description { name: "LiDAR points", unit: "", meaning: "Returns of a LiDAR scan.", needs: "a LiDAR" },
    Description {
        name: "LiDAR on the ground",
        unit: SHARE,
        meaning: "Share of a LiDAR scan's returns that lie less than 0.2 m above the ground.",
        needs: "a LiDAR that sees ground",
    },
    Description { name: "LiDAR range", unit: "m", meaning: "Range of a LiDAR return.", needs: "a LiDAR" },
    Description {
        name: "speed",
        unit: "m/s",
        meaning: "The vehicle's speed at a radar scan.",
        needs: "the vehicle's motion",
    },
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_stands_in_its_own_place_under_its_own_name() {
        for (place, quantity) in Quantity::ALL.into_iter().enumerate() {
            assert_eq!(quantity as usize, place);
            let same = |other: &&Quantity| other.description().name == quantity.description().name;
            assert_eq!(Quantity::ALL.iter().filter(same).count(), 1, "{quantity:?}");
        }
    }
}
