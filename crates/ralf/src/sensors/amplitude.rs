//! Which of a radar's fields says how strong an echo was.

use super::rig::Radar;

/// What a field of strength measures; both are in dB.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum AmplitudeKind {
    /// The radar cross-section of what reflected, whatever its distance.
    CrossSection,
    /// The power that came back, which falls with the fourth power of the distance.
    Power,
}

/// A radar's field of strength.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct AmplitudeField {
    /// The place of the column.
    pub column: usize,
    /// What it measures.
    pub kind: AmplitudeKind,
}

/// Names of fields of strength, in lower case; the first that a radar has is taken.
const AMPLITUDES: [(&str, AmplitudeKind); 5] = [
    ("rcs", AmplitudeKind::CrossSection),
    ("power", AmplitudeKind::Power),
    ("snr", AmplitudeKind::Power),
    ("amplitude", AmplitudeKind::Power),
    ("intensity", AmplitudeKind::Power),
];

impl Radar {
    /// The field that says how strong an echo was: the first of `rcs`, `power`, `snr`, `amplitude` and `intensity`, in
    /// capitals or not; `None` where the radar has none of them.
    pub fn amplitude(&self) -> Option<AmplitudeField> {
        AMPLITUDES.iter().find_map(|(name, kind)| {
            let column = self.fields.iter().position(|field| field.eq_ignore_ascii_case(name))?;
            Some(AmplitudeField { column, kind: *kind })
        })
    }
}
