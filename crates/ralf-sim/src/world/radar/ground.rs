//! Echoes of the ground: rough pieces of it, lumps in the road, and kerbs.

use super::echo::{Echo, View, fluctuation_db, glint_db};
use super::equation::decibel;
use crate::random::{Random, grain};
use crate::world::terrain::{Patch, Surface};
use ralf::label::Cause;
use ralf::space::{Point, Vector};

/// Side of a piece of ground, m.
const PIECE: f64 = 1.0;
/// The ground is heard up to here, m.
const REACH: f64 = 80.0;
/// Grazing angle at which backscatter is stated: sine of 10 degrees.
const STATED: f64 = 0.1736;

/// Along a kerb, m.
const KERB_STEP: f64 = 0.5;
/// Cross-section of half a metre of kerb seen at right angles, dBsm, and its spread: an edge of stone of 10 cm (chosen
/// between asphalt and a post).
const KERB_DB: (f64, f64) = (-10.0, 6.0);

/// The ground, piece by piece: each has a place where it reflects best and a strength, and both stay from scan to scan;
/// speckle is new in each.
pub(super) fn pieces(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let reach = REACH.min(view.radar.max_range);
    let origin = view.origin();
    let steps = (reach / PIECE).ceil() as i64;
    let [i0, j0] = [(origin.x / PIECE).floor() as i64, (origin.y / PIECE).floor() as i64];
    let ahead = view.site_from_radar.rotation * Vector::x();
    let edge = (view.radar.fov[0] / 2.0).cos().min(0.999);
    let mut found = Vec::new();
    for i in -steps..=steps {
        for j in -steps..=steps {
            let way = Vector::new(i as f64 * PIECE, j as f64 * PIECE, 0.0);
            let range = way.norm();
            // Roughly in view; the rest is asked of the place itself.
            if range < reach && (range < 3.0 || way.dot(&ahead) > (edge - 0.1) * range) {
                let speckle = random.exponential(1.0);
                found.extend(piece(view, [i0 + i, j0 + j], speckle));
            }
        }
    }
    found
}

fn piece(view: &View<'_>, [i, j]: [i64; 2], speckle: f64) -> Option<Echo> {
    let site = view.moment.site;
    let share = |k: i64| grain(site.seed ^ 0x6_7261_7373, [i, j, k]);
    let (x, y) = ((i as f64 + share(0)) * PIECE, (j as f64 + share(1)) * PIECE);
    let patch = site.terrain.patch(x, y);
    let place = Point::new(x, y, site.terrain.height(x, y) + patch.pile * share(2));
    let seen = view.seen(&place)?;
    let grazing = ((view.origin().z - place.z) / seen.range).max(0.005);
    let texture = glint_db(site.seed ^ 0x72, i * 65_536 + j, 0.0, 1.0, view.waves.texture_db);
    let [often, strong_db] = view.waves.lumps;
    let lump = if patch.surface != Surface::Grass && share(3) < often { strong_db } else { 0.0 };
    let rcs = view.waves.asphalt_db
        + view.waves.roughness_db(patch.surface)
        + 15.0 * (grazing / STATED).log10()
        + decibel(PIECE * PIECE)
        + texture
        + lump
        + decibel(speckle.max(1e-3));
    let level = view.level_db(&seen, rcs)?;
    let loss = view.loss_db(&(place + Vector::z() * 0.05), &[])?;
    Some(Echo::new(seen, view.range_rate(&place, &Vector::zeros()), level - loss, patch.surface.truth()))
}

/// The faces of kerbs, half a metre at a time: each with a strength of its own.
pub(super) fn kerbs(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let origin = view.origin();
    let reach = REACH.min(view.radar.max_range);
    let mut found = Vec::new();
    for (number, patch) in view.moment.site.terrain.patches().iter().enumerate() {
        if patch.rise < 0.02 {
            continue;
        }
        let [x, y] = patch.own(origin.x, origin.y);
        for side in [-1.0, 1.0] {
            let across = y - side * patch.half[1];
            // Faces look outward.
            if across * side < 0.2 || across.abs() > reach {
                continue;
            }
            let half = (reach * reach - across * across).sqrt();
            let ends = [(x - half).max(-patch.half[0]), (x + half).min(patch.half[0])];
            let [first, last] = ends.map(|end| (end / KERB_STEP).ceil() as i64);
            for step in first..=last {
                let name = [number as i64 * 2 + i64::from(side > 0.0), step];
                let place = [step as f64 * KERB_STEP, side * patch.half[1]];
                found.extend(kerb(view, patch, name, place, across.abs(), random));
            }
        }
    }
    found
}

fn kerb(
    view: &View<'_>,
    patch: &Patch,
    name: [i64; 2],
    place: [f64; 2],
    across: f64,
    random: &mut Random,
) -> Option<Echo> {
    let site = view.moment.site;
    let [x, y] = patch.place(place);
    let place = Point::new(x, y, site.terrain.height(x, y) - 0.4 * patch.rise);
    let seen = view.seen(&place)?;
    let own = glint_db(site.seed ^ 0x6b, name[0] * 65_536 + name[1], 0.0, 1.0, KERB_DB.1);
    let facing = (across / seen.range).clamp(0.05, 1.0);
    let height_db = 20.0 * (patch.rise / 0.1).log10();
    let rcs = KERB_DB.0 + own + height_db + decibel(facing) + fluctuation_db(random);
    let level = view.level_db(&seen, rcs)? - view.loss_db(&(place + Vector::z() * 0.1), &[])?;
    Some(Echo::artifact(seen, view.range_rate(&place, &Vector::zeros()), level, Cause::Road))
}
