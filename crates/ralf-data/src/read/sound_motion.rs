//! A last look at the motion of what was opened, whatever its format: by numbers that are none every label would be
//! made, and none would be right.

use crate::error::{DataError, expected_and_found};
use crate::read::opened::Opened;
use crate::read::{Recording, SequenceReader};
use std::path::Path;

/// Leaves out the sequences whose motion has numbers or times that are none; refused where one of them was asked for,
/// or no other is left.
pub(crate) fn with_sound_motion(recording: Recording) -> Result<Recording, DataError> {
    let Recording { path, format, sequences, incomplete, is_selected } = recording;
    let mut read = Opened { sequences: Vec::with_capacity(sequences.len()), incomplete };
    let mut is_sound = true;
    for reader in sequences {
        match check(&path, reader.as_ref()) {
            Ok(()) => read.sequences.push(reader),
            Err(error) if is_selected => return Err(error),
            Err(error) => {
                is_sound = false;
                read.lose(reader.sequence().name.clone(), error);
            }
        }
    }
    let Opened { sequences, incomplete } = if is_sound { read } else { read.or_first_error()? };
    Ok(Recording { path, format, sequences, incomplete, is_selected })
}

fn check(path: &Path, reader: &dyn SequenceReader) -> Result<(), DataError> {
    let sequence = reader.sequence();
    sequence.motion.check().map_err(|(place, reason)| {
        let (expected, found) = expected_and_found(&reason);
        DataError::content(path, format!("sequence {}, motion, {place}", sequence.name), expected, found)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::recording::no_measurement;
    use ralf::sensors::{
        CameraImage, DepthImage, DepthOutput, LidarScan, RadarScan, Rig, Sequence, Source, SourceError,
        Timelines,
    };
    use ralf::space::{EgoMotion, OdometrySample};

    struct Moving(Sequence);

    fn moving(name: &str, yaw_rate: f64) -> Box<dyn SequenceReader> {
        let samples = [(0, 0.0), (1, yaw_rate)];
        let sample = |(t_ns, yaw_rate)| OdometrySample { t_ns, velocity: 8.0, yaw_rate };
        let motion = EgoMotion::new(samples.map(sample).to_vec(), vec![]).unwrap();
        let (name, title) = (name.to_owned(), String::new());
        let (rig, times, depth_output) = (Rig::default(), Timelines::default(), DepthOutput::default());
        Box::new(Moving(Sequence { name, title, rig, times, motion, depth_output }))
    }

    impl Source for Moving {
        fn sequence(&self) -> &Sequence {
            &self.0
        }
        fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
            no_measurement("radar", radar, scan)
        }
        fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
            no_measurement("lidar", lidar, scan)
        }
        fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
            no_measurement("camera", camera, image)
        }
        fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
            no_measurement("camera", camera, image)
        }
    }

    impl SequenceReader for Moving {}

    #[test]
    fn a_motion_that_is_no_number_is_never_labelled_by() {
        let recording = |rates: &[f64]| {
            let sequences = rates.iter().zip(["a", "b"]).map(|(rate, name)| moving(name, *rate));
            Recording::new(Path::new("drive"), "test", sequences.collect())
        };
        let told = "drive: sequence b, motion, odometry: 1: expected finite numbers, found NaN";
        let found = with_sound_motion(recording(&[0.1, f64::NAN])).unwrap();
        assert_eq!((found.sequences.len(), found.left_out()), (1, vec![format!("b: {told}")]));
        let chosen = recording(&[0.1, f64::NAN]).select(&["b".to_owned()]).unwrap();
        assert_eq!(with_sound_motion(chosen).unwrap_err().to_string(), told);
        assert!(with_sound_motion(recording(&[f64::INFINITY])).is_err(), "nothing is left");
        assert_eq!(with_sound_motion(recording(&[0.1, 0.2])).unwrap().sequences.len(), 2);
    }
}
