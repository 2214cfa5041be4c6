//! What the page sees is what the files hold.

use crate::support::{CAMERA, LIDAR, Out, RADAR, SEQUENCE, Table, recording};
use ralf::config::Config;
use ralf::sensors::{Rig, is_return};
use ralf::space::Point;
use ralf_data::DataError;
use ralf_data::result::{PlausibilityReader, Schema};
use ralf_data::{Causes, ScanId, read_labels};
use serde_json::{Value, json};
use std::collections::BTreeMap;

fn scan_id(scan: u32) -> ScanId {
    ScanId { sequence: SEQUENCE.into(), radar: RADAR.into(), scan }
}

#[test]
fn the_recording_is_listed() {
    let out = Out::new();
    let listed = out.serve().get("/api/recording").json();
    assert_eq!(
        (&listed["author"], &listed["threshold"], &listed["dataset"]),
        (&json!("ada"), &json!(Config::default().fusion.threshold), &json!("recording"))
    );
    let sequence = &listed["sequences"][0];
    assert_eq!((&sequence["name"], &sequence["labelled"]), (&json!(SEQUENCE), &json!(true)));
    let reader = &recording().sequences[0];
    let times = &reader.sequence().times;
    for (kind, name, known) in [
        ("radars", "scans", &times.radars),
        ("lidars", "scans", &times.lidars),
        ("cameras", "images", &times.cameras),
    ] {
        let listed = sequence[kind].as_array().unwrap();
        let found: Vec<Vec<i64>> = listed
            .iter()
            .map(|sensor| sensor[name].as_array().unwrap().iter().map(nanoseconds).collect())
            .collect();
        assert_eq!(found, *known, "{kind}");
    }
    let classes = listed["classes"].as_array().unwrap();
    let class = |id| classes.iter().find(|class| class["id"] == id).unwrap();
    assert_eq!(*class(10), json!({ "id": 10, "name": "car", "cluster": "vehicle", "plausible": true }));
    assert_eq!(*class(40), json!({ "id": 40, "name": "road", "cluster": "artifact", "plausible": false }));
    assert_eq!(class(259)["name"], "moving-other-vehicle");
    assert_eq!((&listed["causes"][0], &listed["causes"][1]), (&json!(""), &json!("road")));
    assert_eq!(listed["flags"][5], json!({ "bit": 32, "name": "unobserved", "decided": false }));
}

fn nanoseconds(text: &Value) -> i64 {
    text.as_str().unwrap().parse().unwrap()
}

/// All rows of the result, by column.
#[derive(Default)]
struct Rows {
    radar: Vec<String>,
    scan: Vec<usize>,
    x: Vec<f32>,
    y: Vec<f32>,
    z: Vec<f32>,
    w: Vec<f32>,
    w_opt: Vec<f32>,
    flags: Vec<u16>,
}

impl Rows {
    fn read(out: &Out) -> Self {
        let schema = Schema::of(&Rig::default(), &[]).unwrap();
        let reader = PlausibilityReader::open(&out.parquet(), &schema).unwrap();
        let mut rows = Self::default();
        let read = reader.each(&["x", "y", "z", "w", "w_opt", "flags"], |key, table| {
            rows.radar.extend(vec![key.radar.to_string(); table.len()]);
            rows.scan.extend(vec![key.scan; table.len()]);
            rows.x.extend(table.get::<f32>("x")?);
            rows.y.extend(table.get::<f32>("y")?);
            rows.z.extend(table.get::<f32>("z")?);
            rows.w.extend(table.get::<f32>("w")?);
            rows.w_opt.extend(table.get::<f32>("w_opt")?);
            rows.flags.extend(table.get::<u16>("flags")?);
            Ok::<_, DataError>(())
        });
        read.unwrap();
        rows
    }
}

#[test]
fn detections_are_those_of_the_run() {
    let out = Out::new();
    let server = out.serve();
    let table = server.table(1);
    let all = Rows::read(&out);
    let rows: Vec<usize> =
        (0..all.w.len()).filter(|row| all.radar[*row] == RADAR && all.scan[*row] == 1).collect();
    assert!(rows.len() > 50 && table.rows() == rows.len());
    let same = |name: &str, column: &[f32]| {
        let expected: Vec<u32> = rows.iter().map(|row| column[*row].to_bits()).collect();
        let found: Vec<u32> = table.f32(name).into_iter().map(f32::to_bits).collect();
        assert_eq!(found, expected, "{name}");
    };
    for (name, column) in [("x", &all.x), ("y", &all.y), ("z", &all.z), ("w", &all.w), ("w_opt", &all.w_opt)]
    {
        same(name, column);
    }
    assert_eq!(table.u16("flags"), rows.iter().map(|row| all.flags[*row]).collect::<Vec<_>>());
    let machine: Vec<u16> =
        read_labels(&scan_id(1).label_file(out.path())).unwrap().iter().map(|label| label.id).collect();
    assert_eq!((table.u16("machine"), table.u16("label")), (machine.clone(), machine));
    assert!(table.u8("corrected").iter().all(|corrected| *corrected == 0));
    let causes = Causes::find(&recording().path, SEQUENCE).unwrap().unwrap();
    assert_eq!(Some(table.u8("cause")), causes.of_scan(&scan_id(1), rows.len()).unwrap());
    assert!(table.names().contains(&"doppler") && table.names().contains(&"rcs"));
    assert_eq!((&table.header["revision"], &table.header["reviewed"]), (&json!(0), &json!(null)));
}

#[test]
fn a_scan_tells_what_belongs_to_it() {
    let out = Out::new();
    let header = out.serve().table(2).header;
    let reader = &recording().sequences[0];
    let sequence = reader.sequence();
    let t_ns = sequence.times.radars[0][2];
    assert_eq!(nanoseconds(&header["t_ns"]), t_ns);
    let pose = sequence.motion.odom_from_vehicle(t_ns).to_homogeneous();
    let numbers: Vec<f64> =
        header["odom_from_vehicle"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
    for (i, number) in numbers.iter().enumerate() {
        assert_eq!(*number, pose[(i / 4, i % 4)], "row-major");
    }
    let nearest = |times: &[i64]| (0..times.len()).min_by_key(|i| times[*i].abs_diff(t_ns)).unwrap();
    assert_eq!(header["lidar"], json!({ "name": LIDAR, "scan": nearest(&sequence.times.lidars[0]) }));
    let image = nearest(&sequence.times.cameras[0]);
    let time = sequence.times.cameras[0][image].to_string();
    assert_eq!(header["cameras"][0], json!({ "name": CAMERA, "image": image, "t_ns": time }));
    assert_eq!(header["cameras"].as_array().unwrap().len(), 4);
    assert!(header["failed_cameras"].is_array());
}

#[test]
fn a_cloud_is_the_lidars_with_its_ground() {
    let out = Out::new();
    let table = out.serve().of_sequence(&format!("lidars/{LIDAR}/scans/0")).table();
    let reader = &recording().sequences[0];
    let scan = reader.lidar_scan(0, 0).unwrap();
    assert_eq!((table.rows(), table.f32("intensity")), (scan.points.len(), scan.intensity.clone()));
    let vehicle_from_lidar = reader.sequence().rig.lidars[0].vehicle_from_lidar;
    let [x, y, z] = ["x", "y", "z"].map(|name| table.f32(name));
    let ground = table.u8("ground");
    for (row, point) in scan.points.iter().enumerate() {
        let p = vehicle_from_lidar * Point::from(point.map(f64::from));
        assert_eq!([x[row], y[row], z[row]], [p.x, p.y, p.z].map(|value| value as f32));
        // The street is flat but for slopes at its rim.
        assert!(ground[row] == 0 || z[row] < 1.0);
        assert!(ground[row] == 1 || z[row] > 0.0 || p.coords.norm() > 15.0, "{point:?} at {}", z[row]);
    }
    let share = ground.iter().map(|flag| f64::from(*flag)).sum::<f64>() / ground.len() as f64;
    assert!((0.1..0.95).contains(&share), "{share}");
}

/// Against going through all points of the scan.
#[test]
fn the_points_near_a_place_of_the_world_are_those_of_the_scan() {
    let out = Out::new();
    let server = out.serve();
    let scan = format!("lidars/{LIDAR}/scans/1");
    let (whole, recording) = (server.of_sequence(&scan).table(), recording());
    let sequence = recording.sequences[0].sequence();
    let odom_from_vehicle = sequence.motion.odom_from_vehicle(sequence.times.lidars[0][1]);
    let columns = |table: &Table| ["x", "y", "z", "intensity"].map(|name| table.f32(name));
    let all = columns(&whole);
    let place = |row: usize| odom_from_vehicle * Point::from([0, 1, 2].map(|axis| f64::from(all[axis][row])));
    let some = (whole.rows() / 2..).find(|row| all[0][*row].is_finite()).unwrap();
    let (middle, radius) = (place(some), 6.0);
    let wanted: Vec<usize> = (0..whole.rows())
        .filter(|row| (place(*row) - middle).xy().norm() <= radius && all[0][*row].is_finite())
        .collect();
    assert!(wanted.len() > 10 && wanted.len() < whole.rows() / 2, "{}", wanted.len());
    let near = |x: f64, radius: f64| {
        server.of_sequence(&format!("{scan}/near?x={x}&y={}&radius={radius}", middle.y))
    };
    let found = near(middle.x, radius).table();
    let expected = all.map(|column| wanted.iter().map(|row| column[*row]).collect::<Vec<f32>>());
    assert_eq!(columns(&found), expected);
    assert_eq!(found.header["odom_from_vehicle"], whole.header["odom_from_vehicle"]);
    assert_eq!(near(1e6, radius).table().rows(), 0);
    for (x, radius) in [(f64::NAN, 5.0), (middle.x, 0.0), (middle.x, 1000.0)] {
        assert!(near(x, radius).refused(400).contains("a radius up to"));
    }
}

/// Against going through all points of all scans: a point of each cell that two scans have seen, and none of another.
#[test]
fn a_map_is_what_two_scans_have_seen() {
    let out = Out::new();
    let server = out.serve();
    let table = server.of_sequence(&format!("lidars/{LIDAR}/scans/1/around")).table();
    let recording = recording();
    let sequence = recording.sequences[0].sequence();
    let (times, mounted) = (&sequence.times.lidars[0], &sequence.rig.lidars[0].vehicle_from_lidar);
    let mut cells: BTreeMap<[i32; 3], BTreeMap<usize, Vec<Point>>> = BTreeMap::new();
    for (number, time) in times.iter().enumerate() {
        let moved = sequence.motion.between(times[1], *time);
        let points = recording.sequences[0].lidar_scan(0, number).unwrap().points;
        for point in points.iter().filter(|point| is_return(point)) {
            let place = moved * (mounted * Point::from(point.map(f64::from)));
            let cell: [i32; 3] = place.coords.map(|metres| (metres / 0.25).floor() as i32).into();
            cells.entry(cell).or_default().entry(number).or_default().push(place);
        }
    }
    cells.retain(|_, scans| scans.len() >= 2);
    assert_eq!(table.header["scans"], times.len());
    let [x, y, z] = ["x", "y", "z"].map(|name| table.f32(name));
    let near = |row: usize, place: &Point| {
        let apart = [x[row], y[row], z[row]].map(f64::from);
        (place - Point::from(apart)).norm() < 1e-3
    };
    let matched = |(row, scans): (usize, &BTreeMap<usize, Vec<Point>>)| {
        scans.values().flatten().any(|place| near(row, place))
    };
    // Both are in the order of cells.
    assert!(cells.len() > 100 && table.rows() == cells.len(), "{} of {}", table.rows(), cells.len());
    assert!(cells.values().enumerate().all(matched));
    assert!(
        server
            .of_sequence(&format!("lidars/{LIDAR}/scans/{}/around", times.len()))
            .refused(404)
            .contains(LIDAR)
    );
}

#[test]
fn a_moment_has_the_scans_around_it() {
    let out = Out::new();
    let server = out.serve();
    let times = recording().sequences[0].sequence().times.radars.clone();
    let ask = |query: &str| {
        let scans = server.of_sequence(&format!("moment?{query}")).json()["scans"].clone();
        let place =
            |scan: &Value| (scan["radar"].as_str().unwrap().to_owned(), scan["scan"].as_u64().unwrap());
        scans.as_array().unwrap().iter().map(place).collect::<Vec<_>>()
    };
    let front = |scan| (RADAR.to_owned(), scan);
    assert_eq!(ask(&format!("t_ns={}&radars={RADAR}", times[0][1] + 1)), [front(1)]);
    assert_eq!(ask(&format!("t_ns={}&accumulate=1&radars={RADAR}", times[0][2])), [front(1), front(2)]);
    assert_eq!(ask("t_ns=0&accumulate=100&radars=all").len(), 12);
    assert!(server.of_sequence("moment?t_ns=soon&radars=all").refused(400).contains("t_ns"));
    assert!(
        server.of_sequence("moment?t_ns=0&accumulate=101&radars=all").refused(400).contains("at most 100")
    );
    assert!(server.of_sequence("moment?t_ns=0&radars=other").refused(404).contains("`other`"));
    assert!(server.of_sequence("moment?t_ns=0").refused(400).contains("radars"));
}

#[test]
fn the_queue_begins_with_the_most_expected_errors() {
    let out = Out::new();
    let server = out.serve();
    let queue = server.of_sequence("queue").json();
    let scans = queue["scans"].as_array().unwrap();
    assert_eq!(
        queue["progress"],
        json!({ "scans": 12, "reviewed": 0, "corrected_detections": 0, "orphaned_scans": 0 })
    );
    let left = |scan: &Value| scan["expected_errors"].as_f64().unwrap();
    assert!(scans.is_sorted_by(|a, b| left(a) >= left(b)) && left(&scans[0]) > left(&scans[11]));
    let all = Rows::read(&out);
    let threshold = Config::default().fusion.threshold;
    for scan in scans {
        let number = scan["scan"].as_u64().unwrap() as usize;
        let rows: Vec<usize> =
            (0..all.w.len()).filter(|r| scan["radar"] == *all.radar[*r] && all.scan[*r] == number).collect();
        let on_floor = |row: &usize| all.flags[*row] & ralf::label::flag::GROUND != 0;
        let is_near = |row: &usize| (f64::from(all.w[*row]) - threshold).abs() <= 0.1;
        let doubt = |row: &usize| (1.0 - (f64::from(all.w[*row]) - threshold).abs() / 0.3).max(0.0);
        let expected: f64 = rows.iter().filter(|row| !on_floor(row)).map(doubt).sum();
        assert!((left(scan) - expected).abs() < 1e-3, "{} {expected}", left(scan));
        let uncertain = rows.iter().filter(|row| is_near(row) && !on_floor(row)).count();
        assert_eq!((&scan["detections"], &scan["uncertain"]), (&json!(rows.len()), &json!(uncertain)));
    }
    assert_eq!(server.of_sequence("queue").json(), queue, "asked again");
}

#[test]
fn every_column_says_what_it_means() {
    let out = Out::new();
    let header = out.serve().table(1).header;
    let column = |name: &str| {
        let columns = header["columns"].as_array().unwrap();
        columns.iter().find(|column| column["name"] == name).unwrap().clone()
    };
    for (name, unit, group) in [
        ("x", "m", "place"),
        ("doppler", "m/s", "measured"),
        ("d_lm", "", "mismatch"),
        ("w", "", "plausibility"),
    ] {
        let column = column(name);
        assert_eq!((&column["unit"], &column["group"]), (&json!(unit), &json!(group)), "{name}");
        assert!(!column["meaning"].as_str().unwrap().is_empty(), "{name}");
    }
}
