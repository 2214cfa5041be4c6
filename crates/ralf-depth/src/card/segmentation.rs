//! The card of a segmentation network.

use super::keys::Keys;
use super::presets::SEGMENTATION;
use super::read::text_of;
use super::{Feed, Fit};
use crate::NetworkError;
use ralf::label::class_name;
use serde::{Deserialize, Serialize};
use std::path::Path;

const CLASSES: &str = "classes";
const EXPECTED: &str =
    "a list of two to 256 { name, id } in the network's order, ids of SemanticKITTI up to 255";

/// What the `.onnx` file of a segmentation network doesn't say of itself: a TOML file of the same name, ending in
/// `.toml`. It is fed as a depth network is ([`Card`](super::Card)).
///
/// ```toml
/// preset = "cityscapes"                   # optional: a card of `presets::SEGMENTATION`, to build on
///
/// input = { width = 1024, height = 512 }
/// fit = "stretch"                         # or { pad = [red, green, blue] }
/// channels = "rgb"
/// divide_by = 255
/// mean = [0.485, 0.456, 0.406]
/// std = [0.229, 0.224, 0.225]
/// classes = [{ name = "road", id = 40 }, { name = "sky", id = 0 }]
///
/// output_name = "logits"                  # optional: which output, of a network with several
/// ```
///
/// The network gives a score for each class and pixel, `[1, classes, H, W]`, of which the largest wins, or for each
/// pixel the class's place in the list, `[1, H, W]`; H and W may be a fraction of the input's. An id is
/// SemanticKITTI's: 0 of what has none, such as the sky.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SegmentationCard {
    /// How it is fed.
    #[serde(flatten)]
    pub feed: Feed,
    /// Which output holds the classes, of a network with several.
    pub output_name: Option<String>,
    /// The network's classes, in its order.
    pub classes: Vec<OutputClass>,
}

/// A class of a network.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OutputClass {
    /// For people.
    pub name: String,
    /// SemanticKITTI's id.
    pub id: u8,
}

impl SegmentationCard {
    /// Reads the card `file`.
    pub fn read(file: &Path) -> Result<Self, NetworkError> {
        Self::parse(file, &text_of(file, &SEGMENTATION, CLASSES)?)
    }

    /// Reads a card's text. Errors name `file`.
    pub fn parse(file: &Path, text: &str) -> Result<Self, NetworkError> {
        let mut keys = Keys::parse(file, text, &SEGMENTATION)?;
        let card = Self {
            feed: Feed::take(&mut keys)?,
            output_name: keys.optional("output_name", "the name of an output")?,
            classes: keys.required(CLASSES, EXPECTED)?,
        };
        card.feed.check(&keys)?;
        if card.feed.fit == Fit::Squares {
            let expected = "\"stretch\" or { pad = [red, green, blue] }, for classes can't be blended";
            return Err(keys.error("fit", expected, "\"squares\""));
        }
        if !(2..=256).contains(&card.classes.len()) {
            return Err(keys.error(CLASSES, EXPECTED, &format!("{} classes", card.classes.len())));
        }
        let known = |class: &&OutputClass| class_name(u16::from(class.id)).is_some();
        if let Some(OutputClass { name, id }) = card.classes.iter().find(|class| !known(class)) {
            return Err(keys.error(CLASSES, EXPECTED, &format!("{id} of `{name}`")));
        }
        keys.finish()?;
        Ok(card)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<SegmentationCard, String> {
        SegmentationCard::parse(Path::new("net.toml"), text).map_err(|error| error.to_string())
    }

    const SIZED: &str = "preset = \"cityscapes\"\ninput = { width = 8, height = 8 }\nfit = \"stretch\"";

    #[test]
    fn a_preset_knows_the_classes_and_the_card_the_size() {
        let card = parse(SIZED).unwrap();
        assert_eq!(
            (card.classes.len(), card.classes[13].name.as_str(), card.classes[13].id),
            (19, "car", 10)
        );
        let error = parse("preset = \"cityscapes\"").unwrap_err();
        assert!(error.contains("input: expected") && error.contains("found nothing"), "{error}");
    }

    #[test]
    fn whatever_is_wrong_is_named() {
        for (line, parts) in [
            ("classes = [{ name = \"a\", id = 40 }]", ["classes: expected a list of two", "found 1 classes"]),
            (
                "classes = [{ name = \"a\", id = 40 }, { name = \"b\", id = 7 }]",
                ["classes: ", "found 7 of `b`"],
            ),
            ("classes = [{ name = \"a\", id = 256 }, { name = \"b\", id = 1 }]", ["classes: ", "id = 256"]),
            ("classes = [40, 50]", ["classes: ", "found [40, 50]"]),
            ("output = \"depth\"", ["output: expected one of the keys preset, input", "an unknown key"]),
        ] {
            let error = parse(&format!("{SIZED}\n{line}")).expect_err(line);
            assert!(parts.iter().all(|part| error.contains(part)), "{error}\nlacks one of {parts:?}");
        }
        let squares = SIZED.replace("stretch", "squares");
        assert!(parse(&squares).unwrap_err().contains("classes can't be blended"));
        let missing = SegmentationCard::read(Path::new("nowhere/net.toml")).unwrap_err().to_string();
        assert!(missing.contains("cityscapes") && missing.contains("std, classes"), "{missing}");
    }
}
