//! What a window need not remember any longer.

use super::FrameWindow;
use crate::config::nanoseconds;

impl FrameWindow<'_> {
    /// Forgets the images and the LiDARs' moments that no frame of this time or later asks for. Whoever goes back in
    /// time gets the same frames, and waits for what is made anew.
    ///
    /// What is nearest to a time is never earlier than what is nearest to a time before: so everything before that is
    /// past. Evidence looks back for seconds, and keeps its moments.
    pub(super) fn forget_what_is_past(&mut self, t_ns: i64) {
        let times = &self.source.sequence().times.cameras;
        let mut earliest: Vec<i64> = vec![t_ns; times.len()];
        for (camera, image) in self.nearest_images(t_ns) {
            earliest[camera] = times[camera][image];
        }
        let is_past = |&(camera, image): &(usize, usize)| times[camera][image] < earliest[camera];
        self.images.forget(is_past);
        self.segmented.forget(is_past);
        if !self.evidence {
            let earliest = self.earliest_moment(t_ns, &earliest);
            self.moments.forget(|(moment, _)| *moment < earliest);
        }
    }

    /// No moment that is asked for at a time, for itself or for images of these times, is earlier.
    fn earliest_moment(&self, t_ns: i64, images: &[i64]) -> i64 {
        let timelines = &self.source.sequence().times.lidars;
        let mut earliest = t_ns;
        for time in images.iter().copied().chain([t_ns]) {
            let nearest =
                self.nearest_lidar_scans(time).into_iter().map(|(lidar, scan)| timelines[lidar][scan]);
            earliest = nearest.chain([time]).fold(earliest, i64::min);
        }
        if self.config.lidar.scans > 1 {
            // Those around the nearest one, with the scans of the other LiDARs nearest to each.
            let reach = nanoseconds(self.config.lidar.reach_ms);
            let tolerance = nanoseconds(self.config.sync.lidar_tolerance_ms);
            earliest = earliest.saturating_sub(reach.saturating_add(tolerance));
        }
        earliest
    }
}
