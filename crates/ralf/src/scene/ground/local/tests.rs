use super::*;
use rand::{RngExt, SeedableRng};

/// A street that climbs by 10 % from x = 10 m on, a pavement 0.12 m above it at its left, from y = 4 m on; every cell
/// of
/// `spacing` has a point.
fn street(spacing: f32) -> Vec<[f32; 3]> {
    let steps = (60.0 / spacing) as i32;
    let place = |i: i32| (i as f32 + 0.5) * spacing;
    let cells = (-steps..steps).flat_map(|i| (-steps / 2..steps / 2).map(move |j| (i, j)));
    cells.map(|(i, j)| [place(i), place(j), truth(place(i), place(j))]).collect()
}

fn truth(x: f32, y: f32) -> f32 {
    0.1 * (x - 10.0).max(0.0) + if y >= 4.0 { 0.12 } else { 0.0 }
}

fn error(surface: &GroundSurface, x: f32, y: f32) -> f64 {
    surface.height(&Point::new(x.into(), y.into(), truth(x, y).into())).unwrap().abs()
}

#[test]
fn follows_slopes_and_kerbs() {
    let surface = GroundSurface::fit(&street(0.25)).unwrap();
    for (x, y) in [(-40.0, 0.0), (0.0, -3.0), (9.0, 2.0), (30.0, 0.0), (50.0, 6.0), (20.0, -8.0)] {
        assert!(error(&surface, x, y) < 0.03, "{x} {y}: {}", error(&surface, x, y));
    }
    // On the level a step is the kerb alone; on the slope a cell to each side adds 0.1 m.
    for (x, y, expected) in [(-20.0, 0.0, 0.0), (-20.0, 4.1, 0.12), (30.0, 0.0, 0.1), (30.0, 3.9, 0.22)] {
        let step = surface.step_at(x, y).unwrap();
        assert!((step - expected).abs() < 0.01, "{x} {y}: {step}");
    }
    let normal = surface.plane_at(30.0, 0.0).unwrap().normal;
    assert!((normal.x / normal.z + 0.1).abs() < 1e-3 && normal.y.abs() < 1e-3);
}

#[test]
fn cars_pits_and_gaps_leave_no_mark() {
    let mut points = street(0.25);
    // Two cars: one whose roof hides the street below, one of which the sides are seen, too.
    let under = |[x, y, _]: &[f32; 3], at: f32| (x - at).abs() < 2.2 && y.abs() < 0.9;
    for point in points.iter_mut().filter(|point| under(point, -20.0)) {
        point[2] += 1.5;
    }
    points.extend((0..20).map(|i| [-10.0 + 0.2 * i as f32, 1.0, 0.5]));
    // Mirror images below the street, and a patch that nothing was seen of.
    points.extend([[-30.2, 0.2, -1.5], [5.3, -3.3, -0.9]]);
    points.retain(|[x, y, _]| (x + 40.0).hypot(*y) > 3.0);
    points.push([f32::NAN; 3]);
    let surface = GroundSurface::fit(&points).unwrap();
    for (x, y) in [(-20.0, 0.0), (-21.5, 0.5), (-8.0, 1.0), (-40.0, 0.0)] {
        assert!(error(&surface, x, y) < 0.02, "{x} {y}: {}", error(&surface, x, y));
    }
    for (x, y) in [(-30.2, 0.2), (5.3, -3.3)] {
        assert!(error(&surface, x, y) < 0.02, "{x} {y}: {}", error(&surface, x, y));
        assert!(error(&surface, x + 3.0, y) < 0.01);
    }
}

#[test]
fn points_below_a_wet_road_do_not_take_it_down() {
    let mut points = street(0.25);
    let mut random = rand_pcg::Pcg64::seed_from_u64(2);
    // One in a hundred of these sparse points is as many a cell as one in a thousand of a window's.
    for point in &mut points {
        if random.random_bool(0.01) {
            point[2] -= random.random_range(0.35..0.9);
        }
    }
    let surface = GroundSurface::fit(&points).unwrap();
    for at in 0..200 {
        let (x, y) = (random.random_range(-40.0..40.0), random.random_range(-10.0..3.0));
        assert!(error(&surface, x, y) < 0.05, "{at}: {x} {y}: {}", error(&surface, x, y));
    }
}

#[test]
fn what_was_not_seen_has_no_ground() {
    assert!(GroundSurface::fit(&[]).is_none());
    assert!(GroundSurface::fit(&[[1.0, 2.0, 30.0], [f32::NAN, 0.0, 0.0]]).is_none(), "no ground is so high");
    let surface = GroundSurface::fit(&[[10.0, 0.0, 0.25]]).unwrap();
    assert_eq!(surface.height_at(12.0, 0.0), Some(0.25));
    assert_eq!(surface.height_at(20.0, 0.0), None);
    for (x, y) in [(90.0, 0.0), (0.0, -1e9), (f64::NAN, 0.0), (f64::INFINITY, 0.0)] {
        assert!(surface.height_at(x, y).is_none() && surface.step_at(x, y).is_none());
        assert!(surface.plane_at(x, y).is_none());
    }
}

#[test]
fn the_lowest_points_alone_give_the_same_surface() {
    let points: Vec<[f32; 3]> =
        street(0.2).into_iter().enumerate().map(|(i, [x, y, z])| [x, y, z + (i % 7) as f32 * 0.05]).collect();
    let lowest = GroundSurface::lowest_points(&points);
    assert!(lowest.len() < points.len() / 4);
    let [all, few] = [&points, &lowest].map(|points| GroundSurface::fit(points).unwrap());
    assert_eq!(all.heights, few.heights);
}
