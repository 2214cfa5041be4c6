//! What the columns of a result mean, as the page shows them.

use ralf_data::result::Column;

/// What kind of number a column holds; the page shows each kind in its own manner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Group {
    /// Where the detection lies.
    Place,
    /// What the radar measured otherwise.
    Measured,
    /// How far a branch's evidence lies from the detection.
    Mismatch,
    /// How plausible the detection is, from 0 to 1.
    Plausibility,
}

impl Group {
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Place => "place",
            Self::Measured => "measured",
            Self::Mismatch => "mismatch",
            Self::Plausibility => "plausibility",
        }
    }
}

/// What a column means.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Meaning {
    /// Empty where the number has none.
    pub(crate) unit: &'static str,
    pub(crate) text: &'static str,
    pub(crate) group: Group,
}

const KNOWN: [(&str, Meaning); 20] = [
    ("x", place("m", "forward of the vehicle's origin")),
    ("y", place("m", "left of the vehicle's origin")),
    ("z", place("m", "above the vehicle's origin")),
    ("range", place("m", "distance from the radar")),
    ("azimuth", place("rad", "angle to the left of the radar's axis")),
    ("elevation", place("rad", "angle above the radar's axis")),
    ("doppler", measured("m/s", "Doppler velocity, positive when receding")),
    ("doppler_compensated", measured("m/s", "Doppler velocity without the vehicle's own motion")),
    ("rcs", measured("dBsm", "radar cross-section")),
    ("RCS", measured("dBsm", "radar cross-section")),
    ("power", measured("dB", "strength of the echo")),
    ("snr", measured("dB", "echo over noise")),
    ("d_lm", mismatch("LiDAR mismatch")),
    ("d_cm", mismatch("camera mismatch")),
    ("d_tr", mismatch("tracking mismatch")),
    ("w", plausibility("plausibility, all branches")),
    ("w_opt", plausibility("optical: camera in the LiDAR's blind spot, else LiDAR")),
    ("w_lm", plausibility("LiDAR")),
    ("w_cm", plausibility("camera")),
    ("w_tr", plausibility("tracking")),
];

/// What a column means: a few words where there are some, else what the result says of it.
pub(crate) fn meaning(column: &Column) -> Meaning {
    let known = KNOWN.iter().find(|(known, _)| *known == column.name);
    let text = if column.group == ralf_data::result::Group::Evidence { column.meaning } else { "" };
    // Nobody reads "0.25 1".
    let unit = if column.unit == "1" { "" } else { column.unit };
    known.map_or(measured(unit, text), |(_, meaning)| *meaning)
}

const fn place(unit: &'static str, text: &'static str) -> Meaning {
    Meaning { unit, text, group: Group::Place }
}

const fn measured(unit: &'static str, text: &'static str) -> Meaning {
    Meaning { unit, text, group: Group::Measured }
}

const fn mismatch(text: &'static str) -> Meaning {
    Meaning { unit: "", text, group: Group::Mismatch }
}

const fn plausibility(text: &'static str) -> Meaning {
    Meaning { unit: "", text, group: Group::Plausibility }
}
