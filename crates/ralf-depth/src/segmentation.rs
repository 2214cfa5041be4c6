//! Segmentation networks: the class of each pixel of a view.

use crate::card::SegmentationCard;
use crate::colour::Colour;
use crate::fit::Framed;
use crate::loaded::Loaded;
use crate::network::{Tensor, classes_output, depth_size, score_size};
use crate::plane::Plane;
use crate::runner::{Runner, whole};
use crate::{NetworkError, Runtime};
use ralf::sensors::{CameraImage, ClassImage};
use std::path::Path;

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
#[derive(Debug)]
pub struct SegmentationModel(Loaded<SegmentationCard>);

impl SegmentationModel {
    /// Loads a network with its card, which lies beside it unless it is given.
    pub fn load(runtime: Runtime, model: &Path, card: Option<&Path>) -> Result<Self, NetworkError> {
        Loaded::new(runtime, model, card, SegmentationCard::read, classes_output).map(Self)
    }

    /// The class of each pixel of a straight view. Deterministic, and may be asked for from several threads at once.
    pub fn segment(&self, view: &CameraImage) -> Result<ClassImage, NetworkError> {
        let card = &self.0.card;
        let runner = self.0.runner(&card.feed);
        let (framed, image) = Framed::new(&card.feed, &Colour::from_view(view)?);
        let given = Given { runner, classes: card.classes.len(), framed, input: image.size() };
        let places = given.places(runner.run(&image)?)?;
        let ids = places.into_iter().map(|place| card.classes[place].id).collect();
        Ok(ClassImage { width: view.width, height: view.height, ids })
    }

    /// Changes with anything that changes the classes: a stored segmentation with the same fingerprint needn't be
    /// computed again.
    pub fn fingerprint(&self) -> &str {
        self.0.fingerprint()
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
