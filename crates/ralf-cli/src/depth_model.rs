//! A depth network from the command line, and running it over a recording's images.

use crate::progress::{Progress, say};
use anyhow::Context;
use clap::Args;
use ralf::config::{Config, nanoseconds};
use ralf::sensors::Sequence;
use ralf::space::sync;
use ralf_data::depth::{DepthStore, compute_depth};
use ralf_data::{Recording, SequenceReader};
use ralf_depth::{DepthEstimator, OnnxModel};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Which network, and what runs it.
#[derive(Debug, Args)]
pub(crate) struct DepthModelArgs {
    /// A monocular depth network (.onnx); a card beside it (.toml) says what it wants and gives
    #[arg(long, value_name = "FILE")]
    pub(crate) depth_model: Option<PathBuf>,
    /// The network's card, where it doesn't lie beside it
    #[arg(long, value_name = "FILE", requires = "depth_model")]
    depth_card: Option<PathBuf>,
    /// Run the network with ONNX Runtime
    #[cfg(feature = "ort")]
    #[arg(long, requires = "depth_model")]
    onnx_runtime: bool,
}

impl DepthModelArgs {
    /// Loads the network, where one is given.
    pub(crate) fn load(&self) -> anyhow::Result<Option<OnnxModel>> {
        let Some(model) = &self.depth_model else { return Ok(None) };
        Ok(Some(OnnxModel::load_with(self.runtime(), model, self.depth_card.as_deref())?))
    }

    #[cfg(feature = "ort")]
    fn runtime(&self) -> ralf_depth::Runtime {
        if self.onnx_runtime { ralf_depth::Runtime::OnnxRuntime } else { ralf_depth::Runtime::Rten }
    }

    #[cfg(not(feature = "ort"))]
    fn runtime(&self) -> ralf_depth::Runtime {
        ralf_depth::Runtime::Rten
    }
}

/// Images of one sequence: camera and number.
pub(crate) type Images = Vec<(usize, usize)>;

/// All images of a sequence.
pub(crate) fn all_images(sequence: &Sequence) -> Images {
    let cameras = sequence.times.cameras.iter().enumerate();
    cameras.flat_map(|(camera, times)| (0..times.len()).map(move |image| (camera, image))).collect()
}

/// The images that are nearest to some radar scan, within a tolerance in ms: those that labelling asks for.
fn images_of_scans(sequence: &Sequence, tolerance_ms: f64) -> Images {
    let tolerance = nanoseconds(tolerance_ms);
    let cameras = sequence.times.cameras.iter().enumerate();
    let of_camera = |(camera, times): (usize, &Vec<i64>)| {
        let scans = sequence.times.radars.iter().flatten();
        let images: BTreeSet<usize> =
            scans.filter_map(|t_ns| sync::nearest(times, *t_ns, tolerance)).collect();
        images.into_iter().map(move |image| (camera, image)).collect::<Vec<_>>()
    };
    cameras.flat_map(of_camera).collect()
}

/// The recording with the network's depth, computed now as far as labelling needs it and stored in `OUT/depth`.
pub(crate) fn depth_for_labelling(
    recording: Recording,
    model: &OnnxModel,
    out: &Path,
    config: &Config,
    jobs: usize,
) -> anyhow::Result<Recording> {
    let network = model.fingerprint();
    let folder = out.join("depth").join(&network[..network.len().min(12)]);
    let store = DepthStore::create(&folder, model.output(), network)?;
    let tolerance = config.sync.camera_tolerance_ms;
    fill(&store, &recording, model, |sequence| images_of_scans(sequence, tolerance), jobs)?;
    Ok(store.attach(recording))
}

/// Computes what a store lacks of a recording's depth. Images that can't be used are named, and have no depth.
pub(crate) fn fill(
    store: &DepthStore,
    recording: &Recording,
    model: &OnnxModel,
    images: impl Fn(&Sequence) -> Images,
    jobs: usize,
) -> anyhow::Result<usize> {
    let mut without = 0;
    for reader in &recording.sequences {
        without += fill_sequence(store, reader.as_ref(), model, &images(reader.sequence()), jobs)?;
    }
    Ok(without)
}

fn fill_sequence(
    store: &DepthStore,
    reader: &dyn SequenceReader,
    model: &OnnxModel,
    images: &[(usize, usize)],
    jobs: usize,
) -> anyhow::Result<usize> {
    let name = &reader.sequence().name;
    let progress = Progress::of_steps(images.len() as u64, format!("depth of {name}"));
    let estimate = |view: &_, focal| model.estimate(view, focal).map_err(|error| error.to_string());
    let without = compute_depth(reader, images, store, &estimate, jobs, &|| progress.advance(1));
    drop(progress);
    let without = without.with_context(|| format!("depth of {name}"))?;
    without.iter().for_each(|error| say(&format!("no depth: {name}: {error}")));
    Ok(without.len())
}
