//! What is each part of the method good for? Variants that lack one part, have one part alone, or have one of our
//! extensions besides; each is tuned on the same sequences as the paper's method, so that the comparison is fair, and
//! judged on others.

use super::{Found, MismatchTable, Search, TuneError, TunedSettings};
use ralf::config::{Config, DepthScaling, GroundModel, TrackingSources};
use ralf::metrics::{Confusion, Scores};

/// The extension by the detections' own vertical uncertainty: as many standard deviations as the defaults have.
const RADAR_SIGMAS: f64 = 2.0;

/// A variant of the method.
#[derive(Debug, Clone, PartialEq)]
pub struct Variant {
    /// For tables, and to tell variants apart.
    pub name: &'static str,
    /// Its settings, before tuning.
    pub config: Config,
}

/// What anybody would try first: a detection is plausible where the nearest LiDAR point lies within so many standard
/// deviations. It has one neighbour, whatever else is tuned.
const BASELINE: &str = "nearest LiDAR point";

type Change = fn(&mut Config);

/// What makes each variant differ from the paper's method; the first one is that.
const VARIANTS: [(&str, Change); 15] = [
    ("paper", |_| {}),
    ("without LiDAR", |config| config.lidar.enabled = false),
    ("without camera", |config| config.camera.enabled = false),
    ("without tracking", |config| config.tracking.enabled = false),
    ("LiDAR alone", |config| (config.camera.enabled, config.tracking.enabled) = (false, false)),
    ("camera alone", |config| (config.lidar.enabled, config.tracking.enabled) = (false, false)),
    ("tracking alone", |config| (config.lidar.enabled, config.camera.enabled) = (false, false)),
    (BASELINE, |config| (config.camera.enabled, config.tracking.enabled) = (false, false)),
    ("tracking.sources=all", |config| config.tracking.sources = TrackingSources::All),
    ("tracking.dynamic=true", |config| config.tracking.dynamic = true),
    ("ground.radar_sigmas=2", |config| config.ground.radar_sigmas = RADAR_SIGMAS),
    ("ground.model=polar", |config| config.ground.model = GroundModel::Polar),
    ("ground.model=flat", |config| config.ground.model = GroundModel::Flat),
    ("camera.scaling=ransac", |config| config.camera.scaling = DepthScaling::Ransac),
    ("camera.scaling=huber", |config| config.camera.scaling = DepthScaling::Huber),
];

/// Those that differ from others by what cameras see.
const OF_CAMERAS: [&str; 4] =
    ["without camera", "camera alone", "camera.scaling=ransac", "camera.scaling=huber"];

impl Variant {
    /// The paper's method and all that it is compared with, the paper's first. Of the settings everything stays that
    /// doesn't go beyond the paper.
    pub fn all(settings: &Config) -> Vec<Self> {
        let paper = as_in_the_paper(settings);
        let variant = |(name, change): (&'static str, Change)| {
            let mut config = paper.clone();
            change(&mut config);
            Self { name, config }
        };
        VARIANTS.into_iter().map(variant).collect()
    }

    /// Whether it says something of cameras alone: without any it is the paper's method again, or nothing.
    pub fn is_of_cameras(&self) -> bool {
        OF_CAMERAS.contains(&self.name)
    }

    /// The settings with which its mismatches are gathered. Equal ones need be gathered for once: branches that a
    /// variant lacks are left out of account afterwards, and what is tuned changes no mismatch.
    pub fn matching_config(&self) -> Config {
        let mut config = self.config.clone();
        all_branches(&mut config);
        config
    }

    /// Tunes the variant on some tables and judges it on others. `search` says what for, how long and with which seed;
    /// its base gives way to the variant's settings.
    pub fn judge(
        &self,
        search: &Search,
        train: &[&MismatchTable],
        test: &[&MismatchTable],
        progress: &mut dyn FnMut(usize, &Found),
    ) -> Result<JudgedVariant, TuneError> {
        let (mut config, mut held) = (self.config.clone(), search.held.clone());
        if self.name == BASELINE {
            config.lidar.neighbours = 1;
            held.push("lidar.neighbours".to_owned());
        }
        let found = Search { base: &config, held, ..search.clone() }.run(train, progress)?;
        let scores = |tables: &[&MismatchTable]| scores(tables, &found.settings);
        Ok(JudgedVariant { name: self.name, found, train: scores(train)?, test: scores(test)? })
    }
}

/// What a variant reaches.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedVariant {
    /// The variant's name.
    pub name: &'static str,
    /// The settings found for it.
    pub found: Found,
    /// What these reach where they were tuned.
    pub train: Scores,
    /// What they reach where they were not.
    pub test: Scores,
}

fn scores(tables: &[&MismatchTable], settings: &TunedSettings) -> Result<Scores, TuneError> {
    let scans = tables.iter().map(|table| table.confusions(settings));
    let scans: Vec<Vec<Confusion>> = scans.collect::<Result<_, _>>()?;
    Ok(Scores::from_scans(&scans.concat()))
}

/// A cap of mismatches that none reaches whose plausibility is anything but 0: the paper has none.
const NO_CAP: f64 = 1e6;

/// All three branches, and none of what goes beyond the paper (docs/method.md, section 12).
fn as_in_the_paper(settings: &Config) -> Config {
    let mut config = settings.clone();
    all_branches(&mut config);
    let Config { ground, lidar, camera, tracking, .. } = &mut config;
    (ground.model, ground.climbs, ground.radar_sigmas) = (GroundModel::Plane, 0, 0.0);
    (lidar.scans, lidar.dynamic, lidar.max_mismatch) = (1, false, NO_CAP);
    (camera.scaling, camera.max_mismatch) = (DepthScaling::Local, NO_CAP);
    (tracking.sources, tracking.dynamic, tracking.doppler) = (TrackingSources::Same, false, false);
    config
}

fn all_branches(config: &mut Config) {
    (config.lidar.enabled, config.camera.enabled, config.tracking.enabled) = (true, true, true);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Objective;
    use crate::search::planted;
    use std::path::Path;

    /// The paper's values of all settings with which the method goes beyond it.
    const PAPERS: [&str; 11] = [
        "ground.climbs=0",
        "ground.radar_sigmas=0",
        "lidar.max_mismatch=1e6",
        "camera.max_mismatch=1e6",
        "lidar.scans=1",
        "lidar.dynamic=false",
        "tracking.doppler=false",
        "tracking.dynamic=false",
        "tracking.sources=same",
        "ground.model=plane",
        "camera.scaling=local",
    ];
    /// All of them set to something else.
    const EXTENDED: [&str; 11] = [
        "ground.climbs=3",
        "ground.radar_sigmas=1",
        "lidar.max_mismatch=10",
        "camera.max_mismatch=10",
        "lidar.scans=3",
        "lidar.dynamic=true",
        "tracking.doppler=true",
        "tracking.dynamic=true",
        "tracking.sources=all",
        "ground.model=polar",
        "camera.scaling=huber",
    ];

    fn judged(config: &Config, name: &str, trials: usize) -> JudgedVariant {
        let (train, test) = (planted(1, 40), planted(2, 40));
        let search = Search { base: config, objective: Objective::F1, trials, seed: 1, held: vec![] };
        let variant = Variant::all(config).into_iter().find(|variant| variant.name == name).unwrap();
        variant.judge(&search, &[&train], &[&test], &mut |_, _| {}).unwrap()
    }

    #[test]
    fn each_variant_differs_from_the_papers_in_what_its_name_says() {
        let extended = EXTENDED.iter().chain(&["camera.enabled=false", "camera.stride=4"]);
        let settings = Config::from_toml("", &extended.copied().collect::<Vec<_>>());
        let variants = Variant::all(&settings.unwrap());
        let paper = &variants[0].config;
        let papers = [&PAPERS[..], &["camera.stride=4"]].concat();
        assert_eq!(*paper, Config::from_toml("", &papers).unwrap());
        for variant in &variants[1..] {
            assert_ne!(variant.config, *paper, "{}", variant.name);
            if variant.name.contains('=') {
                let assignments = [&papers[..], &[variant.name]].concat();
                assert_eq!(variant.config, Config::from_toml("", &assignments).unwrap());
            }
        }
        let mut names: Vec<_> = variants.iter().map(|variant| variant.name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), variants.len());
    }

    /// Section 12 of the method's page lists all settings whose defaults aren't the paper's, and the settings' own page
    /// names the paper's value of those that have an extension.
    #[test]
    fn all_that_is_documented_as_not_the_papers_is_reset() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let read = |name: &str| std::fs::read_to_string(root.join(name)).unwrap();
        let mut papers = Vec::new();
        let method = read("docs/method.md");
        let (_, section) = method.split_once("Where the defaults aren't the paper's:").unwrap();
        let (section, _) = section.split_once("\n\nThe figures").unwrap();
        for row in section.lines().filter(|row| row.starts_with("| `")) {
            let cells: Vec<&str> = row.split(" | ").collect();
            let keys = cells[0].split('`').skip(1).step_by(2);
            let value = if cells[1] == "none" { "1e6" } else { cells[1] };
            papers.extend(keys.filter(|_| value != "not told").map(|key| format!("{key}={value}")));
        }
        let (page, mut table) = (read("config/default.toml"), "");
        for line in page.lines() {
            table =
                line.strip_prefix('[').and_then(|name| name.split_once(']')).map_or(table, |(name, _)| name);
            let Some((key, told)) = line.split_once(" = ") else { continue };
            let number = told.split_once(" is the paper's").map(|(before, _)| before.rsplit(' ').next());
            let name = told.split_once("the paper's)").map(|(before, _)| before.rsplit('"').nth(1));
            let value = number.or(name).flatten();
            papers.extend(value.map(|value| format!("{table}.{key}={value}")));
        }
        papers.sort();
        papers.dedup();
        let mut told = PAPERS.map(str::to_owned).to_vec();
        told.sort();
        assert_eq!(papers, told);
        let default = Variant::all(&Config::default()).remove(0).config;
        assert_eq!(default, Config::from_toml("", &PAPERS).unwrap());
    }

    #[test]
    fn variants_that_lack_a_branch_share_the_papers_mismatches_and_no_extension_does() {
        let variants = Variant::all(&Config::default());
        let paper = variants[0].matching_config();
        for variant in &variants[1..] {
            assert_eq!(variant.matching_config() == paper, !variant.name.contains('='), "{}", variant.name);
        }
    }

    /// The planted truth needs all branches, and tracking most of all.
    #[test]
    fn a_branch_that_the_truth_follows_from_is_missed() {
        let config = Config::default();
        let f1 = |name| judged(&config, name, 150).test.pooled.rates.f1_plausible.unwrap();
        let paper = f1("paper");
        for name in ["without LiDAR", "without camera", "without tracking"] {
            assert!(f1(name) < paper - 0.02, "{name}");
        }
        assert!(f1("tracking alone") > f1("LiDAR alone"));
    }

    #[test]
    fn a_variant_without_a_branch_is_a_search_without_its_mismatches() {
        let config = Config::default();
        let without = judged(&config, "without camera", 60);
        let train = planted(1, 40);
        let own = Config::from_toml("", &[&PAPERS[..], &["camera.enabled=false"]].concat()).unwrap();
        let search = Search { base: &own, objective: Objective::F1, trials: 60, seed: 1, held: vec![] };
        assert_eq!(without.found, search.run(&[&train], &mut |_, _| {}).unwrap());
        assert_eq!(without.found.settings.weights.beta_cm, config.camera.beta);
        assert_eq!(without, judged(&config, "without camera", 60));
    }
}
