//! MAN TruckScenes end to end: a lorry in a bend, whose six LiDARs are brought to one time and say of each detection of
//! six radars whether there is something.
//!
//!     cargo test -p ralf-data --test all lorry -- --nocapture

use crate::truckscenes::{Shape, truth, write_data_set};
use ralf::config::Config;
use ralf::metrics::{Confusion, Rates};
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::Rig;
use ralf_data::SequenceReader;

const SHAPE: Shape = Shape { scans: 7, rays: [360, 16], detections: 60 };

/// Labels against the truth, with the LiDARs of this rig.
fn rates(reader: &dyn SequenceReader, rig: &Rig) -> Rates {
    let config = Config::default();
    let mut counts = Confusion::default();
    for radar in 0..rig.radars.len() {
        let mut window = FrameWindow::new(reader, rig, &config);
        for scan in 0..SHAPE.scans {
            let frame = window.frame(radar, scan as usize).unwrap();
            let labels = Labeler::new(&config).unwrap().label(&frame);
            let truth = truth(radar, scan, &SHAPE);
            assert_eq!(labels.len(), truth.len(), "no detection is dropped");
            for (label, is_real) in labels.iter().zip(truth) {
                counts.add(is_real, label.plausible);
            }
        }
    }
    println!("{counts:?}");
    Rates::new(&counts)
}

#[test]
fn six_lidars_tell_what_is_real() {
    let folder = tempfile::tempdir().unwrap();
    write_data_set(folder.path(), &SHAPE);
    let recording = ralf_data::open(folder.path(), None).unwrap();
    let reader = recording.sequences[0].as_ref();
    let rates = rates(reader, &reader.sequence().rig);
    println!("accuracy {:.3}, F1 {:.3}", rates.accuracy.unwrap(), rates.f1_plausible.unwrap());
    assert!(rates.f1_plausible.unwrap() > 0.9 && rates.accuracy.unwrap() > 0.85);
}
