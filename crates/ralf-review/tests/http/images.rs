//! Where the cameras see detections, things and the points of the LiDAR.

use crate::support::{CAMERA, LIDAR, Out, RADAR, recording};
use ralf::sensors::{Sequence, is_return};
use ralf::space::Point;
use std::collections::BTreeMap;

/// The image that is asked for.
const IMAGE: usize = 1;

/// Pixel and depth of a point of the vehicle frame at some time, by way of the world; `None` outside the
/// image.
fn seen(sequence: &Sequence, t_ns: i64, p: &Point) -> Option<[f64; 3]> {
    let in_world = sequence.motion.odom_from_vehicle(t_ns) * p;
    let camera = &sequence.rig.cameras[0];
    let image_ns = sequence.times.cameras[0][IMAGE];
    let at_image = sequence.motion.odom_from_vehicle(image_ns).inverse() * in_world;
    let p = camera.vehicle_from_camera.inverse() * at_image;
    let [u, v] = camera.intrinsics.project(&p)?;
    let inside = |at: f64, size: usize| (-0.5..size as f64 - 0.5).contains(&at);
    (inside(u, camera.width) && inside(v, camera.height)).then_some([u, v, p.z])
}

/// Whether the same pixel and depth were told, rounded.
fn same(a: [f64; 3], told: [f32; 3]) -> bool {
    let apart = |i: usize| (a[i] - f64::from(told[i])).abs();
    apart(0) < 0.01 && apart(1) < 0.01 && apart(2) < 1e-3
}

#[test]
fn an_image_is_the_file_and_detections_are_where_the_camera_sees_them() {
    let out = Out::new();
    let server = out.serve();
    let image = server.of_sequence(&format!("cameras/{CAMERA}/images/{IMAGE}"));
    let reader = &recording().sequences[0];
    assert_eq!(image.body, std::fs::read(reader.image_file(0, IMAGE).unwrap()).unwrap());
    assert_eq!(image.headers["content-type"], "image/png");
    let asked = format!("cameras/{CAMERA}/images/{IMAGE}/detections?radar={RADAR}&scan=2");
    let table = server.of_sequence(&asked).table();
    let sequence = reader.sequence();
    let scan_ns = sequence.times.radars[0][2];
    assert_ne!(scan_ns, sequence.times.cameras[0][IMAGE]);
    let places = server.table(2);
    let [x, y, z] = ["x", "y", "z"].map(|name| places.f32(name));
    let [u, v, depth] = ["u", "v", "depth"].map(|name| table.f32(name));
    let mut count = 0;
    for row in 0..places.rows() {
        let expected = seen(sequence, scan_ns, &Point::from([x[row], y[row], z[row]].map(f64::from)));
        let told = [u[row], v[row], depth[row]];
        assert!(expected.map_or(u[row].is_nan(), |expected| same(expected, told)), "{expected:?} {told:?}");
        count += usize::from(expected.is_some());
    }
    assert!(count > 10, "{count}");
}

#[test]
fn a_lidar_is_where_the_camera_sees_it_and_the_nearest_come_last() {
    let out = Out::new();
    let server = out.serve();
    let reader = &recording().sequences[0];
    let sequence = reader.sequence();
    let ask = |query: &str| server.of_sequence(&format!("cameras/{CAMERA}/images/{IMAGE}/lidar?{query}"));
    let table = ask(&format!("lidar={LIDAR}&scan=0")).table();
    let t_ns = sequence.times.lidars[0][0];
    let mut expected: Vec<([f64; 3], f64)> = Vec::new();
    for point in reader.lidar_scan(0, 0).unwrap().points.iter().filter(|point| is_return(point)) {
        let place = sequence.rig.lidars[0].vehicle_from_lidar * Point::from(point.map(f64::from));
        expected.extend(seen(sequence, t_ns, &place).map(|pixel| (pixel, place.z)));
    }
    expected.sort_by(|(a, _), (b, _)| b[2].total_cmp(&a[2]));
    let [u, v, depth, z] = ["u", "v", "depth", "z"].map(|name| table.f32(name));
    assert_eq!(table.rows(), expected.len());
    assert!(expected.len() > 100, "{}", expected.len());
    for (row, (pixel, height)) in expected.into_iter().enumerate() {
        assert!(same(pixel, [u[row], v[row], depth[row]]) && (height - f64::from(z[row])).abs() < 1e-3);
    }
    assert!(ask("lidar=other&scan=0").refused(404).contains("`other`"));
    assert!(ask(&format!("lidar={LIDAR}&scan=99")).refused(404).contains("99"));
}

#[test]
fn a_thing_is_seen_in_an_image_as_often_as_it_was_measured() {
    let out = Out::new();
    let server = out.serve();
    let reader = &recording().sequences[0];
    let sequence = reader.sequence();
    let things = server.of_sequence("things").table();
    let ids = things.u32("thing");
    // By thing: radar, scan and point of each detection.
    let mut members: BTreeMap<u32, Vec<(String, u64, usize)>> = BTreeMap::new();
    let mut ids = ids.iter();
    for scan in things.header["scans"].as_array().unwrap() {
        let name = scan["radar"].as_str().unwrap();
        for point in 0..scan["rows"].as_u64().unwrap() as usize {
            let of = members.entry(*ids.next().unwrap()).or_default();
            of.push((name.to_owned(), scan["scan"].as_u64().unwrap(), point));
        }
    }
    let asked = |thing: u32| server.of_sequence(&format!("cameras/{CAMERA}/images/{IMAGE}/things/{thing}"));
    let several = members.values().zip(members.keys()).filter(|(of, _)| of.len() > 4);
    let (members, table) =
        several.map(|(of, thing)| (of, asked(*thing).table())).find(|(_, table)| table.rows() > 2).unwrap();
    let scans = table.header["scans"].as_array().unwrap();
    let [u, v, depth] = ["u", "v", "depth"].map(|name| table.f32(name));
    let mut told = (0..table.rows()).map(|row| {
        let scan = &scans[table.u32("scan")[row] as usize];
        let id = (scan["radar"].as_str().unwrap().to_owned(), scan["scan"].as_u64().unwrap());
        ((id.0, id.1, table.u32("point")[row] as usize), [u[row], v[row], depth[row]])
    });
    for (radar, scan, point) in members {
        let index = sequence.rig.radars.iter().position(|known| known.name == *radar).unwrap();
        let measured = reader.radar_scan(index, *scan as usize).unwrap();
        let place = sequence.rig.radars[index].vehicle_from_radar * measured.positions[*point];
        let Some(pixel) = seen(sequence, measured.t_ns, &place) else { continue };
        let (id, pixels) = told.next().unwrap();
        assert_eq!(id, (radar.clone(), *scan, *point));
        assert!(same(pixel, pixels), "{pixel:?} {pixels:?}");
    }
    assert!(told.next().is_none());
    let count = things.header["things"].as_u64().unwrap();
    assert!(asked(count as u32).refused(404).contains("a number below"));
}
