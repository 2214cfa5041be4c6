//! What a sequence and settings must keep to for frames to be gathered.

use super::{FrameWindow, Key};
use crate::config::Config;
use crate::sensors::{Rig, Sequence, SourceError};

impl FrameWindow<'_> {
    /// Fails where no frame can be gathered.
    pub(super) fn usable(&self) -> Result<(), SourceError> {
        self.refused.as_ref().map_or(Ok(()), |reason| Err(reason.clone().into()))
    }
}

/// Why no frame can be gathered with these; `None` where all is well.
pub(super) fn refusal(sequence: &Sequence, rig: &Rig, config: &Config) -> Option<String> {
    let Sequence { name, times, .. } = sequence;
    let kinds = [
        ("radar", rig.radars.len(), &times.radars),
        ("LiDAR", rig.lidars.len(), &times.lidars),
        ("camera", rig.cameras.len(), &times.cameras),
    ];
    let of_times = |(kind, sensors, times): (&str, usize, &Vec<Vec<i64>>)| {
        if times.len() != sensors {
            let found = times.len();
            return Some(format!(
                "sequence {name}: expected a {kind} timeline per sensor, {sensors}, found {found}"
            ));
        }
        times.iter().enumerate().find_map(|(sensor, times)| {
            let n = times.windows(2).position(|pair| pair[1] < pair[0])?;
            let (before, found) = (times[n], times[n + 1]);
            Some(format!(
                "sequence {name}: {kind} {sensor}, time {}: expected {before} ns or later, found {found} ns",
                n + 1
            ))
        })
    };
    config.check().err().map(|error| error.to_string()).or_else(|| kinds.into_iter().find_map(of_times))
}

/// When a measurement was made, ns, by its sensor's timeline.
pub(super) fn time(kind: &str, times: &[Vec<i64>], (sensor, index): Key) -> Result<i64, SourceError> {
    let found = times.get(sensor).and_then(|times| times.get(index)).copied();
    found.ok_or_else(|| format!("{kind} {sensor} has no measurement {index}").into())
}

/// Refuses a measurement of another time (ns) than its sensor's timeline gives it.
pub(super) fn same_time(expected: i64, found: i64) -> Result<(), SourceError> {
    if found == expected {
        return Ok(());
    }
    Err(format!("expected the timeline's time, {expected} ns, found {found} ns").into())
}
