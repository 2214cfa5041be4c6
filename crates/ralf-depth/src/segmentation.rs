//! Segmentation networks: the class of each pixel of a view.

use crate::card::{Card, SegmentationCard};
use crate::colour::Colour;
use crate::fit::Framed;
use crate::model::fingerprint;
use crate::network::{Network, Tensor, classes_output, depth_size, score_size};
use crate::plane::Plane;
use crate::runner::{Runner, whole};
use crate::{NetworkError, Runtime};
use ralf::sensors::{CameraImage, ClassImage};
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// A segmentation network of an `.onnx` file.
///
/// ```no_run
/// use ralf_depth::{Runtime, SegmentationModel};
/// # fn main() -> Result<(), ralf_depth::NetworkError> {
/// # let view = ralf::sensors::CameraImage { width: 0, height: 0, rgb: vec![] };
/// // Reads the card models/segformer.toml.
/// let model = SegmentationModel::load(Runtime::default(), "models/segformer.onnx".as_ref(), None)?;
/// let classes = model.segment(&view)?;
/// assert_eq!(classes.ids.len(), view.rgb.len());
/// # Ok(())
/// # }
/// ```
pub struct SegmentationModel {
    file: PathBuf,
    card: SegmentationCard,
    network: Box<dyn Network>,
    /// Index of the classes among the network's outputs.
    output: usize,
    fingerprint: String,
}

impl SegmentationModel {
    /// Loads a network with its card, which lies beside it unless it is given.
    pub fn load(runtime: Runtime, model: &Path, card: Option<&Path>) -> Result<Self, NetworkError> {
        let bytes = ralf_files::read(model, Kind::Network).map_err(NetworkError::io(model))?;
        let card = SegmentationCard::read(&card.map_or_else(|| Card::beside(model), Path::to_owned))?;
        let fingerprint = fingerprint(model, &bytes, &card)?;
        let network = runtime.network(model, bytes)?;
        let output = classes_output(model, network.as_ref(), &card)?;
        Ok(Self { file: model.to_owned(), card, network, output, fingerprint })
    }

    /// The class of each pixel of a straight view. Deterministic, and may be asked for from several threads at once.
    pub fn segment(&self, view: &CameraImage) -> Result<ClassImage, NetworkError> {
        let Self { file, card, network, output, .. } = self;
        let runner = Runner { file, feed: &card.feed, network: network.as_ref(), output: *output };
        let (framed, image) = Framed::new(&card.feed, &Colour::from_view(view)?);
        let given = Given { runner, classes: card.classes.len(), framed, input: image.size() };
        let places = given.places(runner.run(&image)?)?;
        let ids = places.into_iter().map(|place| card.classes[place].id).collect();
        Ok(ClassImage { width: view.width, height: view.height, ids })
    }

    /// Changes with anything that changes the classes: a stored segmentation with the same fingerprint needn't be
    /// computed again.
    pub fn fingerprint(&self) -> &str {
        &self.fingerprint
    }
}

impl std::fmt::Debug for SegmentationModel {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SegmentationModel")
            .field("file", &self.file)
            .field("card", &self.card)
            .field("runtime", &self.network.runtime())
            .finish_non_exhaustive()
    }
}

/// What an output of a network is read by.
struct Given<'a> {
    runner: Runner<'a>,
    /// How many classes there are.
    classes: usize,
    framed: Framed,
    /// Size of the network's input, px.
    input: [usize; 2],
}

impl Given<'_> {
    /// The place of each pixel's class in the card's list, in the view's size.
    fn places(&self, output: Tensor) -> Result<Vec<usize>, NetworkError> {
        let shape: Vec<_> = output.shape.iter().copied().map(Some).collect();
        if let Some(size) = whole(score_size(&shape, self.classes), self.input) {
            return self.best(&output.values, size);
        }
        let Some([width, height]) = whole(depth_size(&shape), self.input) else {
            let ([width, height], classes) = (self.input, self.classes);
            let expected =
                format!("[1, {classes}, {height}, {width}], [1, {height}, {width}] or the same smaller");
            return Err(self.runner.wrong(&expected, format!("{:?}", output.shape)));
        };
        self.told(Plane { width, height, values: output.values })
    }

    /// The class of the largest score, the first of several; scores are interpolated.
    fn best(&self, scores: &[f32], [width, height]: [usize; 2]) -> Result<Vec<usize>, NetworkError> {
        self.runner.finite(scores, width)?;
        let (mut best, mut places): (Vec<f32>, Vec<usize>) = (Vec::new(), Vec::new());
        for (class, scores) in scores.chunks_exact(width * height).enumerate() {
            let scores = self.framed.back(Plane { width, height, values: scores.to_vec() }, Plane::resized);
            if class == 0 {
                (places, best) = (vec![0; scores.values.len()], scores.values);
                continue;
            }
            for ((best, place), score) in best.iter_mut().zip(&mut places).zip(scores.values) {
                if score > *best {
                    (*best, *place) = (score, class);
                }
            }
        }
        Ok(places)
    }

    /// The classes that the network tells by their places.
    fn told(&self, places: Plane) -> Result<Vec<usize>, NetworkError> {
        let is_place = |value: &f32| value.fract() == 0.0 && (0.0..self.classes as f32).contains(value);
        if let Some(index) = places.values.iter().position(|value| !is_place(value)) {
            let (row, column) = (index / places.width, index % places.width);
            let expected = format!("the place of a class, from 0 to {}", self.classes - 1);
            let found = format!("{} in row {row}, column {column}", places.values[index]);
            return Err(self.runner.wrong(&expected, found));
        }
        let places = self.framed.back(places, Plane::nearest);
        Ok(places.values.into_iter().map(|place| place as usize).collect())
    }
}
