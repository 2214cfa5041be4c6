//! Where depth images lie, in the tree of the project's own layout: `ROOT/sequences/NAME/CAMERA/depth/000000.npy`.

use crate::disk::{files, npy};
use crate::error::DataError;
use crate::read::{MotionSource, Recording, SequenceReader, TruthLabels};
use crate::result::{Component, OutFolder, SequenceNames, WriterLock};
use ralf::label::Cause;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, LidarScan, RadarScan, Sequence, Source, SourceError,
};
use ralf_files::Kind;
use serde::{Deserialize, Serialize};
use std::any::Any;
use std::path::{Path, PathBuf};

/// Says what a store holds.
const CARD: &str = "depth.toml";

/// A folder of depth images of one network.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DepthStore {
    root: PathBuf,
    output: DepthOutput,
}

/// `depth.toml`: what the values of a store mean, and which network gave them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StoreToml {
    output: DepthOutput,
    network: String,
}

impl DepthStore {
    /// The store of a network in a folder, begun if there is none. A store of another network is refused.
    pub fn create(root: &Path, output: DepthOutput, network: &str) -> Result<Self, DataError> {
        let file = root.join(CARD);
        let own = StoreToml { output, network: network.to_owned() };
        if file.exists() {
            let found = StoreToml::read(&file)?;
            if found != own {
                let expected = format!("depth of the network {network}, or another folder");
                return Err(DataError::content(
                    &file,
                    "network",
                    expected,
                    format!("that of {}", found.network),
                ));
            }
        } else {
            let text = toml::to_string(&own);
            let text =
                text.map_err(|error| DataError::content(&file, "content", "TOML", error.to_string()))?;
            files::write_whole(&file, text.as_bytes())?;
        }
        Ok(Self { root: root.to_owned(), output })
    }

    /// A store that was made before.
    pub fn open(root: &Path) -> Result<Self, DataError> {
        let StoreToml { output, .. } = StoreToml::read(&root.join(CARD))?;
        Ok(Self { root: root.to_owned(), output })
    }

    /// The file of an image's views.
    pub fn file(&self, sequence: &Component, camera: &Component, image: usize) -> PathBuf {
        let camera = OutFolder::new(&self.root).own("sequences").folder(sequence).folder(camera);
        camera.own("depth").file(&Component::numbered(image, "npy"))
    }

    /// The right to write to it; another process may have that.
    pub(super) fn lock(&self) -> Result<WriterLock, DataError> {
        WriterLock::take(self.root.join(".depth-lock"), &self.root)
    }

    /// Stores the depth of an image's views, whole or not at all.
    pub fn write(
        &self,
        sequence: &Component,
        camera: &Component,
        image: usize,
        views: &[DepthImage],
    ) -> Result<(), DataError> {
        let file = self.file(sequence, camera, image);
        let bytes = npy::depth_bytes(views).ok_or_else(|| {
            DataError::content(
                &file,
                "views",
                "views of one size",
                "different sizes, which one file can't hold",
            )
        })?;
        files::write_whole(&file, &bytes)
    }

    /// A recording with the depth of this store in place of its own.
    pub fn attach(&self, recording: Recording) -> Recording {
        let attach = |inner: Box<dyn SequenceReader>| {
            let sequence = Sequence { depth_output: self.output, ..inner.sequence().clone() };
            // A store has no depth of what can't have a folder in it.
            let names = SequenceNames::new(&sequence).ok();
            Box::new(WithDepth { inner, sequence, names, store: self.clone() }) as Box<dyn SequenceReader>
        };
        Recording { sequences: recording.sequences.into_iter().map(attach).collect(), ..recording }
    }
}

impl StoreToml {
    fn read(file: &Path) -> Result<Self, DataError> {
        let refused = |error: toml::de::Error| {
            DataError::content(file, "content", "output and network", error.to_string())
        };
        toml::from_str(&files::read_text(file, Kind::Settings)?).map_err(refused)
    }
}

/// A sequence whose depth lies in a store.
struct WithDepth {
    inner: Box<dyn SequenceReader>,
    sequence: Sequence,
    names: Option<SequenceNames>,
    store: DepthStore,
}

impl WithDepth {
    fn file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        let names = self.names.as_ref()?;
        let camera = names.cameras.get(camera)?;
        Some(self.store.file(&names.sequence, camera, image)).filter(|file| file.exists())
    }
}

impl Source for WithDepth {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.inner.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.inner.lidar_scan(lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.inner.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        Ok(self.file(camera, image).map(|file| npy::read_depth(&file)).transpose()?)
    }
}

impl SequenceReader for WithDepth {
    fn inputs(&self) -> Vec<PathBuf> {
        let cameras = self.sequence.times.cameras.iter().enumerate();
        let images = cameras.flat_map(|(camera, times)| (0..times.len()).map(move |image| (camera, image)));
        let depth = images.filter_map(|(camera, image)| self.file(camera, image));
        self.inner.inputs().into_iter().chain(depth).collect()
    }

    fn warnings(&self) -> &[String] {
        self.inner.warnings()
    }

    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        self.inner.image_file(camera, image)
    }

    fn lidar_label_file(&self, lidar: usize, scan: usize) -> Option<PathBuf> {
        self.inner.lidar_label_file(lidar, scan)
    }

    fn has_depth(&self, camera: usize) -> bool {
        let images = self.sequence.times.cameras.get(camera).map_or(0, Vec::len);
        (0..images).any(|image| self.file(camera, image).is_some())
    }

    fn origin(&self) -> Option<&dyn Any> {
        self.inner.origin()
    }

    fn rolling_scan(&self, lidar: usize, scan: usize) -> Result<Option<LidarScan>, SourceError> {
        self.inner.rolling_scan(lidar, scan)
    }

    fn motion_source(&self) -> MotionSource {
        self.inner.motion_source()
    }

    fn truth(&self, radar: usize, scan: usize) -> Result<Option<TruthLabels>, SourceError> {
        self.inner.truth(radar, scan)
    }

    fn causes(&self) -> &'static [Cause] {
        self.inner.causes()
    }

    fn truth_file(&self, radar: usize, scan: usize) -> Option<PathBuf> {
        self.inner.truth_file(radar, scan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_stored_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let store = DepthStore::create(folder.path(), DepthOutput::Disparity, "a").unwrap();
        assert_eq!(DepthStore::open(folder.path()).unwrap(), store);
        let other = DepthStore::create(folder.path(), DepthOutput::Disparity, "b").unwrap_err().to_string();
        assert!(other.contains("depth.toml") && other.contains("found that of a"), "{other}");
        let view = |first: f32| DepthImage { width: 2, height: 1, values: vec![first, f32::NAN] };
        let [sequence, camera] = ["00", "front"].map(|name| Component::new(name).unwrap());
        store.write(&sequence, &camera, 3, &[view(1.0), view(2.0)]).unwrap();
        let file = store.file(&sequence, &camera, 3);
        assert!(file.ends_with("sequences/00/front/depth/000003.npy"));
        let read = npy::read_depth(&file).unwrap();
        assert_eq!((read.len(), read[1].values[0], read[1].width), (2, 2.0, 2));
        let wider = DepthImage { width: 3, height: 1, values: vec![1.0; 3] };
        let error = store.write(&sequence, &camera, 4, &[view(1.0), wider]).unwrap_err().to_string();
        assert!(error.contains("one size"), "{error}");
    }
}
