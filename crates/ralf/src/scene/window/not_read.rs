//! What could not be read of a frame, also where it lies in things that frames share.

use super::super::frame::{NotRead, SensorKind, Unreadable};
use super::super::lidar::LidarView;
use super::{FrameWindow, Key, NearLidars};
use crate::sensors::SourceError;
use std::mem;
use std::sync::Arc;

/// What was made, and of what it had to do without: whoever uses it does without these, too.
#[derive(Clone)]
pub(super) struct Noted<T> {
    made: T,
    not_read: Arc<[NotRead]>,
}

impl FrameWindow<'_> {
    /// A measurement can't be read that the frame in the making wants.
    pub(super) fn note(&mut self, kind: SensorKind, (sensor, index): Key, reason: &str) {
        self.not_read.insert(NotRead { kind, sensor, index, reason: reason.to_owned() });
    }

    /// What comes of this, with what could not be read meanwhile.
    pub(super) fn noting<T>(&mut self, make: impl FnOnce(&mut Self) -> T) -> Noted<T> {
        let before = mem::take(&mut self.not_read);
        let made = make(self);
        let not_read = mem::replace(&mut self.not_read, before);
        Noted { made, not_read: not_read.into_iter().collect() }
    }

    /// What was made, for the frame in the making.
    pub(super) fn noted<T>(&mut self, Noted { made, not_read }: Noted<T>) -> T {
        self.not_read.extend(not_read.iter().cloned());
        made
    }

    /// [`Self::lidar_view`] of those LiDAR scans that can be read, and the others.
    ///
    /// # Errors
    /// A sequence that can't be used.
    pub fn readable_lidar_view(
        &mut self,
        t_ns: i64,
    ) -> Result<(Option<LidarView>, Vec<Unreadable>), SourceError> {
        self.usable()?;
        let NearLidars { view, unreadable, .. } = self.near_lidars(t_ns);
        Ok((view, unreadable))
    }
}
