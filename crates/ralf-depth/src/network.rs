//! A loaded network, whatever runs it, and whether it goes with its card.

use crate::{Card, DepthError, InputSize};
use std::path::Path;

/// An input or output of a network.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Port {
    pub(crate) name: String,
    /// `None` where the file leaves a size, or all of them, to be seen.
    pub(crate) shape: Option<Vec<Option<usize>>>,
    /// Whether it holds 32-bit floats, as far as the file says.
    pub(crate) float: bool,
}

/// An array of floats.
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
pub(crate) fn depth_output(file: &Path, network: &dyn Network, card: &Card) -> Result<usize, DepthError> {
    check_input(file, &network.inputs(), card)?;
    let outputs = network.outputs();
    let index = choose_output(file, &outputs, card)?;
    let port = &outputs[index];
    let possible = port.shape.as_ref().is_none_or(|shape| depth_size(shape).is_some());
    if port.float && possible {
        return Ok(index);
    }
    let place = format!("output `{}`", port.name);
    Err(DepthError::content(file, place, "float32 [1, 1, H, W], [1, H, W] or [H, W]", described(port)))
}

/// Height and width of an output's shape, which may begin with sizes of 1; `None` if it is no image.
pub(crate) fn depth_size(shape: &[Option<usize>]) -> Option<[Option<usize>; 2]> {
    let (leading, size) = shape.split_last_chunk::<2>()?;
    let single = leading.len() <= 2 && leading.iter().all(|size| size.is_none_or(|size| size == 1));
    single.then_some(*size)
}

fn check_input(file: &Path, inputs: &[Port], card: &Card) -> Result<(), DepthError> {
    let [input] = inputs else {
        let found = format!("{}: {}", inputs.len(), names(inputs));
        return Err(DepthError::content(file, "inputs", "one, the image", found));
    };
    let (expected, size) = match card.input {
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
    if input.float && fits {
        return Ok(());
    }
    let place = format!("input `{}`", input.name);
    Err(DepthError::content(file, place, format!("{expected}, as the card says"), described(input)))
}

fn choose_output(file: &Path, outputs: &[Port], card: &Card) -> Result<usize, DepthError> {
    let wrong = |expected: String| {
        let found = if outputs.is_empty() { "none".to_owned() } else { names(outputs) };
        Err(DepthError::content(file, "outputs", expected, found))
    };
    match (&card.output_name, outputs) {
        (Some(name), _) => match outputs.iter().position(|port| port.name == *name) {
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
    format!("{} {shape}", if port.float { "float32" } else { "other than float32" })
}
