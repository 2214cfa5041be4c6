//! `ralf segment`: the class of every pixel of every image, once for all.

use crate::arguments::{DatasetArgs, SettingsArgs, threads};
use crate::network::{
    SegmentationModelArgs, fill_segmentation, named_elsewhere, store_folder, without_links,
};
use crate::outcome::Outcome;
use clap::Args;
use ralf_data::Recording;
use ralf_data::views::SegmentationStore;
use ralf_depth::SegmentationModel;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Arguments of `ralf segment`.
#[derive(Debug, Args)]
#[command(after_help = "\
Segmentations are stored as CAMERA/segmentation/000000.png, 8 bits of grey that are SemanticKITTI ids: in the dataset \
itself where it has RALF's own layout, else in the same tree below the folder given with -o, where `ralf label \
--segmentation FOLDER` finds them. What is stored already is not computed again, unless it was made of another image \
or of other views of it, or nothing beside it tells of which. Labelling gives plausible detections \
the class of what the cameras see there, where no labels of the LiDAR do.

Of a network that was trained on Cityscapes a card needs three lines:
  preset = \"cityscapes\"
  input = { width = 1024, height = 512 }
  fit = \"stretch\"

Examples:
  ralf segment recordings/city --model segformer.onnx
  ralf segment nuscenes --model segformer.onnx -o classes-of-nuscenes
  ralf label nuscenes --segmentation classes-of-nuscenes -o out")]
pub(crate) struct SegmentArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    #[command(flatten)]
    model: SegmentationModelArgs,
    /// Folder for the segmentations
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Images side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
}

/// Computes segmentations.
pub(crate) fn run(arguments: &SegmentArgs) -> anyhow::Result<Outcome> {
    let settings = arguments.settings.resolve()?;
    let recording = arguments.dataset.open_with(&arguments.dataset.topics_or(&settings.topics)?)?;
    let model = arguments.model.load()?;
    let store = arguments.store(&recording, &model)?;
    let without = fill_segmentation(&store, &recording, &model, threads(arguments.jobs))?;
    Ok(Outcome::done_if(without.iter().all(Vec::is_empty)))
}

impl SegmentArgs {
    fn store(&self, recording: &Recording, model: &SegmentationModel) -> anyhow::Result<SegmentationStore> {
        let named = named_elsewhere(self.output.as_deref(), recording);
        let folder = store_folder(named, recording)?;
        let store = SegmentationStore::create(folder, model.fingerprint())?;
        without_links(store, named, recording)
    }
}
