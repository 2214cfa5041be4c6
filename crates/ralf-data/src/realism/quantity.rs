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

/// A quantity, for people.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Description {
    /// In two or three words.
    pub name: &'static str,
    /// Unit; empty of shares and counts.
    pub unit: &'static str,
    /// What a value is, in a sentence.
    pub meaning: &'static str,
    /// What a recording must have for it.
    pub needs: &'static str,
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
    pub fn description(self) -> Description {
        let [name, unit, meaning, needs] = match self {
            Self::Detections => ["detections per scan", "", "Detections of a radar scan.", "a radar scan"],
            Self::Range => ["range", "m", "Range of a detection, from its radar.", "a detection"],
            Self::Azimuth => [
                "azimuth",
                "degrees",
                "Azimuth of a detection in its radar's frame, positive to the left.",
                "a detection",
            ],
            Self::Elevation => [
                "elevation",
                "degrees",
                "Elevation of a detection in its radar's frame.",
                "a radar that measures elevation",
            ],
            Self::Height => [
                "height",
                "m",
                "Height of a detection above the ground that LiDAR points show.",
                "a radar that measures elevation, and a LiDAR that sees ground",
            ],
            Self::Amplitude => [
                "amplitude",
                "dB",
                "Strength of a detection less the median of its scan.",
                "a column rcs, power, snr, amplitude or intensity",
            ],
            Self::DopplerResidual => [
                "Doppler residual",
                "m/s",
                "Range rate of a detection less that of a standing thing in its place.",
                "range rates, and the vehicle's motion where they are raw",
            ],
            Self::DopplerSpread => [
                "Doppler noise",
                "m/s",
                "1.48 times the median size of a scan's Doppler residuals below 1 m/s, of eight or more.",
                "range rates, and the vehicle's motion where they are raw",
            ],
            Self::NearestDetection => [
                "to the next detection",
                "m",
                "From a detection to the nearest other one of its scan, 20 m at most.",
                "two detections in a scan",
            ],
            Self::NearestLidar => [
                "to the next LiDAR point",
                "m",
                "From a detection to the nearest LiDAR point above the ground, 20 m at most; horizontally for a radar \
                 without elevation.",
                "a LiDAR scan near in time",
            ],
            Self::FreeSpace => [
                "in free space",
                "",
                "Of a scan's detections that LiDAR rays reach, the share where three or more pass and none ends \
                 within 1 m.",
                "a LiDAR scan near in time",
            ],
            Self::Persistence => [
                "persistence",
                "",
                "Share of the five scans before and the five after that have a detection within 1 m of a place that \
                 stands, or within 2 % of its range.",
                "four neighbouring scans, and the vehicle's motion",
            ],
            Self::FreePersistence => [
                "persistence in free space",
                "",
                "The same, of detections in free space alone.",
                "four neighbouring scans, the vehicle's motion, and a LiDAR scan near in time",
            ],
            Self::LidarPoints => ["LiDAR points", "", "Returns of a LiDAR scan.", "a LiDAR"],
            Self::LidarGround => [
                "LiDAR on the ground",
                "",
                "Share of a LiDAR scan's returns that lie less than 0.2 m above the ground.",
                "a LiDAR that sees ground",
            ],
            Self::LidarRange => ["LiDAR range", "m", "Range of a LiDAR return.", "a LiDAR"],
            Self::Speed => ["speed", "m/s", "The vehicle's speed at a radar scan.", "the vehicle's motion"],
        };
        Description { name, unit, meaning, needs }
    }
}

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
