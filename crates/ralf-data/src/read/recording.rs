//! A recording of any format, seen as its sequences.

use crate::disk::label_file::Label;
use crate::error::DataError;
use crate::read::corrections::{Altered, MotionSource};
use crate::read::incomplete::{Incomplete, Lost, whole};
use ralf::label::Cause;
use ralf::sensors::{LidarScan, RadarScan, Sequence, Source, SourceError};
use std::any::Any;
use std::path::{Path, PathBuf};

/// One sequence of a recording, and the files it is read from.
///
/// A reader that changes part of what another one reads names that one as its [`inner`](Self::inner) reader: whatever
/// it doesn't answer by itself, that one does.
pub trait SequenceReader: Source {
    /// The reader whose sequence this one changes.
    fn inner(&self) -> Option<&dyn SequenceReader> {
        None
    }

    /// Every file that labelling reads, in a fixed order: what a run records with sizes and hashes. None of what has no
    /// files: nothing then tells two of its name apart, and a run labels it anew each time.
    fn inputs(&self) -> Vec<PathBuf> {
        self.inner().map_or_else(Vec::new, |inner| inner.inputs())
    }

    /// What was ignored or is missing, a sentence each, for people.
    fn warnings(&self) -> &[String] {
        self.inner().map_or(&[], |inner| inner.warnings())
    }

    /// Which of the warnings says that the recording doesn't tell the vehicle's motion: no news to whoever was told
    /// where else to take it from.
    fn warning_of_motion(&self) -> Option<&'static str> {
        self.inner().and_then(|inner| inner.warning_of_motion())
    }

    /// What of the recording can't be read and may have held radar scans that nothing else tells of, a sentence each:
    /// they have no place in the timelines, and get no labels. Radar scans whose times are known stand in the
    /// timelines, and whoever asks for them is told why they can't be read.
    fn lost(&self) -> &[String] {
        self.inner().map_or(&[], |inner| inner.lost())
    }

    /// Names of sensors of which nothing can be read: the rig lacks them, and settings may name them all the same.
    fn absent(&self) -> &[String] {
        self.inner().map_or(&[], |inner| inner.absent())
    }

    /// The file of a camera's image, to be copied as it is; `None` where an image has no file of its own.
    fn image_file(&self, camera: usize, image: usize) -> Option<PathBuf> {
        self.inner().and_then(|inner| inner.image_file(camera, image))
    }

    /// The `.label` file of a LiDAR's scan, to be copied as it is: it also numbers instances.
    fn lidar_label_file(&self, lidar: usize, scan: usize) -> Option<PathBuf> {
        self.inner().and_then(|inner| inner.lidar_label_file(lidar, scan))
    }

    /// The `.label` file with the corrected labels of a radar's scan.
    fn truth_file(&self, radar: usize, scan: usize) -> Option<PathBuf> {
        self.inner().and_then(|inner| inner.truth_file(radar, scan))
    }

    /// The `.cause` file of a radar's scan, to be copied as it is.
    fn cause_file(&self, radar: usize, scan: usize) -> Option<PathBuf> {
        self.inner().and_then(|inner| inner.cause_file(radar, scan))
    }

    /// The file that names the codes of these, to be copied as it is.
    fn cause_names_file(&self) -> Option<PathBuf> {
        self.inner().and_then(|inner| inner.cause_names_file())
    }

    /// What only its own format knows of it, such as the names that the format's tables give to scans: an export into
    /// that format asks for the type that its reader hands out.
    fn origin(&self) -> Option<&dyn Any> {
        self.inner().and_then(|inner| inner.origin())
    }

    /// What settings alter of what [`origin`](Self::origin) holds. The names of scans and how many there are stay.
    fn altered(&self) -> Altered {
        self.inner().map_or(Altered::Nothing, |inner| inner.altered())
    }

    /// Whether any image of a camera has depth: without it, labelling doesn't use the camera.
    fn has_depth(&self, camera: usize) -> bool {
        self.inner().is_some_and(|inner| inner.has_depth(camera))
    }

    /// Whether any image of any camera has a segmentation.
    fn has_segmentation(&self) -> bool {
        self.inner().is_some_and(|inner| inner.has_segmentation())
    }

    /// A LiDAR's scan with its points as they were measured, each at its own time, where the recording holds them so;
    /// `None` where it holds scans that are motion-corrected. [`Source::lidar_scan`] corrects them by the recording's
    /// own motion; whoever knows a better one corrects these.
    fn rolling_scan(&self, lidar: usize, scan: usize) -> Result<Option<LidarScan>, SourceError> {
        self.inner().map_or(Ok(None), |inner| inner.rolling_scan(lidar, scan))
    }

    /// A radar's scan as the recording holds it, whatever settings make of its values: by that people's corrections
    /// know it again.
    fn delivered(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        match self.inner() {
            Some(inner) => inner.delivered(radar, scan),
            None => self.radar_scan(radar, scan),
        }
    }

    /// Whether settings change values of a radar's detections, so that [`Source::radar_scan`] may tell others than
    /// [`delivered`](Self::delivered).
    fn alters_values(&self, radar: usize) -> bool {
        self.inner().is_some_and(|inner| inner.alters_values(radar))
    }

    /// Where the vehicle's motion comes from.
    fn motion_source(&self) -> MotionSource {
        self.inner().map_or(MotionSource::Recorded, |inner| inner.motion_source())
    }

    /// The truth of a radar's scan where it is known without a file.
    fn truth(&self, radar: usize, scan: usize) -> Result<Option<TruthLabels>, SourceError> {
        self.inner().map_or(Ok(None), |inner| inner.truth(radar, scan))
    }

    /// The causes of artifacts that this truth tells apart, by their numbers.
    fn causes(&self) -> &'static [Cause] {
        self.inner().map_or(&[], |inner| inner.causes())
    }
}

/// What is true of each detection of a scan, in its order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct TruthLabels {
    /// As they stand in a `.label` file.
    pub labels: Vec<Label>,
    /// Why each is an artifact: [`ralf::label::Cause`] as a number, 0 of what is plausible. No file that labelling
    /// reads; empty where [no causes](SequenceReader::causes) are told apart.
    pub causes: Vec<u8>,
}

/// Refuses to write a recording again of which a part can't be read: what is written would not tell what it lacks.
pub(crate) fn check_nothing_lost(reader: &dyn SequenceReader) -> Result<(), DataError> {
    let Some(reason) = reader.lost().first().cloned() else { return Ok(()) };
    Err(DataError::Unsuitable {
        file: reader.sequence().name.clone().into(),
        place: "content".into(),
        reason,
    })
}

/// Refuses to write LiDAR scans that are not motion-corrected, for nothing that is written says so.
pub(crate) fn check_motion_corrected(reader: &dyn SequenceReader) -> Result<(), DataError> {
    let Sequence { name, rig, times, motion, .. } = reader.sequence();
    if motion.is_known() {
        return Ok(());
    }
    for (lidar, _) in times.lidars.iter().enumerate().filter(|(_, times)| !times.is_empty()) {
        let sensor = &rig.lidars[lidar].name;
        let rolling = reader.rolling_scan(lidar, 0).map_err(|error| DataError::Measurement {
            sensor: sensor.clone(),
            index: 0,
            error,
        })?;
        if rolling.is_some() {
            let reason = format!(
                "the points of {sensor} lie where each was measured, and the vehicle's motion, which would bring them \
                 to one time, isn't known: a trajectory tells it (--trajectory, or motion.source=radar)"
            );
            return Err(DataError::Unsuitable { file: name.into(), place: "LiDAR".into(), reason });
        }
    }
    Ok(())
}

/// What `sensors` holds of a measurement: one list per sensor of this kind, one entry per measurement.
pub(crate) fn measurement<'a, T>(
    kind: &'static str,
    sensors: &'a [Vec<T>],
    sensor: usize,
    index: usize,
) -> Result<&'a T, DataError> {
    let found = sensors.get(sensor).and_then(|measurements| measurements.get(index));
    found.ok_or(DataError::NoMeasurement { kind, sensor, index })
}

/// What a reader answers whose recordings have no sensors of a kind.
pub(crate) fn no_measurement<T>(kind: &'static str, sensor: usize, index: usize) -> Result<T, SourceError> {
    Err(DataError::NoMeasurement { kind, sensor, index }.into())
}

/// A recording, opened: cheap, for measurements are read on demand.
pub struct Recording {
    /// The folder or file that was opened.
    pub path: PathBuf,
    /// The format's name, as `--format` takes it.
    pub format: &'static str,
    /// In the order of their names.
    pub sequences: Vec<Box<dyn SequenceReader>>,
    /// Those of which nothing can be read, in the order of their names.
    pub incomplete: Vec<Incomplete>,
    /// Whether somebody named its sequences: what can't be read of one of them is then an error.
    pub is_selected: bool,
}

impl Recording {
    /// A recording all of whose sequences can be read.
    pub fn new(path: &Path, format: &'static str, sequences: Vec<Box<dyn SequenceReader>>) -> Self {
        Self { path: path.to_owned(), format, sequences, incomplete: Vec::new(), is_selected: false }
    }

    /// The recording, or why one of its sequences was refused: for whoever names nothing that is left out.
    ///
    /// # Errors
    /// The first such reason. Parts that are missing are none.
    pub(crate) fn whole(self) -> Result<Self, DataError> {
        Ok(Self { incomplete: whole(self.incomplete)?, ..self })
    }

    /// The sequences that are left out, for they were refused or lack a part, and why: a sentence each, after its name.
    /// Those without any file of their radars were never there: large data sets are published part by part.
    pub fn left_out(&self) -> Vec<String> {
        let damaged = self.incomplete.iter().filter(|one| !matches!(one.lost, Lost::Radars));
        damaged.map(|Incomplete { name, lost }| format!("{name}: {lost}")).collect()
    }

    /// What is said of the sequences of which no file of a radar was copied, if there are any.
    pub fn told_not_copied(&self) -> Option<String> {
        let not_copied = self.incomplete.iter().filter(|one| matches!(one.lost, Lost::Radars));
        let names: Vec<&str> = not_copied.map(|one| one.name.as_str()).collect();
        let (first, all) = (names.first()?, self.sequences.len() + self.incomplete.len());
        let more = if names.len() > 1 { format!(" and {} more", names.len() - 1) } else { String::new() };
        Some(format!("{} of {all} sequences left out, for {}: {first}{more}", names.len(), Lost::Radars))
    }

    /// The same without the sequences whose radars' files are all missing, unless sequences were asked for: large
    /// data sets are published part by part, with tables of all.
    pub fn copied(self) -> Self {
        let is_missing = |reader: &dyn SequenceReader| {
            reader.sequence().times.radars.iter().all(Vec::is_empty) && !reader.warnings().is_empty()
        };
        if self.is_selected || self.sequences.iter().all(|reader| is_missing(reader.as_ref())) {
            return self;
        }
        let (missing, sequences): (Vec<_>, Vec<_>) =
            self.sequences.into_iter().partition(|reader| is_missing(reader.as_ref()));
        let lost = |reader: Box<dyn SequenceReader>| Incomplete {
            name: reader.sequence().name.clone(),
            lost: Lost::Radars,
        };
        let incomplete = self.incomplete.into_iter().chain(missing.into_iter().map(lost)).collect();
        Self { sequences, incomplete, ..self }
    }

    /// Keeps the sequences of these names, in the recording's order; all of them where no name is given.
    pub fn select(mut self, names: &[String]) -> Result<Self, DataError> {
        let holds = |name: &String| self.sequences.iter().any(|sequence| sequence.sequence().name == *name);
        if let Some(unknown) = names.iter().find(|name| !holds(name)) {
            if let Some(found) = self.incomplete.iter().position(|lost| lost.name == *unknown) {
                return Err(match self.incomplete.swap_remove(found).lost {
                    Lost::Refused(error) => error,
                    Lost::Part(missing) => self.lacking(unknown, &format!("`{missing}`")),
                    Lost::Radars => self.lacking(unknown, "files of its radars"),
                });
            }
            let known: Vec<&str> = self.sequences.iter().map(|s| s.sequence().name.as_str()).collect();
            return Err(DataError::UnknownSequence { name: unknown.clone(), known: known.join(", ") });
        }
        self.sequences.retain(|sequence| names.is_empty() || names.contains(&sequence.sequence().name));
        if !names.is_empty() {
            // Nobody asked for the others.
            self.incomplete.clear();
            self.is_selected = true;
        }
        Ok(self)
    }

    fn lacking(&self, sequence: &str, expected: &str) -> DataError {
        DataError::content(&self.path, format!("sequence {sequence}"), expected, "none")
    }
}

impl std::fmt::Debug for Recording {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let names: Vec<&str> = self.sequences.iter().map(|s| s.sequence().name.as_str()).collect();
        f.debug_struct("Recording").field("format", &self.format).field("sequences", &names).finish()
    }
}
