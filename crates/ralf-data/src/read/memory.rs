//! Arrays in memory as a sequence of a recording: [`crate::write_sequence`] writes them in the own layout, which every
//! command reads. They have no files.

use crate::read::SequenceReader;
use ralf::sensors::{MemorySource, Source};

impl SequenceReader for MemorySource {
    fn has_depth(&self, camera: usize) -> bool {
        let images = self.sequence().times.cameras.get(camera).map_or(0, Vec::len);
        (0..images).any(|image| self.depth(camera, image).is_ok_and(|depth| depth.is_some()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::models::{HDL_32E, ZF_FRGEN21};
    use ralf::sensors::LidarScan;
    use ralf::space::{EgoMotion, OdometrySample, Transform};

    #[test]
    fn arrays_are_written_as_a_recording_and_read_back() {
        let odometry = vec![OdometrySample { t_ns: 0, velocity: 3.0, yaw_rate: 0.0 }];
        let revolution = LidarScan {
            t_ns: 40,
            points: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]],
            times: Some(vec![-0.01, 0.02]),
            intensity: vec![7.0, 8.0],
            classes: Some(vec![50, 0]),
        };
        let columns = vec![vec![9.0, f32::NAN], vec![1.0, 2.0], vec![0.5, 0.25], vec![-3.0, -2.5]];
        let radar = ZF_FRGEN21.mounted("front", &["x", "y", "z", "doppler"], Transform::identity());
        let source = MemorySource::new("00", EgoMotion::new(odometry, vec![]).unwrap())
            .unwrap()
            .with_radar(radar, vec![(30, columns)])
            .and_then(|source| {
                source.with_lidar(HDL_32E.mounted("top", Transform::identity()), vec![revolution])
            })
            .unwrap();
        let folder = tempfile::tempdir().unwrap();
        crate::write_sequence(&source, folder.path(), &|_| ()).unwrap();
        let read = crate::read::open(folder.path(), None).unwrap().sequences.remove(0);
        assert_eq!(read.sequence().times, source.sequence().times);
        let text = |source: &dyn Source| {
            (
                format!("{:?}", source.radar_scan(0, 0).unwrap()),
                format!("{:?}", source.lidar_scan(0, 0).unwrap()),
            )
        };
        assert_eq!(text(read.as_ref()), text(&source));
    }
}
