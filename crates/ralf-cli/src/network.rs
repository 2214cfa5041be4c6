//! Networks from the command line, and running them over a recording's images.

use crate::outcome::UsageError;
use crate::progress::{Progress, say};
use crate::text::counted;
use anyhow::{Context, ensure};
use clap::Args;
use ralf::config::Config;
use ralf::sensors::Sequence;
use ralf_data::read::refuse_to_write_into;
use ralf_data::views::{
    Computed, DepthStore, SegmentationStore, Store, StoredView, Unusable, ViewObserver, images_of_scans,
};
use ralf_data::{DataError, Recording, SequenceReader};
use ralf_depth::{DepthEstimator, OnnxModel, Runtime, SegmentationModel};
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
        let runtime = runtime(
            #[cfg(feature = "ort")]
            self.onnx_runtime,
        );
        let loaded = OnnxModel::load_with(runtime, model, self.depth_card.as_deref());
        loaded.map(Some).context("--depth-model")
    }
}

/// Which segmentation network, and what runs it.
#[derive(Debug, Args)]
pub(crate) struct SegmentationModelArgs {
    /// A segmentation network (.onnx); a card beside it (.toml) says what it wants and gives
    #[arg(long, value_name = "FILE")]
    model: PathBuf,
    /// The network's card, where it doesn't lie beside it
    #[arg(long, value_name = "FILE")]
    card: Option<PathBuf>,
    /// Run the network with ONNX Runtime
    #[cfg(feature = "ort")]
    #[arg(long)]
    onnx_runtime: bool,
}

impl SegmentationModelArgs {
    /// Loads the network.
    pub(crate) fn load(&self) -> anyhow::Result<SegmentationModel> {
        let runtime = runtime(
            #[cfg(feature = "ort")]
            self.onnx_runtime,
        );
        SegmentationModel::load(runtime, &self.model, self.card.as_deref()).context("--model")
    }
}

#[cfg(feature = "ort")]
fn runtime(onnx_runtime: bool) -> Runtime {
    if onnx_runtime { Runtime::OnnxRuntime } else { Runtime::Rten }
}

#[cfg(not(feature = "ort"))]
fn runtime() -> Runtime {
    Runtime::Rten
}

/// The folder for what a network says of a recording's images: the one that is [named](named_elsewhere), else the
/// recording's own.
pub(crate) fn store_folder<'a>(
    named: Option<&'a Path>,
    recording: &'a Recording,
) -> anyhow::Result<&'a Path> {
    let Some(folder) = named else { return own_folder(recording) };
    refuse_to_write_into(&recording.path, folder)?;
    Ok(folder)
}

/// The folder that is named, where that isn't the recording's own.
pub(crate) fn named_elsewhere<'a>(named: Option<&'a Path>, recording: &Recording) -> Option<&'a Path> {
    let real = |path: &Path| path.canonicalize().ok();
    named.filter(|folder| {
        *folder != recording.path && real(folder).is_none_or(|it| Some(it) != real(&recording.path))
    })
}

/// The folder of a recording that can keep what a network says of its images: one of the own layout, for others are
/// only read.
fn own_folder(recording: &Recording) -> anyhow::Result<&Path> {
    ensure!(
        recording.format == "ralf",
        UsageError(format!(
            "expected -o FOLDER, for a recording of the format {} is only read",
            recording.format
        ))
    );
    Ok(&recording.path)
}

/// A store in the folder that is named, else in the recording's own: there no camera's folder may lie elsewhere, as on
/// another disk.
pub(crate) fn without_links<V: StoredView>(
    store: Store<V>,
    named: Option<&Path>,
    recording: &Recording,
) -> anyhow::Result<Store<V>> {
    if named.is_none() {
        let wanted = "expected -o FOLDER, for nothing is written through a link out of the recording";
        store.refuse_links(recording).context(wanted)?;
    }
    Ok(store)
}

/// Images of one sequence: camera and number.
pub(crate) type Images = Vec<(usize, usize)>;

/// All images of a sequence.
pub(crate) fn all_images(sequence: &Sequence) -> Images {
    let cameras = sequence.times.cameras.iter().enumerate();
    cameras.flat_map(|(camera, times)| (0..times.len()).map(move |image| (camera, image))).collect()
}

/// The recording with the network's depth, computed now as far as labelling needs it and stored in `OUT/depth`.
pub(crate) fn depth_for_labelling(
    recording: Recording,
    model: &OnnxModel,
    out: &Path,
    config: &Config,
    jobs: usize,
) -> anyhow::Result<Recording> {
    let store = DepthStore::among_labels(out, model.output(), model.fingerprint())?;
    let tolerance = config.sync.camera_tolerance_ms;
    let asked = |sequence: &Sequence| images_of_scans(sequence, tolerance);
    let without = fill_depth(&store, &recording, model, asked, jobs)?;
    Ok(store.attach_but(recording, without))
}

/// Computes what a store lacks of a recording's depth. Images that can't be used are named, and have no depth.
pub(crate) fn fill_depth(
    store: &DepthStore,
    recording: &Recording,
    model: &OnnxModel,
    images: impl Fn(&Sequence) -> Images,
    jobs: usize,
) -> anyhow::Result<Vec<Vec<Unusable>>> {
    let estimate = |view: &_, focal| model.estimate(view, focal).map_err(|error| error.to_string());
    fill("depth", recording, images, &|reader, images, observer| {
        store.compute(reader, images, &estimate, jobs, observer)
    })
}

/// Computes what a store lacks of a recording's segmentations. Images that can't be used are named, and have none.
pub(crate) fn fill_segmentation(
    store: &SegmentationStore,
    recording: &Recording,
    model: &SegmentationModel,
    jobs: usize,
) -> anyhow::Result<Vec<Vec<Unusable>>> {
    let estimate = |view: &_, _| model.segment(view).map_err(|error| error.to_string());
    fill("segmentation", recording, all_images, &|reader, images, observer| {
        store.compute(reader, images, &estimate, jobs, observer)
    })
}

/// Runs a network over these images of a sequence.
type Compute<'a> =
    dyn Fn(&dyn SequenceReader, &[(usize, usize)], &ViewObserver) -> Result<Computed, DataError> + 'a;

/// Computes what a network says of a recording's images. Those that can't be used are named, and returned sequence by
/// sequence.
fn fill(
    what: &str,
    recording: &Recording,
    images: impl Fn(&Sequence) -> Images,
    compute: &Compute,
) -> anyhow::Result<Vec<Vec<Unusable>>> {
    let mut without = Vec::new();
    for reader in &recording.sequences {
        let (name, images) = (&reader.sequence().name, images(reader.sequence()));
        let progress = Progress::of_steps(images.len() as u64, format!("{what} of {name}"));
        let computed = compute(reader.as_ref(), &images, &|| progress.advance(1));
        drop(progress);
        let computed = computed.with_context(|| format!("{what} of {name}"))?;
        if computed.again > 0 {
            let images = counted(computed.again, "image");
            say(&format!(
                "{what} of {name}: computed again of {images}, for what was stored is damaged, was not made of them \
                 as they are, or isn't known to be"
            ));
        }
        computed.without.iter().for_each(|image| say(&format!("no {what}: {name}: {image}")));
        without.push(computed.without);
    }
    Ok(without)
}
