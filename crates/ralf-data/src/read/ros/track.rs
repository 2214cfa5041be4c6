//! When a sensor measured, with the messages that can't be read.

use ralf_ros::container::MessageRef;

/// The messages of each sensor, in the order of its timeline.
pub(super) type MessagesPerSensor = Vec<Vec<MessageRef>>;

/// A clock that has other times than 0, but none this near to it, ns, never was at 0.
const NEAR_NS: u64 = 1_000_000_000;

/// Whether some of these times are 0 for want of a clock.
pub(super) fn has_unstamped(times: impl Iterator<Item = i64>) -> bool {
    let (zeros, others): (Vec<i64>, Vec<i64>) = times.partition(|t_ns| *t_ns == 0);
    !zeros.is_empty() && !others.is_empty() && others.iter().all(|t_ns| t_ns.unsigned_abs() > NEAR_NS)
}

/// The messages of a sensor.
#[derive(Default)]
pub(super) struct Track {
    /// The frame that its messages name.
    pub(super) frame: String,
    /// Time and message, in time order.
    pub(super) readable: Vec<(i64, MessageRef)>,
    /// Those whose header can't be read, in the order of the file.
    pub(super) unreadable: Vec<MessageRef>,
}

impl Track {
    /// Whether there are no messages at all.
    pub(super) fn is_silent(&self) -> bool {
        self.readable.is_empty() && self.unreadable.is_empty()
    }

    /// The first and the last time that is known; `None` where no message can be read.
    pub(super) fn span(&self) -> Option<[i64; 2]> {
        let (first, last) = self.readable.first().zip(self.readable.last())?;
        Some([first.0, last.0])
    }

    /// All measurements in time order. One that can't be read stands where the recorder's time and the usual delay of
    /// the others put it: so the others keep their numbers, and whoever asks for it is told why it can't be read.
    pub(super) fn timeline(&self) -> Vec<(i64, MessageRef)> {
        let delay = self.usual_delay();
        let unreadable = self.unreadable.iter();
        let mut all = self.readable.clone();
        all.extend(unreadable.map(|message| (message.log_ns.saturating_sub(delay), *message)));
        all.sort_by_key(|(t_ns, _)| *t_ns);
        all
    }

    /// Gives messages that were sent before their driver knew the time (a stamp of 0 among others) the recorder's, less
    /// the usual delay of the others. Returns how many.
    pub(super) fn stamp_unstamped(&mut self) -> usize {
        if !has_unstamped(self.readable.iter().map(|(t_ns, _)| *t_ns)) {
            return 0;
        }
        let (mut unstamped, stamped) = self.readable.drain(..).partition(|(t_ns, _)| *t_ns == 0);
        self.readable = stamped;
        let delay = self.usual_delay();
        for (t_ns, message) in &mut unstamped {
            *t_ns = message.log_ns.saturating_sub(delay);
        }
        let count = unstamped.len();
        self.readable.append(&mut unstamped);
        count
    }

    /// Adds the timeline to those of other sensors.
    pub(super) fn keep(&self, times: &mut Vec<Vec<i64>>, messages: &mut MessagesPerSensor) {
        let (own_times, own_messages) = self.timeline().into_iter().unzip();
        times.push(own_times);
        messages.push(own_messages);
    }

    /// By how much the recorder's time is later than the sensor's: the median, ns.
    fn usual_delay(&self) -> i64 {
        let delay = |(t_ns, message): &(i64, MessageRef)| message.log_ns.saturating_sub(*t_ns);
        let mut delays: Vec<i64> = self.readable.iter().map(delay).collect();
        delays.sort_unstable();
        delays.get(delays.len() / 2).copied().unwrap_or_default()
    }
}
