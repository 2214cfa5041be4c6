//! `ralf depth`: the depth of every image, once for all; and how well it fits the LiDAR.

use crate::arguments::{DatasetArgs, SettingsArgs, threads};
use crate::network::{DepthModelArgs, all_images, fill_depth, named_elsewhere, store_folder, without_links};
use crate::outcome::{Outcome, UsageError};
use crate::progress::say;
use crate::run_summary::unusable;
use crate::text::{aligned, grouped, print};
use anyhow::{Context, ensure};
use clap::Args;
use ralf_data::views::{CameraCheck, DepthStore, check_scalings};
use ralf_data::{Recording, sensors_file};
use ralf_depth::{DepthEstimator, OnnxModel};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Arguments of `ralf depth`.
#[derive(Debug, Args)]
#[command(after_help = "\
Depth is stored as CAMERA/depth/000000.npy: in the dataset itself where it has RALF's own layout, else in the same \
tree below the folder given with -o, where `ralf label --depth FOLDER` finds it. What is stored already is not \
computed again, unless it is damaged, or was made of another image or of other views of it, or nothing beside it \
tells of which. \
Where depth lies of which nothing tells whose it is (no depth.toml), none is added. \
In the dataset itself `[depth] output` of each sequence.toml must say what the network's card says.

Examples:
  ralf depth recordings/city --depth-model midas.onnx -o depth-of-city
  ralf depth nuscenes --depth-model midas.onnx -o depth-of-nuscenes
  ralf depth recordings/city --depth-model midas.onnx -o depth-of-city --check   which scaling fits best?")]
pub(crate) struct DepthArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    #[command(flatten)]
    model: DepthModelArgs,
    /// Folder for the depth images; with --check and no network, of those that are checked
    #[arg(short, long, value_name = "FOLDER")]
    output: Option<PathBuf>,
    /// Print how far depth lies from LiDAR points that it was not scaled with: local, RANSAC and Huber scaling
    #[arg(long)]
    check: bool,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Images side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// With --check: as JSON
    #[arg(long, requires = "check")]
    json: bool,
}

/// Computes depth, or checks it.
pub(crate) fn run(arguments: &DepthArgs) -> anyhow::Result<Outcome> {
    let mut settings = arguments.settings.resolve()?;
    settings.topics = arguments.dataset.topics_or(&settings.topics)?;
    // Networks see images alone; where the LiDAR lies on them is what is corrected.
    let mut recording = match arguments.check {
        true => arguments.dataset.open_corrected(&settings)?,
        false => arguments.dataset.open_with(&settings.topics)?,
    };
    let model = arguments.model.load()?;
    ensure!(
        model.is_some() || arguments.check,
        UsageError("expected --depth-model FILE, --check or both".into())
    );
    let mut outcome = Outcome::Done;
    if let Some(model) = model {
        let store = arguments.store(&recording, &model)?;
        let jobs = threads(arguments.jobs);
        let without = fill_depth(&store, &recording, &model, all_images, jobs)?;
        outcome = Outcome::done_if(without.iter().all(Vec::is_empty));
        recording = store.attach(recording);
    } else if let Some(folder) = &arguments.output {
        recording = DepthStore::open(folder)?.attach(recording);
    }
    if arguments.check {
        let mut checks = Vec::new();
        for reader in &recording.sequences {
            let found =
                check_scalings(reader.as_ref(), &settings.method).map_err(anyhow::Error::from_boxed)?;
            let left_out = found.iter().map(|check| (check.camera.as_str(), check.unusable.as_slice()));
            unusable("left out", &reader.sequence().name, left_out).for_each(|line| say(&line));
            checks.push((reader.sequence().name.clone(), found));
        }
        print(&if arguments.json { json(&checks)? } else { table(&checks) })?;
    }
    Ok(outcome)
}

impl DepthArgs {
    /// Where depth goes. A dataset of the own layout says what its depth images hold, which the network must give.
    fn store(&self, recording: &Recording, model: &OnnxModel) -> anyhow::Result<DepthStore> {
        let output = model.output();
        let named = named_elsewhere(self.output.as_deref(), recording);
        let folder = store_folder(named, recording)?;
        let of_recording = if named.is_none() { recording.sequences.as_slice() } else { &[] };
        for reader in of_recording {
            let declared = reader.sequence().depth_output;
            let file = sensors_file(&recording.path, &reader.sequence().name);
            ensure!(
                declared == output,
                "{}: [depth] output: expected `{output}` as the network's card says, found `{declared}`",
                file.display()
            );
        }
        let store = DepthStore::create(folder, output, model.fingerprint())?;
        without_links(store, named, recording)
    }
}

fn table(checks: &[(String, Vec<CameraCheck>)]) -> String {
    let head = ["sequence", "camera", "views", "LiDAR points", "local", "RANSAC", "Huber"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for (sequence, cameras) in checks {
        rows.extend(cameras.iter().map(|check| {
            let residual =
                |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{:.1} %", 100.0 * value));
            let mut row = vec![sequence.clone(), check.camera.clone(), grouped(check.views as u64)];
            row.push(grouped(check.samples as u64));
            row.extend(check.residuals.map(residual));
            row
        }));
    }
    format!(
        "median |Z - Z_lidar| / Z_lidar, each scaling fitted to every other LiDAR point and measured on the rest\n{}",
        aligned(&rows)
    )
}

fn json(checks: &[(String, Vec<CameraCheck>)]) -> anyhow::Result<String> {
    let camera = |check: &CameraCheck| {
        let [local, ransac, huber] = check.residuals;
        serde_json::json!({
            "camera": check.camera, "views": check.views, "samples": check.samples,
            "local": local, "ransac": ransac, "huber": huber,
        })
    };
    let sequences: serde_json::Map<String, serde_json::Value> =
        checks.iter().map(|(name, cameras)| (name.clone(), cameras.iter().map(camera).collect())).collect();
    serde_json::to_string_pretty(&sequences).context("residuals as JSON")
}
