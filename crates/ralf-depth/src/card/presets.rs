//! Cards of public networks, from their authors' own code. A card that says `preset = "NAME"` builds on one of them.

/// Name and text of each; the files lie in the folder `presets` of this crate.
const PRESETS: [(&str, &str); 6] = [
    ("midas-small", include_str!("../../presets/midas-small.toml")),
    ("midas-dpt", include_str!("../../presets/midas-dpt.toml")),
    ("depth-anything-v2-small", include_str!("../../presets/depth-anything-v2-small.toml")),
    ("depth-anything-v2-metric-outdoor", include_str!("../../presets/depth-anything-v2-metric-outdoor.toml")),
    ("metric3d-v2-small", include_str!("../../presets/metric3d-v2-small.toml")),
    ("diverse-depth", include_str!("../../presets/diverse-depth.toml")),
];

/// What can stand in `preset = "NAME"`.
pub fn names() -> Vec<&'static str> {
    PRESETS.iter().map(|(name, _)| *name).collect()
}

/// A preset's TOML, with its remarks: a card to copy and to change.
pub fn text(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
