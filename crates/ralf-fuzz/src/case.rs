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
        let folder = scratch.join(VERBS[verb].place);
        if !folder.exists() {
            copy(&places.join(VERBS[verb].place), &folder);
        }
        let all = files(&folder.join(VERBS[verb].damaged));
        let mut pick = || all[random.random_range(0..all.len())].clone();
        let (file, other) = (pick(), pick());
        Self { random, verb, folder, file, other }
    }

    /// Verb and file, for people.
    pub fn name(&self) -> String {
        let file = self.file.strip_prefix(&self.folder).unwrap_or(&self.file);
        format!("{} {}", VERBS[self.verb].name, file.display())
    }

    /// Damages the file, does with its place what is to be done, and makes it whole again. False: it panicked.
    pub fn run(mut self) -> bool {
        let whole = fs::read(&self.file).unwrap();
        let mut bytes = whole.clone();
        damage(&mut bytes, &fs::read(&self.other).unwrap(), &mut self.random);
        fs::write(&self.file, bytes).unwrap();
        let before = files(&self.folder);
        let run = VERBS[self.verb].run;
        let ended = catch_unwind(AssertUnwindSafe(|| run(&self.folder, &mut self.random)));
        self.clean(&before);
        fs::write(&self.file, whole).unwrap();
        ended.is_ok()
    }

    /// Removes what the verb wrote. A verb that changed other files of its place leaves it to be copied anew.
    fn clean(&self, before: &[PathBuf]) {
        let _ = fs::remove_dir_all(self.folder.join("new"));
        if VERBS[self.verb].writes || files(&self.folder) != before {
            let _ = fs::remove_dir_all(&self.folder);
            fs::create_dir_all(self.file.parent().unwrap()).unwrap();
        }
    }
}
