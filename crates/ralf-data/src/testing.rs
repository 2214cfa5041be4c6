//! What the tests of several readers share.

use crate::Settings;
use crate::read::ros::Topics;
use crate::read::{Recording, SequenceReader, open_selected};
use ralf::sensors::{Elevation, Radar, Reliability};
use ralf::space::Transform;
use std::path::{Path, PathBuf};

/// A folder of the real recordings, where the environment names them; else the test says that it is skipped.
pub(crate) fn data(name: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("RALF_TEST_DATA").map(|root| Path::new(&root).join(name));
    if folder.is_none() {
        println!("skipped: RALF_TEST_DATA is not set");
    }
    folder
}

/// A radar that looks ahead from a vehicle's front and measures no elevation, with these fields.
pub(crate) fn radar(fields: &[&str]) -> Radar {
    Radar {
        name: "front".to_owned(),
        fields: fields.iter().map(|name| (*name).to_owned()).collect(),
        vehicle_from_radar: Transform::translation(3.0, 0.0, 0.5),
        elevation: Elevation::None,
        fov_azimuth: 2.0,
        fov_elevation: 1.0,
        sigma_range: 0.1,
        sigma_azimuth: 0.01,
        sigma_elevation: 0.01,
        reliability: Reliability::default(),
    }
}

/// Writes a file, with its folders.
pub(crate) fn write(file: &Path, bytes: &[u8]) {
    crate::disk::files::write_whole(file, bytes).unwrap();
}

/// The sequence of a recording that has one.
pub(crate) fn only(recording: &Recording) -> &dyn SequenceReader {
    recording.sequences[0].as_ref()
}

/// A recording of which one sequence is damaged: it is left out with a reason that holds these words, costs one that is
/// named nothing, and is refused where it is named itself, or alone.
pub(crate) fn check_left_out(path: &Path, [good, bad]: [&str; 2], words: &str) {
    let open = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| (*name).to_owned()).collect();
        let opened = open_selected(path, None, &Topics::new(), &names)?;
        Settings::default().correct(opened)
    };
    let all = open(&[]).unwrap();
    let names = |recording: &Recording| -> Vec<String> {
        recording.sequences.iter().map(|reader| reader.sequence().name.clone()).collect()
    };
    assert_eq!(names(&all), [good]);
    let [lost] = &all.incomplete[..] else { panic!("{:?}", all.incomplete) };
    let told = lost.lost.to_string();
    assert!(lost.name == bad && told.contains(words), "{lost:?}");
    let chosen = open(&[good]).unwrap();
    assert_eq!((names(&chosen), chosen.incomplete.len()), (vec![good.to_owned()], 0));
    assert_eq!(all.left_out(), [format!("{bad}: {told}")]);
    for refused in [open(&[bad]), open(&[good, bad]), all.whole()] {
        assert_eq!(refused.unwrap_err().to_string(), told);
    }
    let unknown = open(&["nowhere"]).unwrap_err().to_string();
    assert!(
        unknown.contains(&format!("no sequence `nowhere` in the recording, which holds {good}")),
        "{unknown}"
    );
}
