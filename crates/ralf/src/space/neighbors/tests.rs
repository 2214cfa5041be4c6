use super::*;
use proptest::prelude::*;

fn brute_force(points: &[[f32; 3]], query: [f32; 3], k: usize) -> Vec<Neighbor> {
    let distance = |p: &[f32; 3]| {
        let [dx, dy, dz] = [p[0] - query[0], p[1] - query[1], p[2] - query[2]];
        dx * dx + dy * dy + dz * dz
    };
    let all = points.iter().enumerate();
    let mut all: Vec<_> =
        all.map(|(id, p)| Neighbor { id: id as u32, distance_squared: distance(p) }).collect();
    all.sort_by(|a, b| a.distance_squared.total_cmp(&b.distance_squared).then(a.id.cmp(&b.id)));
    all.truncate(k);
    all
}

fn check(points: &[[f32; 3]], queries: &[[f32; 3]]) {
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    let index = NeighborIndex::new(points, &ids);
    let mut found = Vec::new();
    for &query in queries {
        for k in [1, 3, 5, 10, 12] {
            index.nearest(query, k, &mut found);
            let expected = brute_force(points, query, k);
            assert_eq!(found, expected, "query {query:?}, k {k}");
            check_within(&index, query, k, &expected);
        }
    }
}

/// Reaches on both sides of the nearest point: all that are wanted, or none.
fn check_within(index: &NeighborIndex, query: [f32; 3], k: usize, expected: &[Neighbor]) {
    let nearest = expected.first().map_or(5.0, |nearest| nearest.distance_squared.sqrt());
    let mut found = Vec::new();
    for reach in [f32::INFINITY, 1.001 * nearest + 0.001, 1.4 * nearest, 3.0 * nearest] {
        index.nearest_if_within(query, k, reach, &mut found);
        let none = reach < nearest;
        assert_eq!(
            found,
            if none { &expected[..0] } else { expected },
            "query {query:?}, k {k}, reach {reach}"
        );
    }
    for reach in [0.0, 0.5 * nearest, 0.999 * nearest] {
        index.nearest_if_within(query, k, reach, &mut found);
        assert_eq!(
            found,
            if nearest > 0.0 { &expected[..0] } else { expected },
            "query {query:?}, k {k}, reach {reach}"
        );
    }
}

const QUERIES: [[f32; 3]; 7] = [
    [0.0, 0.0, 0.0],
    [10.0, -3.5, 1.0],
    [-80.2, 40.0, 0.3],
    [300.0, 300.0, 5.0],
    [-1e6, 0.0, 0.0],
    [255.99, -256.0, 0.0],
    [7.0, 7.0, -30.0],
];

#[test]
fn a_wall_with_many_points_in_one_plane() {
    let wall: Vec<_> = (0..4000).map(|i| [10.0, (i / 80) as f32 * 0.1, (i % 80) as f32 * 0.05]).collect();
    check(&wall, &QUERIES);
}

#[test]
fn every_point_twice_and_all_equal() {
    let twice: Vec<_> = (0..500).map(|i| [(i / 2) as f32 * 0.37 - 40.0, (i / 2 % 13) as f32, 0.5]).collect();
    check(&twice, &QUERIES);
    check(&[[3.0, 4.0, 1.0]; 100], &QUERIES);
}

#[test]
fn one_point_and_none() {
    check(&[[1.0, 2.0, 3.0]], &QUERIES);
    check(&[], &QUERIES);
}

#[test]
fn far_away() {
    check(
        &[[5e3, 0.0, 0.0], [5e3, 1.0, 0.0], [-7e4, 2e5, 3.0], [0.0, 1.0, 0.0], [300.0, 300.0, 4.0]],
        &QUERIES,
    );
    let far: Vec<_> = (0..100).map(|i| [1e4 + i as f32, -1e4, 0.0]).collect();
    check(&far, &QUERIES);
}

/// The identities of all points at most so far from a place, seen from above, in ascending order.
fn beside(points: &[[f32; 3]], [x, y]: [f32; 2], radius: f32) -> Vec<u32> {
    let near = |p: &[f32; 3]| (p[0] - x) * (p[0] - x) + (p[1] - y) * (p[1] - y) <= radius * radius;
    (0u32..).zip(points).filter(|(_, p)| near(p)).map(|(id, _)| id).collect()
}

fn check_beside(points: &[[f32; 3]], queries: &[[f32; 3]], radius: f32) {
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    let index = NeighborIndex::new(points, &ids);
    let mut found = Vec::new();
    for &[x, y, _] in queries {
        index.beside([x, y], radius, &mut found);
        assert_eq!(index.count_beside([x, y], radius), found.len());
        let kinds: Vec<u32> = index.ids().iter().map(|id| id % 3).collect();
        let of_two = found.iter().filter(|id| **id % 3 != 1).count();
        assert_eq!(index.count_beside_where([x, y], radius, &kinds, |kind| kind != 1), of_two);
        found.sort_unstable();
        assert_eq!(found, beside(points, [x, y], radius), "query {x} {y}, radius {radius}");
    }
}

#[test]
fn all_beside_far_away_and_of_no_number() {
    let far = [[5e3, 0.0, 0.0], [5e3, 1.0, 90.0], [-7e4, 2e5, 3.0], [0.0, 1.0, 0.0], [300.0, 300.0, 4.0]];
    for radius in [0.0, 1.0, 100.0, 1e6, f32::INFINITY] {
        check_beside(&far, &QUERIES, radius);
        check_beside(&far, &far, radius);
        check_beside(&[], &QUERIES, radius);
    }
    let (index, mut found) = (NeighborIndex::new(&far, &[0, 1, 2, 3, 4]), vec![7]);
    for (place, radius) in [([f32::NAN, 0.0], 9.0), ([0.0, 0.0], -1.0), ([0.0, 0.0], f32::NAN)] {
        index.beside(place, radius, &mut found);
        assert!(found.is_empty());
    }
}

/// All within a radius of the way from one place to another are in the stretches along it, and none twice.
fn check_along(points: &[[f32; 3]], [from, to]: [[f32; 2]; 2], radius: f32) {
    let ids: Vec<u32> = (0..points.len() as u32).collect();
    let index = NeighborIndex::new(points, &ids);
    let mut found: Vec<u32> =
        index.runs_along([from, to], radius).flatten().map(|at| index.ids()[at]).collect();
    found.sort_unstable();
    assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "none twice");
    let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
    for (id, [x, y, _]) in (0u32..).zip(points) {
        let gone = ((x - from[0]) * dx + (y - from[1]) * dy) / (dx * dx + dy * dy).max(f32::MIN_POSITIVE);
        let gone = gone.clamp(0.0, 1.0);
        let distance = (x - from[0] - gone * dx).hypot(y - from[1] - gone * dy);
        assert!(distance > radius || found.binary_search(&id).is_ok(), "{from:?} {to:?} {radius}: {x} {y}");
    }
}

#[test]
fn all_along_ways_that_are_points_rows_and_columns() {
    let lattice: Vec<_> = (0..400).map(|i| [(i % 20) as f32, (i / 20) as f32 - 7.5, 0.0]).collect();
    for to in [[4.0, 2.0], [9.0, 2.0], [4.0, 11.5], [4.0, -30.0], [-300.0, 2.0], [500.0, 400.0]] {
        for radius in [0.0, 1.0, 3.5] {
            check_along(&lattice, [[4.0, 2.0], to], radius);
            check_along(&[], [[4.0, 2.0], to], radius);
        }
    }
    let index = NeighborIndex::new(&lattice, &(0..400).collect::<Vec<u32>>());
    assert!(index.runs_along([[0.0; 2], [f32::NAN, 0.0]], 9.0).next().is_none());
}

proptest! {
    #[test]
    fn all_along_as_brute_force(
        points in prop::collection::vec(prop::array::uniform3(-60f32..60.0), 0..400),
        from in prop::array::uniform2(-90f32..90.0), to in prop::array::uniform2(-90f32..90.0),
        radius in 0f32..20.0,
    ) {
        check_along(&points, [from, to], radius);
    }

    #[test]
    fn all_beside_as_brute_force(
        points in prop::collection::vec(prop::array::uniform3(-60f32..60.0), 0..400),
        queries in prop::collection::vec(prop::array::uniform3(-90f32..90.0), 5),
        radius in 0f32..40.0,
    ) {
        check_beside(&points, &queries, radius);
    }

    #[test]
    fn as_brute_force(
        points in prop::collection::vec(prop::array::uniform3(-60f32..60.0), 0..400),
        queries in prop::collection::vec(prop::array::uniform3(-90f32..90.0), 5),
    ) {
        check(&points, &queries);
    }

    #[test]
    fn as_brute_force_on_a_lattice(
        points in prop::collection::vec(prop::array::uniform3((-9i8..9).prop_map(|v| f32::from(v) * 0.5)), 0..300),
        query in prop::array::uniform3((-12i8..12).prop_map(|v| f32::from(v) * 0.5)),
    ) {
        check(&points, &[query]);
    }
}
