//! What a radar's scan holds, as one hash: what people say of detections belongs to a scan with this content,
//! and to no other.

use ralf::sensors::RadarScan;
use ralf_corrections::ContentHash;

/// The hash of a scan's detections in their order: every field's values, bit for bit as they were read. The
/// time of the scan and the radar's mounting are not in it, for these may be corrected without the detections
/// becoming others.
pub fn scan_content(scan: &RadarScan) -> ContentHash {
    let mut hasher = blake3::Hasher::new();
    for count in [scan.columns.len(), scan.len()] {
        hasher.update(&(count as u64).to_le_bytes());
    }
    for column in &scan.columns {
        let bytes: Vec<u8> = column.iter().copied().flat_map(f32::to_le_bytes).collect();
        hasher.update(&bytes);
    }
    ContentHash::new(*hasher.finalize().as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::space::{Point, Spherical};

    fn scan(columns: &[&[f32]]) -> RadarScan {
        let rows = columns[0].len();
        let positions = vec![Point::origin(); rows];
        let spherical = vec![Spherical { range: 0.0, azimuth: 0.0, elevation: 0.0 }; rows];
        RadarScan {
            t_ns: 0,
            columns: columns.iter().map(|column| column.to_vec()).collect(),
            positions,
            spherical,
        }
    }

    #[test]
    fn other_values_another_order_and_another_shape_are_other_contents() {
        let hash = |columns: &[&[f32]]| scan_content(&scan(columns));
        let first = hash(&[&[1.0, 2.0], &[3.0, f32::NAN]]);
        assert_eq!(hash(&[&[1.0, 2.0], &[3.0, f32::NAN]]), first);
        for other in [
            hash(&[&[2.0, 1.0], &[f32::NAN, 3.0]]),
            hash(&[&[1.0, 2.0], &[3.0, 4.0]]),
            hash(&[&[1.0, 2.0, 3.0, f32::NAN]]),
            hash(&[&[1.0], &[2.0], &[3.0], &[f32::NAN]]),
            hash(&[&[1.0, 2.0]]),
        ] {
            assert_ne!(other, first);
        }
        let later = RadarScan { t_ns: 5, ..scan(&[&[1.0, 2.0], &[3.0, f32::NAN]]) };
        assert_eq!(scan_content(&later), first);
    }
}
