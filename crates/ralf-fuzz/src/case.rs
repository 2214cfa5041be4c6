//! One case: a place, a damaged file of it, and what is done with it.

use crate::damage::damage;
use crate::tree::{copy, files};
use crate::verbs::VERBS;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// What a number stands for.
pub struct Case {
    random: Pcg64Mcg,
    verb: usize,
    /// The place's copy, which is damaged.
    folder: PathBuf,
    file: PathBuf,
    /// Where another content may come from.
    other: PathBuf,
}

impl Case {
    /// The case of this number; `places` is what [`crate::make_places`] made, and `scratch` holds copies.
    pub fn new(number: u64, places: &Path, scratch: &Path) -> Self {
        let mut random = Pcg64Mcg::seed_from_u64(number);
        let verb = random.random_range(0..VERBS.len());
        let folder = place(verb, places, scratch);
        let all = files(&folder.join(VERBS[verb].damaged));
        let mut pick = || all[random.random_range(0..all.len())].clone();
        let (file, other) = (pick(), pick());
        Self { random, verb, folder, file, other }
    }

    /// A case whose verb and file are these, counted round, and whose content is given to [`Self::run_with`].
    pub fn chosen(verb: u8, file: u8, places: &Path, scratch: &Path) -> Self {
        let verb = usize::from(verb) % VERBS.len();
        let folder = place(verb, places, scratch);
        let all = files(&folder.join(VERBS[verb].damaged));
        let file = all[usize::from(file) % all.len()].clone();
        Self { random: Pcg64Mcg::seed_from_u64(0), verb, folder, other: file.clone(), file }
    }

    /// Verb and file, for people.
    pub fn name(&self) -> String {
        let file = self.file.strip_prefix(&self.folder).unwrap_or(&self.file);
        format!("{} {}", VERBS[self.verb].name, file.display())
    }

    /// Damages the file, does with its place what is to be done, and makes it whole again. False: it panicked.
    pub fn run(mut self) -> bool {
        let mut bytes = fs::read(&self.file).unwrap();
        damage(&mut bytes, &fs::read(&self.other).unwrap(), &mut self.random);
        self.run_with(&bytes)
    }

    /// The same with this content of the file.
    pub fn run_with(mut self, bytes: &[u8]) -> bool {
        let whole = fs::read(&self.file).unwrap();
        fs::write(&self.file, bytes).unwrap();
        let before = files(&self.folder);
        let run = VERBS[self.verb].run;
        let ended = catch_unwind(AssertUnwindSafe(|| run(&self.folder, &mut self.random)));
        if self.clean(&before) {
            fs::write(&self.file, whole).unwrap();
        }
        ended.is_ok()
    }

    /// The content of the file as long as it is whole.
    pub fn whole(&self) -> Vec<u8> {
        fs::read(&self.file).unwrap()
    }

    /// Removes what the verb wrote. False: it changed other files of its place, too, which is copied anew for the next.
    fn clean(&self, before: &[PathBuf]) -> bool {
        let _ = fs::remove_dir_all(self.folder.join("new"));
        let is_kept = !VERBS[self.verb].writes && files(&self.folder) == before;
        if !is_kept {
            let _ = fs::remove_dir_all(&self.folder);
        }
        is_kept
    }
}

/// The copy of a verb's place.
fn place(verb: usize, places: &Path, scratch: &Path) -> PathBuf {
    let folder = scratch.join(VERBS[verb].place);
    if !folder.exists() {
        copy(&places.join(VERBS[verb].place), &folder);
    }
    folder
}

/// Every verb with every file of its place, as [`Case::chosen`] counts them.
pub fn all_cases(places: &Path) -> Vec<(u8, u8)> {
    let mut cases = Vec::new();
    for (verb, about) in VERBS.iter().enumerate() {
        let count = files(&places.join(about.place).join(about.damaged)).len();
        cases
            .extend((0..count).filter_map(|file| Some((u8::try_from(verb).ok()?, u8::try_from(file).ok()?))));
    }
    cases
}
