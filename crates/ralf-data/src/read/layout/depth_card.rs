//! `depth.toml` beside the sequences: what the network that `ralf depth` ran gives.

use crate::disk::files;
use crate::tree::DEPTH;
use ralf::sensors::DepthOutput;
use ralf_files::Kind;
use serde::Deserialize;
use std::path::Path;

/// What is looked at of it; whoever uses it as a store reads all.
#[derive(Deserialize)]
struct Card {
    output: DepthOutput,
}

/// A warning where a sequence says of its depth images that they hold something else than the network gave. What the
/// sequence says counts.
pub(super) fn contradicted(sequence_toml: &Path, told: DepthOutput) -> Option<String> {
    let dataset = sequence_toml.ancestors().nth(3)?;
    let file = dataset.join(DEPTH).with_extension("toml");
    let card: Card = toml::from_str(&files::read_text(&file, Kind::Settings).ok()?).ok()?;
    (card.output != told).then(|| {
        format!(
            "{}: [depth] output: expected `{}`, which the network gives by {}, found `{told}`: the depth images are \
             read as `{told}`",
            sequence_toml.display(),
            card.output,
            file.display()
        )
    })
}
