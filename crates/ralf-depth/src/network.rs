//! A loaded network, whatever runs it, and whether it goes with its card.

use crate::{Card, Feed, InputSize, NetworkError, SegmentationCard};
use std::path::Path;

/// An input or output of a network.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Port {
    pub(crate) name: String,
    /// `None` where the file leaves a size, or all of them, to be seen.
    pub(crate) shape: Option<Vec<Option<usize>>>,
    /// What it holds, as far as the file says.
    pub(crate) element: Element,
}

/// Elements of an input or output.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Element {
    /// 32-bit floats.
    Float,
    /// Whole numbers that count something.
    Whole,
    /// Anything else.
    Other,
}

/// An array of numbers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Tensor {
    pub(crate) shape: Vec<usize>,
    /// Row by row; as many as the shape's product.
    pub(crate) values: Vec<f32>,
}

/// A network that a runtime has loaded. It may be run from several threads at once.
pub(crate) trait Network: Send + Sync {
    /// The runtime's name, for errors.
    fn runtime(&self) -> &'static str;

    /// In the file's order.
    fn inputs(&self) -> Vec<Port>;

    /// In the file's order.
    fn outputs(&self) -> Vec<Port>;

    /// Feeds its only input, and gives the output of this index. Errors are what the runtime says.
    fn run(&self, input: Tensor, output: usize) -> Result<Tensor, String>;
}

/// The index of the output that holds depth. Refuses networks that the card doesn't describe.
pub(crate) fn depth_output(file: &Path, network: &dyn Network, card: &Card) -> Result<usize, NetworkError> {
    let (index, port) = output(file, network, &card.feed, card.output_name.as_deref())?;
    let possible = port.shape.as_ref().is_none_or(|shape| depth_size(shape).is_some());
    if port.element == Element::Float && possible {
        return Ok(index);
    }
    Err(wrong_output(file, &port, "float32 [1, 1, H, W], [1, H, W] or [H, W]"))
}

/// The index of the output that holds classes. Refuses networks that the card doesn't describe.
pub(crate) fn classes_output(
    file: &Path,
    network: &dyn Network,
    card: &SegmentationCard,
) -> Result<usize, NetworkError> {
    let (index, port) = output(file, network, &card.feed, card.output_name.as_deref())?;
    let classes = card.classes.len();
    let scores = |shape: &[Option<usize>]| score_size(shape, classes).is_some();
    let possible = |shape: &Vec<_>| match port.element {
        Element::Float => scores(shape) || depth_size(shape).is_some(),
        Element::Whole => depth_size(shape).is_some(),
        Element::Other => false,
    };
    if port.element != Element::Other && port.shape.as_ref().is_none_or(possible) {
        return Ok(index);
    }
    let expected = format!("scores, float32 [1, {classes}, H, W] as the card says, or places, [1, H, W]");
    Err(wrong_output(file, &port, &expected))
}

/// Height and width of an output's shape that holds a score for each of so many classes; `None` if it doesn't.
pub(crate) fn score_size(shape: &[Option<usize>], classes: usize) -> Option<[Option<usize>; 2]> {
    let [images, found, height, width] = *<&[_; 4]>::try_from(shape).ok()?;
    let fits = images.is_none_or(|images| images == 1) && found.is_none_or(|found| found == classes);
    fits.then_some([height, width])
}

/// The output that the card means, of a network whose input is as the card says.
fn output(
    file: &Path,
    network: &dyn Network,
    feed: &Feed,
    name: Option<&str>,
) -> Result<(usize, Port), NetworkError> {
    check_input(file, &network.inputs(), feed)?;
    let mut outputs = network.outputs();
    let index = choose_output(file, &outputs, name)?;
    Ok((index, outputs.swap_remove(index)))
}

fn wrong_output(file: &Path, port: &Port, expected: &str) -> NetworkError {
    NetworkError::content(file, format!("output `{}`", port.name), expected, described(port))
}

/// Height and width of an output's shape, which may begin with sizes of 1; `None` if it is no image.
pub(crate) fn depth_size(shape: &[Option<usize>]) -> Option<[Option<usize>; 2]> {
    let (leading, size) = shape.split_last_chunk::<2>()?;
    let single = leading.len() <= 2 && leading.iter().all(|size| size.is_none_or(|size| size == 1));
    single.then_some(*size)
}

fn check_input(file: &Path, inputs: &[Port], feed: &Feed) -> Result<(), NetworkError> {
    let [input] = inputs else {
        let found = format!("{}: {}", inputs.len(), names(inputs));
        return Err(NetworkError::content(file, "inputs", "one, the image", found));
    };
    let (expected, size) = match feed.input {
        InputSize::Fixed { width, height } => {
            (format!("float32 [1, 3, {height}, {width}]"), [Some(height), Some(width)])
        }
        InputSize::Scaled { .. } => ("float32 [1, 3, H, W] of free H and W".to_owned(), [None; 2]),
    };
    let wanted = [Some(1), Some(3), size[0], size[1]];
    // A size that the card leaves to the view must be free in the file too.
    let goes = |(found, wanted): (&Option<usize>, &Option<usize>)| found.is_none() || found == wanted;
    let fits =
        input.shape.as_ref().is_none_or(|shape| shape.len() == 4 && shape.iter().zip(&wanted).all(goes));
    if input.element == Element::Float && fits {
        return Ok(());
    }
    let place = format!("input `{}`", input.name);
    Err(NetworkError::content(file, place, format!("{expected}, as the card says"), described(input)))
}

fn choose_output(file: &Path, outputs: &[Port], name: Option<&str>) -> Result<usize, NetworkError> {
    let wrong = |expected: String| {
        let found = if outputs.is_empty() { "none".to_owned() } else { names(outputs) };
        Err(NetworkError::content(file, "outputs", expected, found))
    };
    match (name, outputs) {
        (Some(name), _) => match outputs.iter().position(|port| port.name == name) {
            Some(index) => Ok(index),
            None => wrong(format!("`{name}`, as the card says")),
        },
        (None, [_]) => Ok(0),
        (None, _) => wrong("one, or the card's `output_name` to choose".to_owned()),
    }
}

fn names(ports: &[Port]) -> String {
    ports.iter().map(|port| format!("`{}`", port.name)).collect::<Vec<_>>().join(", ")
}

fn described(port: &Port) -> String {
    let size = |size: &Option<usize>| size.map_or("?".to_owned(), |size| size.to_string());
    let shape = port.shape.as_ref().map_or("of any shape".to_owned(), |shape| {
        format!("[{}]", shape.iter().map(size).collect::<Vec<_>>().join(", "))
    });
    format!("{} {shape}", if port.element == Element::Float { "float32" } else { "other than float32" })
}
