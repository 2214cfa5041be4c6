//! Labelled scans in files that only grow: what a run that is killed leaves for the next one.
//!
//! A file per scan costs the system more than labelling does. `SEQUENCE/0.scans`, `1.scans` and so on belong to a
//! writer each, for several may work on a sequence, so that none waits while another writes; no run continues those of
//! another. Such a file begins with [`MAGIC`], the length of a JSON list (uint32), and that list: the radars' names.
//! Then scan follows scan: a [`Head`] and a body. What doesn't fit its checksum is as if it were not there, and a file
//! ends where a head doesn't.

use crate::disk::files;
use crate::error::DataError;
use crate::frames::ScanIndex;
use crate::result::{Component, OutFolder};
use std::collections::HashMap;
use std::fs::File;
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

const MAGIC: &[u8; 8] = b"RALFlog2";
const ENDING: &str = ".scans";
/// Of the list of names, bytes: no rig has so many radars.
const LONGEST_NAMES: u32 = 1 << 24;

/// All scans of a sequence that were kept, by this run and by others.
#[derive(Debug)]
pub(super) struct ScanLog {
    folder: OutFolder,
    /// The first bytes of a file.
    begin: Vec<u8>,
    kept: Mutex<Kept>,
}

/// An open file, and its name.
type Named = (Arc<Path>, Arc<File>);

#[derive(Debug, Default)]
struct Kept {
    /// To be read.
    files: Vec<Named>,
    /// Those of them that this run writes, as far as nobody writes to them now.
    own: Vec<Own>,
    places: HashMap<ScanIndex, Place>,
}

/// A file that this run writes.
#[derive(Debug)]
struct Own {
    /// Its number among all.
    number: usize,
    name: Arc<Path>,
    file: File,
    /// Where it ends.
    end: u64,
}

/// Where a scan's body lies.
#[derive(Debug, Clone, Copy)]
struct Place {
    file: usize,
    offset: u64,
    rows: u32,
    /// Of the body.
    bytes: u64,
    checksum: u32,
}

/// What stands before each body, as little-endian uint64 in this order, and then the CRC-32 of these.
#[derive(Debug, Clone, Copy)]
struct Head {
    /// The radar's place in the list of names.
    radar: u64,
    scan: u64,
    /// Its detections.
    rows: u64,
    /// Of the body.
    bytes: u64,
    /// CRC-32 of the body.
    checksum: u64,
}

const HEAD: usize = 6 * size_of::<u64>();

impl ScanLog {
    /// What was kept in a folder, of radars with these names.
    pub(super) fn open(folder: OutFolder, radars: &[Component]) -> Result<Self, DataError> {
        let names: Vec<&str> = radars.iter().map(Component::as_str).collect();
        let begin = begin(&names).map_err(DataError::io(folder.path()))?;
        let mut kept = Kept::default();
        for file in logs(folder.path())? {
            let mut open = files::open(&file)?;
            // Of a file that is not whole from its very begin, or has other radars, nothing is known.
            if names_of(&mut open).is_some_and(|found| found == names) {
                kept.add(file, open);
            }
        }
        Ok(Self { folder, begin, kept: Mutex::new(kept) })
    }

    /// Where they lie.
    pub(super) fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Keeps a scan of so many detections.
    pub(super) fn append(&self, scan: ScanIndex, rows: usize, body: &[u8]) -> Result<(), DataError> {
        let head = Head {
            radar: scan.radar as u64,
            scan: scan.scan as u64,
            rows: rows as u64,
            bytes: body.len() as u64,
            checksum: u64::from(crc32fast::hash(body)),
        };
        let bytes = [&head.to_bytes()[..], body].concat();
        let own = self.kept().own.pop();
        let mut own = own.map_or_else(|| self.begin_own(), Ok)?;
        let end = own.end;
        if let Err(error) = own.file.write_all(&bytes) {
            // What follows half a scan could not be found again: nobody writes to this file any more.
            let _ = own.file.set_len(end);
            return Err(DataError::Io { file: own.name.to_path_buf(), error });
        }
        own.end += bytes.len() as u64;
        let mut kept = self.kept();
        kept.places.insert(scan, head.place(own.number, end + HEAD as u64));
        kept.own.push(own);
        Ok(())
    }

    /// Begins another file of this run, under the first number that is free.
    fn begin_own(&self) -> Result<Own, DataError> {
        let folder = self.folder.path();
        std::fs::create_dir_all(folder).map_err(DataError::io(folder))?;
        let mut number = self.kept().files.len();
        let (name, mut file): (Arc<Path>, _) = loop {
            let name = folder.join(format!("{number}{ENDING}"));
            // Another writer may take the same number at the same time: one of the two gets it.
            match File::options().write(true).create_new(true).open(&name) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => number += 1,
                Err(error) => return Err(DataError::Io { file: name, error }),
                Ok(created) => break (name.into(), created),
            }
        };
        file.write_all(&self.begin).map_err(DataError::io(&*name))?;
        let to_read = File::open(&*name).map_err(DataError::io(&*name))?;
        let mut kept = self.kept();
        kept.files.push((name.clone(), Arc::new(to_read)));
        Ok(Own { number: kept.files.len() - 1, name, file, end: self.begin.len() as u64 })
    }

    /// How many detections a scan that was kept has.
    pub(super) fn rows(&self, scan: ScanIndex) -> Option<usize> {
        Some(self.kept().places.get(&scan)?.rows as usize)
    }

    /// A scan's body and the file that it lies in; `None` where it wasn't kept, or is not as it was written.
    pub(super) fn read(&self, scan: ScanIndex) -> Option<(Arc<Path>, Vec<u8>)> {
        let (place, (name, file)) = self.find(scan)?;
        // No more than the file has: a length that is wrong takes no more memory.
        let mut body = vec![0; usize::try_from(place.bytes).ok()?];
        read_at(&file, &mut body, place.offset).ok()?;
        (crc32fast::hash(&body) == place.checksum).then_some((name, body))
    }

    fn find(&self, scan: ScanIndex) -> Option<(Place, Named)> {
        let kept = self.kept();
        let place = *kept.places.get(&scan)?;
        Some((place, kept.files.get(place.file)?.clone()))
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        // No writer leaves it in disorder, not even one that panics.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kept {
    /// Adds the scans of a file, which has been read up to its first head.
    fn add(&mut self, name: PathBuf, mut file: File) {
        let index = self.files.len();
        // A length that is wrong takes no more memory than there is in the file.
        let end = file.metadata().map_or(0, |data| data.len());
        for (head, offset) in heads(&mut file) {
            let is_there = offset.checked_add(head.bytes).is_some_and(|after| after <= end);
            if let Some(scan) = head.index().filter(|_| is_there) {
                self.places.insert(scan, head.place(index, offset));
            }
        }
        self.files.push((name.into(), Arc::new(file)));
    }
}

impl Head {
    fn to_bytes(self) -> [u8; HEAD] {
        let mut bytes = [0; HEAD];
        let fields = [self.radar, self.scan, self.rows, self.bytes, self.checksum];
        for (place, field) in bytes.as_chunks_mut::<8>().0.iter_mut().zip(fields) {
            *place = field.to_le_bytes();
        }
        let checksum = u64::from(crc32fast::hash(&bytes[..HEAD - 8]));
        bytes[HEAD - 8..].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    /// `None` where the checksum is another.
    fn from_bytes(bytes: &[u8; HEAD]) -> Option<Self> {
        let fields = bytes.as_chunks::<8>().0;
        let &[radar, scan, rows, length, body, own] = fields.first_chunk::<6>()?;
        let whole = u64::from_le_bytes(own) == u64::from(crc32fast::hash(&bytes[..HEAD - 8]));
        let [radar, scan, rows, bytes, checksum] = [radar, scan, rows, length, body].map(u64::from_le_bytes);
        whole.then_some(Self { radar, scan, rows, bytes, checksum })
    }

    /// With a body that lies here.
    fn place(&self, file: usize, offset: u64) -> Place {
        // Both have 32 bits in a head that fits its checksum.
        let (rows, checksum) = (self.rows as u32, self.checksum as u32);
        Place { file, offset, rows, bytes: self.bytes, checksum }
    }

    fn index(&self) -> Option<ScanIndex> {
        let (radar, scan) = (usize::try_from(self.radar).ok()?, usize::try_from(self.scan).ok()?);
        Some(ScanIndex { radar, scan })
    }
}

/// Fills the buffer from this offset on, whoever else reads the file.
#[cfg(unix)]
fn read_at(file: &File, buffer: &mut [u8], offset: u64) -> std::io::Result<()> {
    std::os::unix::fs::FileExt::read_exact_at(file, buffer, offset)
}

#[cfg(not(unix))]
fn read_at(mut file: &File, buffer: &mut [u8], offset: u64) -> std::io::Result<()> {
    // They share a place in the file: one at a time.
    static TURN: Mutex<()> = Mutex::new(());
    let _turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    file.seek(SeekFrom::Start(offset))?;
    file.read_exact(buffer)
}

/// Each radar and scan that a folder's files tell of, for those who know no more than the folder.
pub(super) fn scans_in(folder: &Path) -> Result<Vec<(Component, usize)>, DataError> {
    let mut scans = Vec::new();
    for file in logs(folder)? {
        let mut open = files::open(&file)?;
        let names = names_of(&mut open).unwrap_or_default();
        for (head, _) in heads(&mut open) {
            let Some(ScanIndex { radar, scan }) = head.index() else { continue };
            // A file that somebody has edited leads nowhere else.
            let radar = names.get(radar).and_then(|name| Component::new(name).ok());
            scans.extend(radar.map(|radar| (radar, scan)));
        }
    }
    Ok(scans)
}

/// The files that hold scans.
fn logs(folder: &Path) -> Result<Vec<PathBuf>, DataError> {
    let names = files::names(folder)?.into_iter().filter(|name| name.ends_with(ENDING));
    Ok(names.map(|name| folder.join(name)).collect())
}

fn begin(names: &[&str]) -> std::io::Result<Vec<u8>> {
    let names = serde_json::to_vec(names)?;
    let length = u32::try_from(names.len()).map_err(|_| ErrorKind::InvalidInput)?;
    Ok([&MAGIC[..], &length.to_le_bytes(), &names].concat())
}

/// The radars' names at a file's begin; `None` where it has another.
fn names_of(file: &mut File) -> Option<Vec<String>> {
    let mut begin = [0; 12];
    file.read_exact(&mut begin).ok()?;
    let length = u32::from_le_bytes(*begin.strip_prefix(MAGIC)?.first_chunk()?);
    let mut names = vec![0; (length <= LONGEST_NAMES).then_some(length as usize)?];
    file.read_exact(&mut names).ok()?;
    serde_json::from_slice(&names).ok()
}

/// The heads that follow, as far as they are whole, and where their bodies begin.
fn heads(file: &mut File) -> Vec<(Head, u64)> {
    let mut heads = Vec::new();
    let mut bytes = [0; HEAD];
    while file.read_exact(&mut bytes).is_ok()
        && let Some(head) = Head::from_bytes(&bytes)
        && let Ok(offset) = file.stream_position()
        && let Some(next) = offset.checked_add(head.bytes)
        && file.seek(SeekFrom::Start(next)).is_ok()
    {
        heads.push((head, offset));
    }
    heads
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn names() -> [Component; 2] {
        ["front", "rear"].map(|name| Component::new(name).unwrap())
    }

    fn at(radar: usize, scan: usize) -> ScanIndex {
        ScanIndex { radar, scan }
    }

    /// A folder in which two runs have kept two scans each, one of them the same.
    fn two_runs() -> (tempfile::TempDir, OutFolder) {
        let place = tempfile::tempdir().unwrap();
        let folder = OutFolder::new(&place.path().join("00"));
        for scans in [[at(0, 7), at(1, 0)], [at(1, 0), at(1, 1)]] {
            let log = ScanLog::open(folder.clone(), &names()).unwrap();
            for scan in scans {
                log.append(scan, 5, &[scan.radar as u8; 100]).unwrap();
                assert_eq!(log.read(scan).unwrap().1, [scan.radar as u8; 100]);
                assert_eq!(log.rows(scan), Some(5));
            }
        }
        (place, folder)
    }

    fn kept(folder: &OutFolder) -> Vec<ScanIndex> {
        let log = ScanLog::open(folder.clone(), &names()).unwrap();
        [at(0, 7), at(1, 0), at(1, 1), at(0, 0)]
            .into_iter()
            .filter(|scan| log.read(*scan).is_some())
            .collect()
    }

    #[test]
    fn what_several_runs_kept_is_found() {
        let (_place, folder) = two_runs();
        assert_eq!(kept(&folder), [at(0, 7), at(1, 0), at(1, 1)]);
        let [front, rear] = names();
        let told = scans_in(folder.path()).unwrap();
        assert_eq!(told, [(front, 7), (rear.clone(), 0), (rear.clone(), 0), (rear, 1)]);
        let other = ScanLog::open(folder.clone(), &names()[..1]).unwrap();
        assert!(other.read(at(0, 7)).is_none(), "of another rig");
        let empty = ScanLog::open(folder.own("empty"), &names()).unwrap();
        assert!(empty.read(at(0, 7)).is_none());
    }

    #[test]
    fn writers_have_a_file_each_and_what_they_kept_is_found() {
        let place = tempfile::tempdir().unwrap();
        let folder = OutFolder::new(&place.path().join("00"));
        let log = ScanLog::open(folder.clone(), &names()).unwrap();
        std::thread::scope(|scope| {
            for radar in [0, 1] {
                let log = &log;
                scope.spawn(move || {
                    for scan in 0..100 {
                        log.append(at(radar, scan), scan, &vec![scan as u8; 5000 + radar]).unwrap();
                    }
                });
            }
        });
        assert!(logs(folder.path()).unwrap().len() <= 2);
        for log in [log, ScanLog::open(folder.clone(), &names()).unwrap()] {
            for (radar, scan) in (0..2).flat_map(|radar| (0..100).map(move |scan| (radar, scan))) {
                assert_eq!(log.read(at(radar, scan)).unwrap().1, vec![scan as u8; 5000 + radar]);
                assert_eq!(log.rows(at(radar, scan)), Some(scan));
            }
        }
    }

    #[test]
    fn cut_anywhere_it_keeps_what_is_whole() {
        let (_place, folder) = two_runs();
        let file = folder.path().join("1.scans");
        let bytes = fs::read(&file).unwrap();
        for length in 0..bytes.len() {
            fs::write(&file, &bytes[..length]).unwrap();
            let found = kept(&folder);
            assert_eq!(found[0], at(0, 7), "{length}");
            assert!(!found.contains(&at(1, 1)), "{length}");
        }
    }

    #[test]
    fn a_byte_that_changed_costs_no_more_than_what_it_is_in() {
        let (_place, folder) = two_runs();
        let file = folder.path().join("1.scans");
        let bytes = fs::read(&file).unwrap();
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 0x10;
            fs::write(&file, &damaged).unwrap();
            let log = ScanLog::open(folder.clone(), &names()).unwrap();
            assert_eq!(log.read(at(0, 7)).unwrap().1, [0; 100]);
            for scan in [at(1, 0), at(1, 1)] {
                assert!(log.read(scan).is_none_or(|(_, body)| body == [1; 100]), "{place}");
            }
            scans_in(folder.path()).unwrap();
        }
    }
}
