//! Why a detection is an artifact.

/// Why a detection is an artifact. Its number is what the cause files hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[repr(u8)]
pub enum Cause {
    /// It is none: facades, vehicles with their inside, poles, people, vegetation, grass.
    Plausible = 0,
    /// The road, and the kerbs beside it.
    Road = 1,
    /// The image of a real scatterer in a facade or in a car's side.
    Mirror = 2,
    /// An echo that came back to the vehicle and went the same way again, at twice the range.
    DoubleBounce = 3,
    /// A real scatterer seen through a side lobe: right range, wrong azimuth.
    SideLobe = 4,
    /// Something inside a building: real, but behind its facade.
    InsideBuilding = 5,
    /// Nothing at all.
    Noise = 6,
    /// A real scatterer whose angle was taken for another: right range, wrong azimuth or elevation.
    Ambiguity = 7,
    /// The own vehicle: its bumper, what hangs from it.
    OwnVehicle = 8,
    /// Another radar's waves.
    Interference = 9,
}

impl Cause {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 10] = [
        Self::Plausible,
        Self::Road,
        Self::Mirror,
        Self::DoubleBounce,
        Self::SideLobe,
        Self::InsideBuilding,
        Self::Noise,
        Self::Ambiguity,
        Self::OwnVehicle,
        Self::Interference,
    ];

    /// The name in tables and in the files of causes, where a plausible detection has the cause `none`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Plausible => "none",
            Self::Road => "road",
            Self::Mirror => "mirror",
            Self::DoubleBounce => "double bounce",
            Self::SideLobe => "side lobe",
            Self::InsideBuilding => "inside building",
            Self::Noise => "noise",
            Self::Ambiguity => "ambiguity",
            Self::OwnVehicle => "own vehicle",
            Self::Interference => "interference",
        }
    }

    /// The cause that [`Self::name`] calls so.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|cause| cause.name() == name)
    }
}
