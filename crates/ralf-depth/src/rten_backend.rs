//! Networks run by rten: in Rust throughout, on the processor, nothing to install.

use crate::network::{Element, Network, Port, Tensor};
use crate::spares::Spares;
use crate::wire;
use rten::{DataType, Dimension, Model, NodeId, RunOptions, ThreadPool, Value, ValueType};
use rten_tensor::prelude::*;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;

/// For errors.
pub(crate) const NAME: &str = "rten";

/// A loaded network.
pub(crate) struct RtenNetwork {
    model: Model,
    /// Pools of one thread each: a run always takes the same way through the sums, and waits for no other.
    pools: Spares<Arc<ThreadPool>>,
}

impl RtenNetwork {
    /// Loads the bytes of an `.onnx` file; the error says why it can't.
    pub(crate) fn load(bytes: Vec<u8>) -> Result<Self, String> {
        wire::check(&bytes)?;
        let model = guarded(|| Model::load(bytes).map_err(|error| error.to_string()))?;
        Ok(Self { model, pools: Spares::holding(Vec::new()) })
    }

    fn ports(&self, nodes: &[NodeId]) -> Vec<Port> {
        nodes.iter().map(|node| self.port(*node)).collect()
    }

    fn port(&self, node: NodeId) -> Port {
        let info = self.model.node_info(node);
        let size = |dimension: Dimension| match dimension {
            Dimension::Fixed(size) => Some(size),
            Dimension::Symbolic(_) => None,
        };
        let shape = info.as_ref().and_then(|info| info.shape());
        let element = match info.as_ref().and_then(|info| info.dtype()) {
            Some(ValueType::Tensor(DataType::Float)) | None => Element::Float,
            Some(ValueType::Tensor(DataType::Int32)) => Element::Whole,
            Some(_) => Element::Other,
        };
        Port {
            name: info.as_ref().and_then(|info| info.name()).unwrap_or_default().to_owned(),
            shape: shape.map(|shape| shape.into_iter().map(size).collect()),
            element,
        }
    }

    fn run_on(&self, pool: &Arc<ThreadPool>, input: Tensor, output: usize) -> Result<Tensor, String> {
        let input = Value::from_shape(input.shape, input.values).map_err(|error| error.to_string())?;
        let node = *self.model.output_ids().get(output).ok_or("no such output")?;
        let feed = *self.model.input_ids().first().ok_or("no input")?;
        let options = RunOptions::default().with_thread_pool(Some(Arc::clone(pool)));
        let outputs = self.model.run(vec![(feed, input.into())], &[node], Some(options));
        let value = outputs.map_err(|error| error.to_string())?.pop().ok_or("no output")?;
        numbers(value).ok_or_else(|| "an output other than float32 or int".to_owned())
    }
}

/// An output's numbers; rten's whole ones have 32 bits, whatever the file says.
fn numbers(value: Value) -> Option<Tensor> {
    if let Value::Int32Tensor(tensor) = &value {
        let values = tensor.iter().map(|value| *value as f32).collect();
        return Some(Tensor { shape: tensor.shape().to_vec(), values });
    }
    let tensor = value.into_tensor::<f32>()?;
    Some(Tensor { shape: tensor.shape().to_vec(), values: tensor.to_vec() })
}

impl Network for RtenNetwork {
    fn runtime(&self) -> &'static str {
        NAME
    }

    fn inputs(&self) -> Vec<Port> {
        self.ports(self.model.input_ids())
    }

    fn outputs(&self) -> Vec<Port> {
        self.ports(self.model.output_ids())
    }

    fn run(&self, input: Tensor, output: usize) -> Result<Tensor, String> {
        let new_pool = || Ok(Arc::new(ThreadPool::with_num_threads(1)));
        self.pools.with(new_pool, |pool| guarded(|| self.run_on(pool, input, output)))
    }
}

/// A panic as an error: rten returns an error for nearly all that can be wrong with a file, but not for all.
fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| Err("it panicked".to_owned()))
}
