//! Echoes of what really is there: objects, what lies behind facades, kerbs.

use super::{Echo, View, distance_loss_db};
use crate::kind::Kind;
use crate::random::Random;
use crate::scatterer::Scatterer;
use crate::truth::Truth;
use ralf::label::Cause;

/// What a car's own body takes from what lies on its far side, dB.
const FAR_SIDE_LOSS_DB: f64 = 8.0;

/// Every scatterer that the radar can see.
pub(super) fn echoes(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let mut found = Vec::new();
    for (index, object) in view.scene.site.objects.iter().enumerate() {
        for scatterer in &object.scatterers {
            // Drawn for every scatterer, seen or not: what one hides doesn't change the others.
            let flicker_db = random.normal(scatterer.flicker_db);
            if let Some(echo) = echo(view, index, scatterer) {
                found.push(Echo { level_db: echo.level_db + flicker_db, ..echo });
            }
        }
    }
    found
}

/// The echo of a scatterer of an object.
fn echo(view: &View<'_>, object: usize, scatterer: &Scatterer) -> Option<Echo> {
    let (kind, pose) = (view.scene.site.objects[object].kind, &view.scene.poses[object]);
    let position = pose * scatterer.position;
    let range = view.range_in_view(&position)?;
    let back = (view.origin() - position) / range;
    let away = scatterer.normal.is_some_and(|normal| (pose.rotation * normal).dot(&back) < 0.05);
    let own_loss_db = match (away, kind) {
        (false, _) => 0.0,
        (true, Kind::Car) => FAR_SIDE_LOSS_DB,
        (true, _) => return None,
    };
    let loss_db = view.scene.radar_loss_db(&view.origin(), &position, Some(object))?;
    let cause = match kind.class() {
        1 => Cause::Road,
        _ if scatterer.behind_facade => Cause::InsideBuilding,
        _ => Cause::Plausible,
    };
    let truth = match cause {
        Cause::Plausible => Truth { class: kind.class(), cause },
        _ => Truth::artifact(cause),
    };
    Some(Echo {
        position,
        range_rate: view.range_rate(&position, &view.scene.velocities[object]),
        level_db: scatterer.strength_db - distance_loss_db(range) - own_loss_db - loss_db,
        truth,
    })
}
