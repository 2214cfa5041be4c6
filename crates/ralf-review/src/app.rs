//! What all requests share.

use crate::cache::Cache;
use crate::causes::CauseNames;
use crate::contents::Contents;
use crate::error::ReviewError;
use crate::http::{Answer, ApiError, EditId, Person, Served};
use crate::labelled::{SequenceLabels, Stamp};
use crate::options::Options;
use crate::place::folder_name;
use crate::shared_store::{SharedStore, identity};
use crate::team::Team;
use ralf_corrections::{History, Outcome, Reader, ScanContent, ScanKey, ScanVersion, Store, StoreError, Who};
use ralf_data::run::read_record;
use ralf_data::{Recording, ScanIndex, SequenceReader};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tokio::sync::{Semaphore, watch};

/// Sequences whose labels are kept open: as many as people work on, within these, for each may take some 200 MB.
const SEQUENCES_KEPT: [usize; 2] = [4, 12];
/// LiDAR scans that are kept as they are sent: some 2 MB each.
const CLOUDS_KEPT: usize = 24;

/// Maps that are kept, some 4 MB each.
const MAPS_KEPT: usize = 8;

/// The recording, its labels and its corrections.
pub(crate) struct App {
    pub(crate) recording: Recording,
    pub(crate) out: PathBuf,
    /// What people are called who say no name of their own.
    pub(crate) author: String,
    pub(crate) causes: CauseNames,
    pub(crate) contents: Contents,
    pub(crate) team: Team,
    pub(crate) store: SharedStore,
    /// Who writes has it; who waits for it keeps no thread that others could read with.
    writing: Semaphore,
    labels: Cache<usize, SequenceLabels>,
    /// Tables by sequence, LiDAR and scan, and the labels whose ground is in them.
    pub(crate) clouds: Cache<(usize, usize, usize), (Stamp, Vec<u8>)>,
    /// The same of what several scans have seen.
    pub(crate) maps: Cache<(usize, usize, usize), (Stamp, Vec<u8>)>,
    /// Tells those who listen for news that something was written.
    pub(crate) news: watch::Sender<()>,
    /// Tells those who listen that the server ends.
    pub(crate) closing: watch::Sender<bool>,
}

/// A radar's scan that exists.
pub(crate) struct ScanPlace<'a> {
    pub(crate) sequence: usize,
    pub(crate) reader: &'a dyn SequenceReader,
    pub(crate) scan: ScanIndex,
    pub(crate) t_ns: i64,
    pub(crate) key: ScanKey,
}

impl App {
    /// Opens all that is needed. Labels must be there; the store is made if it isn't.
    pub(crate) fn open(recording: Recording, out: &Path, options: &Options) -> Result<Self, ReviewError> {
        // Without labels there is nothing to review, and no store is made.
        let labelled = read_record(out)?.sequences;
        let team = Team::open(out, &labelled, options.second.clone())?;
        let [least, most] = SEQUENCES_KEPT;
        let sequences = team.people().len().clamp(least, most);
        Ok(Self {
            store: SharedStore::open(&team.store(out)?)?,
            author: team.second.as_ref().unwrap_or(&options.author).clone(),
            team,
            causes: CauseNames::of(&recording)?,
            contents: Contents::default(),
            recording,
            out: out.to_owned(),
            writing: Semaphore::new(1),
            labels: Cache::new(sequences),
            clouds: Cache::new(CLOUDS_KEPT),
            maps: Cache::new(MAPS_KEPT),
            news: watch::Sender::new(()),
            closing: watch::Sender::new(false),
        })
    }

    /// Which corrections these are.
    pub(crate) fn served(&self) -> Result<Served, StoreError> {
        let out = folder_name(&self.out);
        let name = match &self.team.second {
            Some(second) => format!("`{out}`, second labels of {second}"),
            None => format!("`{out}`"),
        };
        Ok(Served { identity: self.store.read(identity)?, name })
    }

    /// Does work that reads files on a thread of its own.
    pub(crate) async fn blocking(
        self: Arc<Self>,
        work: impl FnOnce(&Self) -> Answer + Send + 'static,
    ) -> Answer {
        let broken =
            |_| Err(ApiError::Broken("this answer could not be made: the program is at fault".into()));
        tokio::task::spawn_blocking(move || work(&self)).await.unwrap_or_else(broken)
    }

    /// Does work that writes to the store, one after the other.
    pub(crate) async fn in_turn(
        self: Arc<Self>,
        work: impl FnOnce(&Self) -> Answer + Send + 'static,
    ) -> Answer {
        // It is never closed; without a turn the store's own lock would do.
        let _turn = self.writing.acquire().await;
        self.clone().blocking(work).await
    }

    /// Who makes an edit. Second labels are those of one person, whatever the browser calls whoever gives them.
    pub(crate) fn who(&self, person: Person, edit: Option<EditId>) -> Who {
        let who = person.who(&self.author, edit);
        match &self.team.second {
            Some(name) => Who { name: name.clone(), is_named: true, ..who },
            None => who,
        }
    }

    /// Asks the corrections.
    pub(crate) fn said<T>(&self, ask: impl FnOnce(&Reader) -> Result<T, StoreError>) -> Result<T, ApiError> {
        Ok(self.store.read(ask)?)
    }

    /// Writes corrections of a sequence, and has other windows hear of it. `edit` is told of which scans something was
    /// said while they held something else: it leaves these alone, and so does the history that is answered.
    pub(crate) fn edit(
        &self,
        sequence: &str,
        who: &Who,
        edit: impl FnOnce(&mut Store, &[ScanVersion]) -> Result<Outcome, StoreError>,
    ) -> Result<Outcome, ApiError> {
        let reason = || ApiError::Forbidden(self.store.read_only().unwrap_or_default().to_owned());
        let gone = self.gone(sequence)?;
        let mut outcome = self.store.write(|store| edit(store, &gone)).ok_or_else(reason)??;
        if let Outcome::Done(done) = &mut outcome {
            self.news.send_replace(());
            if !gone.is_empty() {
                done.history = self.said(|store| store.history_without(sequence, &who.author, &gone))?;
            }
        }
        Ok(outcome)
    }

    /// What a person can undo and redo in a sequence.
    pub(crate) fn history(&self, sequence: &str, who: &Who) -> Result<History, ApiError> {
        let gone = self.gone(sequence)?;
        self.said(|store| store.history_without(sequence, &who.author, &gone))
    }

    /// The scans of a sequence of which something was said while they held something else.
    fn gone(&self, sequence: &str) -> Result<Vec<ScanVersion>, ApiError> {
        let mut gone = self.said(|store| store.versions(sequence))?;
        let holds = |version: &ScanVersion| self.holds(&version.key, version.content);
        let held = gone.iter().map(holds).collect::<Result<Vec<_>, _>>()?;
        let mut held = held.into_iter();
        gone.retain(|_| held.next() == Some(false));
        Ok(gone)
    }

    /// What a scan holds now.
    pub(crate) fn version(&self, place: &ScanPlace) -> Result<ScanVersion, ApiError> {
        let content = self.content(place)?;
        Ok(ScanVersion { key: place.key.clone(), content })
    }

    /// What a scan holds as it was read last, for answers about many scans.
    pub(crate) fn known_version(&self, place: ScanPlace) -> Result<ScanVersion, ApiError> {
        let content = self.known_content(&place)?.map_or_else(|| self.content(&place), Ok)?;
        Ok(ScanVersion { key: place.key, content })
    }

    /// What a scan holds now, as the store knows it.
    pub(crate) fn content(&self, place: &ScanPlace) -> Result<ScanContent, ApiError> {
        let held = self.contents.read(place.reader, (place.sequence, place.scan))?;
        held.among(|| self.said(|store| store.contents(&place.key)))
    }

    /// The same as it was read last; `None` of a scan that can't be read.
    pub(crate) fn known_content(&self, place: &ScanPlace) -> Result<Option<ScanContent>, ApiError> {
        let held = self.contents.known(place.reader, (place.sequence, place.scan));
        held.map(|held| held.among(|| self.said(|store| store.contents(&place.key)))).transpose()
    }

    /// Whether something was said of what a scan holds, and not of something else that it held, or of a scan that the
    /// recording doesn't have.
    pub(crate) fn holds(&self, key: &ScanKey, said: ScanContent) -> Result<bool, ApiError> {
        let ScanKey { sequence, radar, scan } = key;
        let Ok(place) = self.scan(sequence, radar, *scan as usize) else { return Ok(false) };
        let content = self.known_content(&place)?;
        Ok(content.is_some_and(|content| content.find_in(&[said]).is_some()))
    }

    /// A sequence by its name.
    pub(crate) fn sequence(&self, name: &str) -> Result<(usize, &dyn SequenceReader), ApiError> {
        let all = self.recording.sequences.iter().enumerate();
        let found = all.map(|(i, reader)| (i, reader.as_ref())).find(|(_, r)| r.sequence().name == name);
        found.ok_or_else(|| ApiError::unknown("sequence", format!("`{name}`"), "one of the recording's"))
    }

    /// A scan by names and number.
    pub(crate) fn scan(&self, sequence: &str, radar: &str, scan: usize) -> Result<ScanPlace<'_>, ApiError> {
        let (index, reader) = self.sequence(sequence)?;
        let names = reader.sequence().rig.radars.iter().map(|radar| radar.name.as_str());
        let times = &reader.sequence().times.radars;
        let (place, t_ns) = measurement("radar", names, times, radar, scan)?;
        let number = u32::try_from(scan).map_err(|error| ApiError::Malformed(error.to_string()))?;
        let key = ScanKey { sequence: sequence.to_owned(), radar: radar.to_owned(), scan: number };
        Ok(ScanPlace { sequence: index, reader, scan: ScanIndex { radar: place, scan }, t_ns, key })
    }

    /// A sequence's labels, as they lie there now.
    pub(crate) fn labels(&self, sequence: usize) -> Result<Arc<SequenceLabels>, ApiError> {
        let reader = self.recording.sequences[sequence].as_ref();
        let stamp = SequenceLabels::stamp(&self.out, &reader.sequence().name)?;
        self.labels.get(
            sequence,
            |labels| labels.is_of(&stamp),
            || SequenceLabels::load(&self.out, reader, stamp.clone()),
        )
    }
}

/// A sensor's place in the rig, and the time of its measurement.
pub(crate) fn measurement<'a>(
    kind: &str,
    mut names: impl Iterator<Item = &'a str>,
    times: &[Vec<i64>],
    name: &str,
    number: usize,
) -> Result<(usize, i64), ApiError> {
    let found = names.position(|known| known == name);
    let sensor =
        found.ok_or_else(|| ApiError::unknown(kind, format!("`{name}`"), "one of the sequence's"))?;
    let times = times.get(sensor).map_or(&[][..], Vec::as_slice);
    let below = format!("a number below {}", times.len());
    let t_ns = times.get(number).ok_or_else(|| ApiError::unknown(name, number, &below))?;
    Ok((sensor, *t_ns))
}
