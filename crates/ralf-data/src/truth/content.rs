//! What a radar's scan holds, as one hash: what people say of detections belongs to a scan with this content,
//! and to no other.

use crate::frames::ScanIndex;
use crate::read::SequenceReader;
use ralf::sensors::{RadarScan, SourceError};
use ralf_corrections::{ContentHash, ScanContent};

/// What a radar's scan holds, as a store of corrections knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HeldContent {
    /// As the recording holds it, whatever settings make of its values.
    delivered: ScanContent,
    /// As settings make it, where that is something else. Earlier versions of the program wrote this one.
    altered: Option<ScanContent>,
}

impl From<ScanContent> for HeldContent {
    fn from(delivered: ScanContent) -> Self {
        Self { delivered, altered: None }
    }
}

impl HeldContent {
    /// Reads what a scan holds: once, and twice where settings change its values.
    ///
    /// # Errors
    /// A scan that can't be read.
    pub fn read(reader: &dyn SequenceReader, at: ScanIndex) -> Result<Self, SourceError> {
        let ScanIndex { radar, scan } = at;
        let content = |scan: RadarScan| {
            // A file of more detections than fit is refused when it is read.
            let detections = u32::try_from(scan.len()).unwrap_or(u32::MAX);
            ScanContent { detections, hash: Some(scan_content(&scan)) }
        };
        let delivered = content(reader.delivered(radar, scan)?);
        let is_altered = reader.alters_values(radar);
        let altered = if is_altered { Some(content(reader.radar_scan(radar, scan)?)) } else { None };
        Ok(Self { delivered, altered: altered.filter(|altered| *altered != delivered) })
    }

    /// What the scan is called among all of which something was said of it. `said` is asked only where it can be called
    /// otherwise than it is delivered: what was said of that under an earlier version goes on to hold.
    ///
    /// # Errors
    /// Those of `said`.
    pub fn among<E>(&self, said: impl FnOnce() -> Result<Vec<ScanContent>, E>) -> Result<ScanContent, E> {
        Ok(match self.altered {
            Some(altered) if said()?.contains(&altered) => altered,
            _ => self.delivered,
        })
    }
}

/// The hash of a scan's detections in their order: every field's values, bit for bit. The
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
    fn what_settings_make_of_a_scan_is_its_content_where_something_was_said_of_that_alone() {
        let content = |byte| ScanContent { detections: 3, hash: Some(ContentHash::new([byte; 32])) };
        let plain = HeldContent::from(content(1));
        let held = HeldContent { altered: Some(content(2)), ..plain };
        let among = |held: HeldContent, said: &[u8]| {
            held.among(|| Ok::<_, ()>(said.iter().map(|byte| content(*byte)).collect())).unwrap()
        };
        assert_eq!(plain.among(|| Err(())), Ok(content(1)), "the store isn't asked");
        for (said, expected) in [(&[][..], 1), (&[1], 1), (&[3], 1), (&[2], 2), (&[1, 2], 2)] {
            assert_eq!(among(held, said), content(expected), "{said:?}");
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
