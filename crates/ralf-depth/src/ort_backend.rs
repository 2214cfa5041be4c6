//! Networks run by ONNX Runtime, from its shared library.

use crate::NetworkError;
use crate::network::{Element, Network, Port, Tensor};
use crate::spares::Spares;
use crate::wire;
use ort::environment::Environment;
use ort::session::Session;
use ort::session::builder::GraphOptimizationLevel;
use ort::value::{Outlet, TensorElementType, TensorRef, ValueType};
use std::path::PathBuf;
use std::sync::OnceLock;

/// For errors.
pub(crate) const NAME: &str = "ONNX Runtime";

/// There is one per process. `Err` says why there is none.
static ENVIRONMENT: OnceLock<Result<Environment, String>> = OnceLock::new();

/// A loaded network.
pub(crate) struct OrtNetwork {
    file: Vec<u8>,
    inputs: Vec<Port>,
    outputs: Vec<Port>,
    /// A session runs one image at a time.
    sessions: Spares<Session>,
}

/// Loads the library, once per process.
pub(crate) fn require_library() -> Result<(), NetworkError> {
    environment().map(drop).map_err(|reason| NetworkError::NoRuntime { runtime: NAME, reason })
}

fn environment() -> Result<&'static Environment, String> {
    let loaded = ENVIRONMENT.get_or_init(|| {
        let named = std::env::var_os("ORT_DYLIB_PATH").filter(|path| !path.is_empty()).map(PathBuf::from);
        load_library(named.unwrap_or_else(|| {
            let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
            PathBuf::from(format!("{prefix}onnxruntime{suffix}"))
        }))
    });
    loaded.as_ref().map_err(String::clone)
}

fn load_library(library: PathBuf) -> Result<Environment, String> {
    let advice = "set the environment variable ORT_DYLIB_PATH to the library of ONNX Runtime 1.17 or newer";
    let builder = ort::init_from(library).map_err(|error| format!("{error}; {advice}"))?;
    builder.build().map_err(|error| error.to_string())
}

impl OrtNetwork {
    /// Loads the bytes of an `.onnx` file; the error says why it can't.
    pub(crate) fn load(file: Vec<u8>) -> Result<Self, String> {
        wire::check(&file)?;
        let session = session(&file)?;
        let ports = |outlets: &[Outlet]| outlets.iter().map(port).collect();
        let (inputs, outputs) = (ports(session.inputs()), ports(session.outputs()));
        Ok(Self { file, inputs, outputs, sessions: Spares::holding(vec![session]) })
    }
}

impl Network for OrtNetwork {
    fn runtime(&self) -> &'static str {
        NAME
    }

    fn inputs(&self) -> Vec<Port> {
        self.inputs.clone()
    }

    fn outputs(&self) -> Vec<Port> {
        self.outputs.clone()
    }

    fn run(&self, input: Tensor, output: usize) -> Result<Tensor, String> {
        self.sessions.with(
            || session(&self.file),
            |session| run(session, &input, output).map_err(|error| error.to_string()),
        )
    }
}

/// A session of one thread: a run always takes the same way through the sums.
fn session(file: &[u8]) -> Result<Session, String> {
    let told = |error: ort::Error| error.to_string();
    let builder = Session::builder(environment()?).map_err(told)?;
    let builder = builder.with_intra_threads(1).map_err(|error| error.to_string())?;
    let builder = builder.with_inter_threads(1).map_err(|error| error.to_string())?;
    let mut builder =
        builder.with_optimization_level(GraphOptimizationLevel::Level3).map_err(|error| error.to_string())?;
    builder.commit_from_memory(file).map_err(told)
}

fn run(session: &mut Session, input: &Tensor, output: usize) -> Result<Tensor, ort::Error> {
    let shape = input.shape.iter().map(|size| *size as i64).collect::<Vec<_>>();
    let view = TensorRef::from_array_view((shape, input.values.as_slice()))?;
    let outputs = session.run(ort::inputs![view])?;
    let found = &outputs[output];
    let sizes = |shape: &[i64]| shape.iter().map(|size| *size as usize).collect();
    if let Ok((shape, places)) = found.try_extract_tensor::<i64>() {
        return Ok(Tensor {
            shape: sizes(shape),
            values: places.iter().map(|place| *place as f32).collect(),
        });
    }
    if let Ok((shape, places)) = found.try_extract_tensor::<i32>() {
        return Ok(Tensor {
            shape: sizes(shape),
            values: places.iter().map(|place| *place as f32).collect(),
        });
    }
    let (shape, values) = found.try_extract_tensor::<f32>()?;
    Ok(Tensor { shape: sizes(shape), values: values.to_vec() })
}

fn port(outlet: &Outlet) -> Port {
    let (element, shape) = match outlet.dtype() {
        ValueType::Tensor { ty, shape, .. } => {
            let sizes = shape.iter().map(|size| usize::try_from(*size).ok()).collect();
            (element(*ty), Some(sizes))
        }
        _ => (Element::Other, None),
    };
    Port { name: outlet.name().to_owned(), shape, element }
}

fn element(ty: TensorElementType) -> Element {
    match ty {
        TensorElementType::Float32 => Element::Float,
        TensorElementType::Int64 | TensorElementType::Int32 => Element::Whole,
        _ => Element::Other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_library_is_named_with_the_way_to_give_one() {
        let error = load_library(PathBuf::from("/nowhere/libonnxruntime.so")).err().unwrap();
        assert!(error.contains("/nowhere/libonnxruntime.so") && error.contains("ORT_DYLIB_PATH"), "{error}");
    }
}
