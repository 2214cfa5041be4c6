//! A depth network and its card, loaded and ready.

use crate::card::Card;
use crate::colour::Colour;
use crate::depth::{DepthRunner, zoom};
use crate::loaded::Loaded;
use crate::network::depth_output;
use crate::{DepthEstimator, NetworkError, Runtime};
use ralf::sensors::{CameraImage, DepthImage, DepthOutput};
use std::path::Path;

/// A depth network of an `.onnx` file.
#[derive(Debug)]
pub struct OnnxModel(Loaded<Card>);

impl OnnxModel {
    /// Loads a network with its card, which lies beside it unless it is given. Runs in rten.
    pub fn load(model: &Path, card: Option<&Path>) -> Result<Self, NetworkError> {
        Self::load_with(Runtime::default(), model, card)
    }

    /// Loads a network with its card, which lies beside it unless it is given, to be run by this runtime.
    pub fn load_with(runtime: Runtime, model: &Path, card: Option<&Path>) -> Result<Self, NetworkError> {
        Loaded::new(runtime, model, card, Card::read, depth_output).map(Self)
    }

    /// How the network is fed.
    pub fn card(&self) -> &Card {
        &self.0.card
    }
}

impl DepthEstimator for OnnxModel {
    fn estimate(&self, view: &CameraImage, focal: f64) -> Result<DepthImage, NetworkError> {
        let card = self.card();
        let runner = self.0.runner(&card.feed);
        let mut depth = DepthRunner { runner, card }.depth(&Colour::from_view(view)?)?;
        if let Some(canonical) = card.canonical_focal {
            if !(focal.is_finite() && focal > 0.0) {
                let expected = "a focal length above 0 px".to_owned();
                return Err(NetworkError::View { expected, found: focal.to_string() });
            }
            let scale = (focal * zoom(card, [view.width, view.height]) / canonical) as f32;
            depth.values.iter_mut().for_each(|value| *value *= scale);
        }
        Ok(DepthImage { width: depth.width, height: depth.height, values: depth.values })
    }

    fn output(&self) -> DepthOutput {
        self.0.card.output
    }

    fn fingerprint(&self) -> &str {
        self.0.fingerprint()
    }
}
