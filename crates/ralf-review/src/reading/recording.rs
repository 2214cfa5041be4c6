//! What there is.

use super::times;
use crate::app::App;
use crate::causes::sayable;
use crate::http::{Answer, json};
use crate::labelled::is_labelled;
use crate::place::folder_name;
use crate::shared_store;
use ralf::config::Method;
use ralf::label::{class_name, cluster_of, flag, truth_of};
use ralf_data::SequenceReader;
use ralf_data::result::ClassSource;
use ralf_data::run::read_record;
use serde_json::{Value, json};

/// The bits of a detection's flags (docs/formats.md, section 2).
const FLAGS: [(u16, &str); 8] = [
    (flag::GROUND, "ground"),
    (flag::BLIND_SPOT, "blind spot"),
    (flag::CAMERA_FAILED, "camera failed"),
    (flag::NO_LIDAR, "no LiDAR scan"),
    (flag::NO_NEIGHBOURS, "no neighbouring radar scan"),
    (flag::UNOBSERVED, "unobserved"),
    (flag::PAPER, "paper"),
    (flag::UNCONFIRMED, "unconfirmed"),
];

/// SemanticKITTI's ids end here.
const LAST_CLASS: u16 = 259;

/// The recording's sequences with all that they can be asked for.
pub(crate) fn recording(app: &App) -> Answer {
    let sequences: Vec<Value> =
        app.recording.sequences.iter().map(|reader| sequence(app, reader.as_ref())).collect();
    let settings = read_record(&app.out)?.settings.method;
    // A model knows of the floor: there the label is settled where the paper's method answered in its place.
    let decided = match settings.method {
        Method::Paper => flag::GROUND,
        Method::Learned => flag::GROUND | flag::PAPER,
    };
    let flag = |(bit, name): &(u16, &str)| json!({ "bit": bit, "name": name, "decided": bit & decided != 0 });
    let flags: Vec<Value> = FLAGS.iter().map(flag).collect();
    json(&json!({
        "dataset": folder_name(&app.recording.path),
        "out": folder_name(&app.out),
        "author": app.author,
        "second": app.team.second,
        "people": app.team.people(),
        "store": app.said(shared_store::identity)?,
        "read_only": app.store.read_only(),
        "threshold": settings.fusion.threshold,
        "sequences": sequences,
        "classes": (0..=LAST_CLASS).filter_map(class).collect::<Vec<_>>(),
        "class_sources": class_sources(),
        "causes": app.causes.names(),
        "sayable_causes": sayable(),
        "flags": flags,
    }))
}

/// What tells a class, by number; 0 is nothing.
fn class_sources() -> Vec<&'static str> {
    std::iter::once("").chain(ClassSource::ALL.map(ClassSource::name)).collect()
}

fn sequence(app: &App, reader: &dyn SequenceReader) -> Value {
    let sequence = reader.sequence();
    let (rig, all) = (&sequence.rig, &sequence.times);
    let radars = rig.radars.iter().zip(&all.radars);
    let lidars = rig.lidars.iter().zip(&all.lidars);
    let cameras = rig.cameras.iter().zip(&all.cameras);
    let camera = |(camera, images): (&ralf::sensors::Camera, &Vec<i64>)| {
        let (width, height) = (camera.width, camera.height);
        json!({ "name": camera.name, "width": width, "height": height, "images": times(images) })
    };
    json!({
        "name": sequence.name,
        "title": sequence.title,
        "labelled": is_labelled(&app.out, &sequence.name),
        "assigned": app.team.of_sequence(&sequence.name),
        "radars": radars.map(|(radar, scans)| json!({ "name": radar.name, "scans": times(scans) })).collect::<Vec<_>>(),
        "lidars": lidars.map(|(lidar, scans)| json!({ "name": lidar.name, "scans": times(scans) })).collect::<Vec<_>>(),
        "cameras": cameras.map(camera).collect::<Vec<_>>(),
    })
}

fn class(id: u16) -> Option<Value> {
    let name = class_name(id)?;
    Some(json!({
        "id": id,
        "name": name,
        "cluster": cluster_of(id).map(ralf::label::Cluster::name),
        "plausible": truth_of(id),
    }))
}
