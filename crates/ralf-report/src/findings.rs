//! All that is counted over the detections of a run, while they pass: none of them stays in memory.

use crate::breakdown::{Groups, Profiles};
use crate::curves::{BINS, Bin, bin_of};
use crate::scored::Scored;
use crate::settings_map::Passed;
use ralf::metrics::{Confusion, Ranked};
use ralf_data::Causes;

/// What the page tells of all detections together.
#[derive(Debug, Default)]
pub(crate) struct Findings {
    /// How many detections there are.
    pub(crate) detections: u64,
    /// How many have each bit of the flags.
    flags: [u64; 16],
    /// By `w`, and by what they are labelled.
    pub(crate) labelled: [Bin; BINS],
    /// By `w`, and by what they truly are.
    pub(crate) truly: [Bin; BINS],
    /// Labels against truth.
    pub(crate) confusion: Confusion,
    /// Those with truth by their plausibility.
    pub(crate) ranked: Ranked,
    /// Those with truth by the settings with which they pass.
    pub(crate) passed: Passed,
    /// Where labels are wrong.
    pub(crate) profiles: Profiles,
    /// Which classes and causes are labelled wrong.
    pub(crate) groups: Groups,
}

impl Findings {
    /// Adds the detections of a scan. The causes that people `said`, by place in the scan and ascending, stand above
    /// those that a file tells.
    pub(crate) fn add(&mut self, scan: &[Scored], causes: Option<&Causes>, said: &[(u32, String)]) {
        let names = causes.map_or(&[][..], Causes::names);
        said.iter().for_each(|(_, cause)| self.groups.name_cause(cause));
        let mut said = said.iter().peekable();
        for (row, scored) in (0_u32..).zip(scan) {
            let by_people = said.next_if(|(point, _)| *point == row).map(|(_, cause)| cause);
            self.detections += 1;
            for (bit, count) in self.flags.iter_mut().enumerate() {
                *count += u64::from(scored.flags >> bit & 1);
            }
            self.labelled[bin_of(scored.w)].add(scored.w, scored.plausible);
            let cause = scored.cause.and_then(|code| names.get(usize::from(code)));
            self.groups.add(scored, by_people.or(cause).map(String::as_str));
            let Some((_, truth)) = scored.truth else { continue };
            self.truly[bin_of(scored.w)].add(scored.w, truth);
            self.confusion.add(truth, scored.plausible);
            self.ranked.add(scored.w.into(), scored.never_passes, truth);
            self.passed.add(scored, truth);
            self.profiles.add(scored, truth);
        }
    }

    /// How many detections have one of these flags.
    pub(crate) fn with_flag(&self, flag: u16) -> u64 {
        self.flags[flag.trailing_zeros() as usize & 15]
    }

    /// Whether the truth says something of any detection.
    pub(crate) fn has_truth(&self) -> bool {
        self.confusion.total() > 0
    }
}
