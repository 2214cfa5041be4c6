//! Who labels what: a file beside the labels, made once and then people's to change.

use super::person::{alike, person};
use crate::disk::files::{self, write_whole};
use crate::error::DataError;
use crate::result::{Component, RadarRecord, SequenceRecord};
use crate::tree::TEAM as FILE;
use crate::truth::ScanId;
use crate::words::listed;
use ralf_files::Kind;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// So many sequences are named that aren't labelled.
const SHOWN: usize = 5;
/// What stands above.
const HEAD: &str = "# Who labels what, as `ralf assign` dealt it; change it as you like.\n";

/// Who labels what, by name.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Assignment(pub BTreeMap<String, Share>);

/// What one person labels.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Share {
    /// Sequences whose labels are this person's, in `corrections.sqlite`.
    #[serde(default)]
    pub sequences: Vec<String>,
    /// Scans of others' sequences that are labelled a second time, without seeing the first labels.
    #[serde(default, serialize_with = "written", deserialize_with = "read")]
    pub twice: Vec<ScanId>,
}

impl Assignment {
    /// Deals labelled sequences to people: the largest first, each to whom has the fewest detections so far. Of each
    /// sequence `twice` of the scans (a share; at least one, if it isn't 0) are drawn at random and dealt to the others
    /// in the same way. The same sequences, people, share and seed give the same. One person has nothing twice.
    pub fn deal(sequences: &[SequenceRecord], people: &[Component], twice: f64, seed: u64) -> Self {
        let mut order: Vec<(u64, &SequenceRecord)> = sequences
            .iter()
            .map(|sequence| (scans(sequence).map(|(_, n)| u64::from(n)).sum(), sequence))
            .collect();
        order.sort_by_key(|(detections, sequence)| (Reverse(*detections), &sequence.name));
        let mut shares = vec![Share::default(); people.len()];
        let (mut first, mut second) = (vec![0; people.len()], vec![0; people.len()]);
        for (detections, sequence) in order {
            let Some(owner) = least(&first, None) else { break };
            first[owner] += detections;
            shares[owner].sequences.push(sequence.name.clone());
            for (scan, detections) in drawn(sequence, twice, seed) {
                let Some(other) = least(&second, Some(owner)) else { break };
                second[other] += u64::from(detections);
                shares[other].twice.push(scan);
            }
        }
        for share in &mut shares {
            share.sequences.sort();
            share.twice.sort();
        }
        Self(people.iter().map(|name| name.as_str().to_owned()).zip(shares).collect())
    }

    /// Reads what was dealt of these labelled sequences below an output folder; `None` where nothing was.
    ///
    /// # Errors
    /// A file that says something else, names somebody as the review can't, or names scans that a labelled sequence
    /// doesn't have: nobody would ever be asked for them. Sequences that aren't labelled are no error, for those of
    /// earlier runs come back, but [told](Self::told_waiting).
    pub fn open(out: &Path, labelled: &[SequenceRecord]) -> Result<Option<Self>, DataError> {
        let file = Self::file(out);
        if !files::exists(&file)? {
            return Ok(None);
        }
        let refused = |error: toml::de::Error| {
            let expected = "for each person `sequences` and `twice`";
            DataError::content(&file, "content", expected, error.message())
        };
        let dealt: Self = toml::from_str(&files::read_text(&file, Kind::Settings)?).map_err(refused)?;
        dealt.check_names(&file)?;
        dealt.check(&file, labelled)?;
        Ok(Some(dealt))
    }

    fn check_names(&self, file: &Path) -> Result<(), DataError> {
        let refused = |name: &str, expected, found: String| {
            Err(DataError::content(file, format!("[{name:?}]"), expected, found))
        };
        for name in self.0.keys() {
            match person(name) {
                Err(found) => return refused(name, "a name that a file can have", found.to_owned()),
                Ok(known) if known.as_str() != name => {
                    return refused(name, "a name without spaces around it", "some".to_owned());
                }
                Ok(_) => {}
            }
        }
        match alike(self.0.keys().map(String::as_str)) {
            Some([one, other]) => {
                refused(other, "names that differ by more than case", format!("`{one}` beside it"))
            }
            None => Ok(()),
        }
    }

    fn check(&self, file: &Path, labelled: &[SequenceRecord]) -> Result<(), DataError> {
        let of = |name: &str| labelled.iter().find(|sequence| sequence.name == name);
        // A scan that could not be labelled this time may be dealt all the same.
        let may_exist = |scan: &ScanId| {
            of(&scan.sequence).is_none_or(|sequence| {
                let holds = |radar: &RadarRecord| (scan.scan as usize) < radar.detections.len();
                sequence.radars.iter().any(|radar| radar.name == scan.radar && holds(radar))
            })
        };
        for (person, share) in &self.0 {
            if let Some(scan) = share.twice.iter().find(|scan| !may_exist(scan)) {
                let (place, found) = (format!("[{person}], twice"), format!("`{scan}`"));
                return Err(DataError::content(file, place, "scans of labelled sequences", found));
            }
        }
        Ok(())
    }

    /// The sentence about sequences that were dealt, all or scans of them, and aren't labelled at the moment; `None`
    /// where all are.
    pub fn told_waiting(&self, out: &Path, labelled: &[SequenceRecord]) -> Option<String> {
        let own = self.0.values().flat_map(|share| &share.sequences);
        let twice = self.0.values().flat_map(|share| share.twice.iter().map(|scan| &scan.sequence));
        let dealt: BTreeSet<&str> = own.chain(twice).map(String::as_str).collect();
        let is_labelled = |name: &str| labelled.iter().any(|sequence| sequence.name == name);
        let waiting: Vec<&str> = dealt.into_iter().filter(|name| !is_labelled(name)).collect();
        let (file, names) = (Self::file(out), listed(&waiting, SHOWN));
        let told =
            || format!("{}: not labelled at the moment, and nobody is asked for it: {names}", file.display());
        (!waiting.is_empty()).then(told)
    }

    /// Writes it below an output folder, and tells where.
    ///
    /// # Errors
    /// A file that is there already, for it may have been changed by people; one that can't be written.
    pub fn write(&self, out: &Path) -> Result<PathBuf, DataError> {
        let file = Self::file(out);
        if files::exists(&file)? {
            let expected = "none, for people may have begun: delete it to deal anew";
            return Err(DataError::content(&file, "file", expected, "one"));
        }
        let text = toml::to_string_pretty(self)
            .map_err(|error| DataError::content(&file, "content", "TOML", error.to_string()))?;
        write_whole(&file, format!("{HEAD}\n{text}").as_bytes())?;
        Ok(file)
    }

    pub(super) fn file(out: &Path) -> PathBuf {
        out.join(FILE)
    }

    /// Who labels a sequence.
    pub fn of_sequence(&self, name: &str) -> Option<&str> {
        let found = self.0.iter().find(|(_, share)| share.sequences.iter().any(|own| own == name));
        found.map(|(person, _)| person.as_str())
    }
}

/// Whose load is the least, the first of several; not that of one.
fn least(loads: &[u64], but: Option<usize>) -> Option<usize> {
    (0..loads.len()).filter(|at| Some(*at) != but).min_by_key(|at| loads[*at])
}

/// The labelled scans of a sequence, with their detections.
fn scans(sequence: &SequenceRecord) -> impl Iterator<Item = (ScanId, u32)> {
    let is_labelled = |radar: &str, scan: usize| {
        !sequence.not_labelled.iter().any(|left| left.radar == radar && left.scan == scan)
    };
    sequence.radars.iter().flat_map(move |radar| {
        let numbered = radar.detections.iter().zip(0u32..);
        let labelled = numbered.filter(move |(_, scan)| is_labelled(&radar.name, *scan as usize));
        labelled.map(|(detections, scan)| {
            let (sequence, radar) = (sequence.name.clone(), radar.name.clone());
            (ScanId { sequence, radar, scan }, *detections)
        })
    })
}

/// So large a share of the scans of a sequence, at random: those with the least hashes.
fn drawn(sequence: &SequenceRecord, share: f64, seed: u64) -> Vec<(ScanId, u32)> {
    let mut all: Vec<(ScanId, u32)> = scans(sequence).collect();
    let wanted = (share * all.len() as f64).round() as usize;
    let count = wanted.max(usize::from(share > 0.0)).min(all.len());
    all.sort_by_cached_key(|(scan, _)| *blake3::hash(format!("{seed} {scan}").as_bytes()).as_bytes());
    all.truncate(count);
    all
}

fn written<S: Serializer>(scans: &[ScanId], to: S) -> Result<S::Ok, S::Error> {
    to.collect_seq(scans.iter().map(ScanId::to_string))
}

fn read<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<ScanId>, D::Error> {
    let names = Vec::<String>::deserialize(from)?;
    let scan = |name: &String| {
        let refused = || serde::de::Error::custom(format!("expected SEQUENCE/RADAR/NUMBER, found `{name}`"));
        let mut parts = name.rsplitn(3, '/');
        let number = parts.next().and_then(|number| number.parse().ok()).ok_or_else(refused)?;
        let (Some(radar), Some(sequence)) = (parts.next(), parts.next()) else { return Err(refused()) };
        Ok(ScanId { sequence: sequence.to_owned(), radar: radar.to_owned(), scan: number })
    };
    names.iter().map(scan).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::NotLabelled;
    use proptest::prelude::*;

    fn sequence(name: &str, detections: &[u32]) -> SequenceRecord {
        let radar =
            RadarRecord { name: "front".into(), detections: detections.to_vec(), ..Default::default() };
        SequenceRecord {
            name: name.into(),
            fingerprint: String::new(),
            recording: String::new(),
            table: None,
            radars: vec![radar],
            cameras: Vec::new(),
            not_labelled: Vec::new(),
            lost: Vec::new(),
            unlike_sisters: Vec::new(),
            without_numbers: Vec::new(),
            motion: Default::default(),
            unreadable: Vec::new(),
            not_read: Vec::new(),
        }
    }

    fn people(names: &[&str]) -> Vec<Component> {
        names.iter().map(|name| Component::new(name).unwrap()).collect()
    }

    /// 60 go to ada, then 50 to bob, and 40 to bob who has fewer; 30 go to ada.
    #[test]
    fn sequences_are_dealt_by_their_size_and_scans_to_somebody_else() {
        let sizes = [("a", 30), ("b", 60), ("c", 50), ("d", 40)];
        let all: Vec<SequenceRecord> =
            sizes.iter().map(|(name, size)| sequence(name, &[*size / 10; 10])).collect();
        let dealt = Assignment::deal(&all, &people(&["ada", "bob"]), 0.2, 0);
        assert_eq!(dealt.0["ada"].sequences, ["a", "b"]);
        assert_eq!(dealt.0["bob"].sequences, ["c", "d"]);
        let of =
            |name: &str| dealt.0[name].twice.iter().map(|scan| scan.sequence.as_str()).collect::<Vec<_>>();
        assert_eq!((of("ada"), of("bob")), (vec!["c", "c", "d", "d"], vec!["a", "a", "b", "b"]));
        assert_eq!(dealt.of_sequence("c"), Some("bob"));
        assert_ne!(dealt, Assignment::deal(&all, &people(&["ada", "bob"]), 0.2, 1));
    }

    #[test]
    fn scans_without_labels_are_nobodys_and_one_alone_labels_nothing_twice() {
        let mut one = sequence("a", &[5, 5]);
        one.not_labelled.push(NotLabelled { radar: "front".into(), scan: 0, reason: String::new() });
        let dealt = Assignment::deal(std::slice::from_ref(&one), &people(&["ada", "bob"]), 1.0, 0);
        assert_eq!(dealt.0["bob"].twice.iter().map(|scan| scan.scan).collect::<Vec<_>>(), [1]);
        assert!(Assignment::deal(&[one], &people(&["ada"]), 1.0, 0).0["ada"].twice.is_empty());
    }

    #[test]
    fn it_is_read_as_it_was_written_and_never_overwritten() {
        let out = tempfile::tempdir().unwrap();
        let labelled = [sequence("a b", &[1; 9])];
        let open = || Assignment::open(out.path(), &labelled);
        assert_eq!(open().unwrap(), None);
        let dealt = Assignment::deal(&labelled, &people(&["ada", "bob"]), 0.3, 0);
        let file = dealt.write(out.path()).unwrap();
        assert_eq!(open().unwrap(), Some(dealt.clone()));
        assert!(dealt.write(out.path()).unwrap_err().to_string().contains("delete it to deal anew"));
        for wrong in [
            "ada = 3",
            "[ada]\nsequenses = []",
            "[ada]\ntwice = [\"front/3\"]",
            "[ada]\ntwice = [\"a/b/c\"]",
            "[",
        ] {
            std::fs::write(&file, wrong).unwrap();
            let told = open().unwrap_err().to_string();
            assert!(told.contains("team.toml: content: expected for each person"), "{told}");
        }
    }

    /// `ralf label --sequence` with other settings leaves the others to be labelled again.
    #[test]
    fn sequences_that_are_not_labelled_at_the_moment_are_told() {
        let out = tempfile::tempdir().unwrap();
        let all = ["a", "b", "c"].map(|name| sequence(name, &[1; 9]));
        let dealt = Assignment::deal(&all, &people(&["ada", "bob"]), 0.3, 0);
        dealt.write(out.path()).unwrap();
        assert_eq!(dealt.told_waiting(out.path(), &all), None);
        assert_eq!(Assignment::open(out.path(), &all[..1]).unwrap().as_ref(), Some(&dealt));
        let told = dealt.told_waiting(out.path(), &all[..1]).unwrap();
        assert!(
            told.ends_with("team.toml: not labelled at the moment, and nobody is asked for it: b, c"),
            "{told}"
        );
    }

    #[test]
    fn a_name_that_is_no_person_or_scan_is_told() {
        let out = tempfile::tempdir().unwrap();
        let labelled = [sequence("a", &[1; 9])];
        for (text, expected) in [
            ("[\" bob\"]", "[\" bob\"]: expected a name without spaces around it, found some"),
            (
                "[bob]\n[Bob]",
                "[\"bob\"]: expected names that differ by more than case, found `Bob` beside it",
            ),
            (
                "[ada]\ntwice = [\"a/front/9\"]",
                "[ada], twice: expected scans of labelled sequences, found `a/front/",
            ),
            (
                "[ada]\ntwice = [\"a/rear/1\"]",
                "[ada], twice: expected scans of labelled sequences, found `a/rear/",
            ),
        ] {
            std::fs::write(out.path().join(FILE), text).unwrap();
            let told = Assignment::open(out.path(), &labelled).unwrap_err().to_string();
            assert!(told.contains(expected), "{told}");
        }
    }

    proptest! {
        /// Everybody's loads differ by no more than the largest sequence, every sequence has one owner, and nobody
        /// labels its own scans twice.
        #[test]
        fn work_is_spread(sizes in proptest::collection::vec(1..50u32, 1..12), count in 1..5usize, twice in 0.0..1.0) {
            let all: Vec<SequenceRecord> =
                sizes.iter().enumerate().map(|(at, size)| sequence(&at.to_string(), &[*size; 4])).collect();
            let names = people(&["ada", "bob", "cem", "dot"][..count.min(4)]);
            let dealt = Assignment::deal(&all, &names, twice, 7);
            let owned: Vec<&String> = dealt.0.values().flat_map(|share| &share.sequences).collect();
            prop_assert_eq!(owned.len(), all.len());
            prop_assert_eq!(owned.iter().collect::<BTreeSet<_>>().len(), all.len());
            let load = |share: &Share| -> u32 {
                share.sequences.iter().map(|name| 4 * sizes[name.parse::<usize>().unwrap()]).sum()
            };
            let loads: Vec<u32> = dealt.0.values().map(load).collect();
            let most = 4 * sizes.iter().max().unwrap();
            prop_assert!(loads.iter().max().unwrap() - loads.iter().min().unwrap() <= most);
            for share in dealt.0.values() {
                prop_assert!(share.twice.iter().all(|scan| !share.sequences.contains(&scan.sequence)));
            }
            let scans: BTreeSet<&ScanId> = dealt.0.values().flat_map(|share| &share.twice).collect();
            let expected = if names.len() < 2 || twice == 0.0 { 0 } else { ((4.0 * twice).round() as usize).max(1) };
            prop_assert_eq!(scans.len(), expected * all.len());
        }
    }
}
