//! A stage for tests, and what holds of every sketched recording.

use super::moment::{Moment, Stage};
use super::places::{PLACES, Place};
use super::radar::View;
use super::recording::Recording;
use super::relief::Relief;
use super::rig::{RadarModel, Sensors};
use super::scene::{Block, Draft, Ground, Scene};
use crate::random::{Purpose, Random};
use nalgebra::{Translation3, UnitQuaternion};
use ralf::sensors::Source;
use ralf::space::{Transform, Vector};
use std::sync::OnceLock;

/// A lorry's side that moves, and a car that comes nearer.
pub(super) fn mirror_and_car() -> Stage {
    let random = &mut Random::new(1, Purpose::Placement, 0, 0);
    let relief = Relief::new([0.0; 2], &[], random);
    let ground = Ground { strength_db: [-20.0, 5.0], density: 0.0, reflectance: 0.2 };
    let scene = Scene { relief, ground, things: Vec::new(), bodies: Vec::new(), spots: Vec::new() };
    let mut draft = Draft { scene, random };
    let lorry = draft.mover(18, [10.0, 5.0, 0.1], 4.0, 0.0);
    draft.block(lorry, Block::new([30.0, 1.0], [0.0, 4.0]), 30.0).mirror_db = Some(2.0);
    let car = draft.mover(10, [30.0, -1.0, 3.0], 9.0, 0.0);
    draft.spot(car, [2.0, 0.3, 0.6], None, 10.0);
    Stage::new(draft.scene)
}

fn radar() -> &'static RadarModel {
    static RADAR: OnceLock<RadarModel> = OnceLock::new();
    RADAR.get_or_init(|| {
        let random = &mut Random::new(1, Purpose::World, 0, 0);
        Sensors::new(Place::Lane, random).radars.swap_remove(0)
    })
}

/// A radar that drives at 12 m/s, slightly aside.
pub(super) fn view_of<'a>(moment: &'a Moment<'a>, seconds: f64) -> View<'a> {
    let velocity = Vector::new(12.0, 0.5, 0.0);
    let place = Vector::new(0.0, 0.0, 0.6) + velocity * seconds;
    View {
        moment,
        radar: radar(),
        site_from_radar: Transform::from_parts(Translation3::from(place), UnitQuaternion::identity()),
        velocity,
        ground: &[],
    }
}

#[test]
fn every_place_has_what_is_real_and_what_is_not_and_is_the_same_again() {
    for place in PLACES {
        let [mut all, mut real, mut points] = [0, 0, 0];
        for seed in 0..3 {
            let sequence = Recording::new(place, seed).sequence(0, 6).unwrap();
            let again = Recording::new(place, seed).sequence(0, 3).unwrap();
            for radar in 0..sequence.sequence().rig.radars.len() {
                let scan = sequence.radar_scan(radar, 2).unwrap();
                let truth = sequence.truth(radar, 2).unwrap();
                assert_eq!(again.radar_scan(radar, 2).unwrap().columns, scan.columns);
                assert_eq!(truth.len(), scan.len());
                all += truth.len();
                real += truth.iter().filter(|truth| truth.class > 1).count();
            }
            points += sequence.lidar_scan(0, 0).unwrap().points.len();
        }
        let share = real as f64 / all as f64;
        assert!(all > 300 && (0.05..0.7).contains(&share), "{place:?}: {all}, {share}");
        assert!(points > 3 * 8_000, "{place:?}: {points}");
    }
}
