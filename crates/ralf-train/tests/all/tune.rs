//! What tuning weighs must be what the labeler labels.

#[path = "../../../ralf/tests/all/support/mod.rs"]
mod support;

use proptest::prelude::*;
use ralf::config::Config;
use ralf::metrics::Confusion;
use ralf::scene::FrameWindow;
use ralf::sensors::{Elevation, Reliability};
use ralf_train::{Branches, Gatherer, Space, TunedSettings};
use support::{MS, Memory, lidar, radar};

type Points = Vec<[f32; 3]>;

/// Scans of a few points around the vehicle, some of them nowhere, some on the floor, some below the LiDAR.
fn points(count: std::ops::Range<usize>) -> impl Strategy<Value = Points> {
    let coordinate = || prop_oneof![20 => -12.0f32..12.0, 1 => Just(f32::NAN)];
    prop::collection::vec((coordinate(), -12.0f32..12.0, -0.5f32..2.0).prop_map(|(x, y, z)| [x, y, z]), count)
}

/// Scans at a fixed rate.
fn every<T>(ms: i64, scans: Vec<T>) -> Vec<(i64, T)> {
    scans.into_iter().enumerate().map(|(i, scan)| (i as i64 * ms * MS, scan)).collect()
}

prop_compose! {
    fn recording()(
        radar_scans in prop::collection::vec(prop::option::weighted(0.9, points(0..8)), 6..14),
        lidar_scans in prop::collection::vec(points(0..12), 3),
        elevation in prop_oneof![Just(Elevation::Measured), Just(Elevation::None)],
    ) -> Memory {
        let mut front = radar(elevation);
        front.reliability = Reliability::new(vec![(-1.0, 1.0), (1.0, 1.5)]).unwrap();
        Memory::new(5.0).radar(front, every(70, radar_scans)).lidar(lidar(), every(100, lidar_scans))
    }
}

prop_compose! {
    fn settings()(
        alpha in 0.0..=1.0, threshold in 0.0..=1.0, betas in [0.01..2.0, 0.01..2.0, 0.01..2.0],
        neighbours in 1..5usize, scans in 1..5usize, [lidar, camera, tracking] in any::<[bool; 3]>(),
    ) -> TunedSettings {
        let mut settings = TunedSettings::from_config(&Config::default());
        (settings.neighbours, settings.scans) = (neighbours, scans);
        let weights = &mut settings.weights;
        (weights.fusion.alpha, weights.fusion.threshold) = (alpha, threshold);
        [weights.beta_lm, weights.beta_cm, weights.beta_tr] = betas;
        settings.branches = Branches { lidar, camera, tracking };
        settings
    }
}

/// A truth that holds both classes and detections nobody has looked at.
fn truth_of(row: usize) -> Option<bool> {
    [Some(true), Some(false), None][row % 3]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    /// Also of a labeler with fewer branches than the evidence was gathered for.
    fn evidence_gives_the_labelers_labels(
        memory in recording(), tuned in settings(), flat in any::<bool>(),
    ) {
        let ground = if flat { "ground.model=flat" } else { "ground.model=none" };
        let base = Config::from_toml("", &[ground]).unwrap();
        let gatherer = Gatherer::new(&base, Space { neighbours: vec![1, 2, 3, 4], scans: vec![1, 2, 3, 4] }).unwrap();
        let config = tuned.applied_to(&base);
        let (mut table, mut expected) = (gatherer.table(), Vec::new());
        let mut window = FrameWindow::new(&memory, &memory.sequence.rig, gatherer.frame_config());
        for scan in (0..memory.radar_scans[0].len()).filter(|scan| memory.radar_scans[0][*scan].is_some()) {
            let labels = memory.label(&config, 0, scan);
            let truth: Vec<_> = (0..labels.len()).map(truth_of).collect();
            // In two tables, as workers make them.
            let mut one = gatherer.table();
            gatherer.add(&mut one, &window.frame(0, scan).unwrap(), &truth);
            table.append(one);
            let mut counts = Confusion::default();
            let known = labels.iter().zip(&truth).filter_map(|(label, truth)| Some((label, (*truth)?)));
            known.for_each(|(label, truth)| counts.add(truth, label.plausible));
            expected.push(counts);
        }
        prop_assert_eq!(table.scans(), expected.len());
        prop_assert_eq!(table.confusions(&tuned).unwrap(), expected);
    }
}
