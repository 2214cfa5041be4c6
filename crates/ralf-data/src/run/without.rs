//! What scans tell beside their detections: which images they asked, and what they had to do without.

use crate::result::{CameraRecord, ImageRecord, ScanNotes, UnreadMeasurement, UnreadableScan};
use ralf::scene::SensorKind;
use ralf::sensors::Camera;
use std::collections::{BTreeMap, BTreeSet};

/// What scans of a sequence tell, each thing once.
#[derive(Default)]
pub(super) struct Without {
    /// By camera and number; several scans may have asked about one.
    images: BTreeMap<String, BTreeMap<usize, ImageRecord>>,
    unreadable: BTreeSet<UnreadableScan>,
    not_read: BTreeSet<UnreadMeasurement>,
}

impl Without {
    /// What another scan tells.
    pub(super) fn add(&mut self, notes: ScanNotes) {
        self.unreadable.extend(notes.unreadable);
        self.not_read.extend(notes.not_read);
        for (camera, image) in notes.images {
            self.images.entry(camera).or_default().insert(image.image, image);
        }
    }

    /// What other scans tell.
    pub(super) fn append(&mut self, more: Self) {
        self.unreadable.extend(more.unreadable);
        self.not_read.extend(more.not_read);
        for (camera, images) in more.images {
            self.images.entry(camera).or_default().extend(images);
        }
    }

    /// What the monitor found about the images that were asked, in the rig's order.
    pub(super) fn cameras(&self, rig: &[Camera]) -> Vec<CameraRecord> {
        let record = |camera: &Camera| {
            let images = self.images.get(&camera.name).into_iter().flat_map(BTreeMap::values);
            CameraRecord::new(&camera.name, images.cloned().collect())
        };
        rig.iter().map(record).collect()
    }

    /// The scans and segmentations that others had to do without, and all that could not be read. Radar scans that are
    /// not labelled are in neither: they are named as such.
    pub(super) fn named(
        &self,
        not_labelled: &BTreeSet<(&str, usize)>,
    ) -> (Vec<UnreadableScan>, Vec<UnreadMeasurement>) {
        let is_named = |UnreadMeasurement { kind, scan }: &&UnreadMeasurement| {
            *kind == SensorKind::Radar && not_labelled.contains(&(scan.sensor.as_str(), scan.scan))
        };
        let not_read: Vec<_> = self.not_read.iter().filter(|found| !is_named(found)).cloned().collect();
        // What is wrong with images the cameras tell.
        let scans = not_read.iter().filter(|found| found.kind != SensorKind::Camera);
        let mut unreadable = self.unreadable.clone();
        unreadable.extend(scans.map(|found| found.scan.clone()));
        (unreadable.into_iter().collect(), not_read)
    }
}
