//! Cards of public networks, from their authors' own code. A card that says `preset = "NAME"` builds on one of them.

/// Cards of one kind of network: the name and text of each; the files lie in the folder `presets` of this crate.
#[derive(Debug)]
pub struct Presets(&'static [(&'static str, &'static str)]);

/// Of depth networks.
pub static DEPTH: Presets = Presets(&[
    ("midas-small", include_str!("../../presets/midas-small.toml")),
    ("midas-dpt", include_str!("../../presets/midas-dpt.toml")),
    ("depth-anything-v2-small", include_str!("../../presets/depth-anything-v2-small.toml")),
    ("depth-anything-v2-metric-outdoor", include_str!("../../presets/depth-anything-v2-metric-outdoor.toml")),
    ("metric3d-v2-small", include_str!("../../presets/metric3d-v2-small.toml")),
    ("diverse-depth", include_str!("../../presets/diverse-depth.toml")),
]);

/// Of segmentation networks: the classes of what they were trained on. Size and fit of the input belong to the card.
pub static SEGMENTATION: Presets = Presets(&[("cityscapes", include_str!("../../presets/cityscapes.toml"))]);

impl Presets {
    /// What can stand in `preset = "NAME"`.
    pub fn names(&self) -> Vec<&'static str> {
        self.0.iter().map(|(name, _)| *name).collect()
    }

    /// A preset's TOML, with its remarks: a card to copy and to change.
    pub fn text(&self, name: &str) -> Option<&'static str> {
        self.0.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
    }
}
