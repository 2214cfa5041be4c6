//! Whole pictures: their size, that the same data give the same bytes, and that odd data are drawn all the same.

use std::error::Error;

use ralf_plot::{
    Extent, Mark, MarkLabel, OverviewPicture, PlotError, RadarMount, ScanPicture, overview_picture,
    scan_picture,
};
use tiny_skia::Pixmap;

fn mark(x: f64, y: f64) -> Mark {
    let label = if (x + y) as i64 % 3 == 0 { MarkLabel::Plausible } else { MarkLabel::Artifact };
    Mark { x, y, label }
}

fn spiral(count: u32, radius: f64) -> Vec<[f64; 2]> {
    let place = |index: u32| {
        let part = f64::from(index) / f64::from(count);
        [radius * part * (300.0 * part).cos(), radius * part * (300.0 * part).sin()]
    };
    (0..count).map(place).collect()
}

fn both(places: &[[f64; 2]], extent: Extent, width: u32) -> Result<[Pixmap; 2], Box<dyn Error>> {
    let marks: Vec<Mark> = places.iter().map(|[x, y]| mark(*x, *y)).collect();
    let radars = [RadarMount { x: 3.6, y: 0.0, azimuth: 0.0, fov: 1.5 }];
    let scan = ScanPicture {
        title: "radar_front",
        subtitle: "scan 000142",
        width,
        extent,
        marks: &marks,
        lidar: places,
        path: places,
        radars: &radars,
        ..ScanPicture::default()
    };
    let sequence = OverviewPicture {
        title: "sequence",
        half_width: width,
        extent,
        marks: &marks,
        path: places,
        lidar: places,
        ..OverviewPicture::default()
    };
    let (scan, sequence) = (scan_picture(&scan)?, overview_picture(&sequence)?);
    Ok([Pixmap::decode_png(&scan)?, Pixmap::decode_png(&sequence)?])
}

#[test]
fn pictures_have_the_width_asked_for() {
    for width in [200, 333, 1600] {
        let [scan, sequence] = both(&spiral(300, 60.0), Extent::Fit, width).unwrap();
        assert_eq!([scan.width(), sequence.width()], [width, 2 * width]);
        assert!(scan.height() > width && scan.height() < 2 * width);
    }
}

#[test]
fn the_same_data_give_the_same_bytes() {
    let marks: Vec<Mark> = spiral(4000, 120.0).iter().map(|[x, y]| mark(*x, *y)).collect();
    let scan = ScanPicture { title: "scan", marks: &marks, width: 500, ..ScanPicture::default() };
    assert_eq!(scan_picture(&scan).unwrap(), scan_picture(&scan).unwrap());
    let sequence =
        OverviewPicture { title: "all", marks: &marks, half_width: 500, ..OverviewPicture::default() };
    assert_eq!(overview_picture(&sequence).unwrap(), overview_picture(&sequence).unwrap());
}

#[test]
fn odd_data_are_drawn_all_the_same() {
    let nan = f64::NAN;
    let (far, huge) = ([-5.0e5, 5.4e6], [f64::MAX, -f64::MAX]);
    let cases: [&[[f64; 2]]; 7] = [
        &[],
        &[[3.0, 4.0]],
        &[[nan, 1.0], [1.0, nan], [f64::INFINITY, 0.0]],
        &[[nan, nan], [5.0, 5.0], huge],
        &[[0.0, 0.0]; 50],
        &[far, far, [far[0] + 30.0, far[1]]],
        &[[1e8, -1e8], [-1e8, 1e8]],
    ];
    for places in cases {
        for extent in [Extent::Fit, Extent::Radius(5.0), Extent::Radius(2000.0), Extent::Radius(0.01)] {
            let [scan, sequence] = both(places, extent, 300).unwrap();
            assert!(scan.height() < 700 && sequence.height() < 700, "{places:?} {extent:?}");
        }
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let narrow = ScanPicture { width: 20, ..ScanPicture::default() };
    assert_eq!(scan_picture(&narrow), Err(PlotError::Width { least: 200, most: 10_000, found: 20 }));
    let wide = OverviewPicture { half_width: 10_001, ..OverviewPicture::default() };
    assert!(matches!(overview_picture(&wide), Err(PlotError::Width { found: 10_001, .. })));
    // A picture of a thousandth of a mm had made the rasteriser panic.
    for radius in [0.0, 1e-30, 1e-6] {
        let flat = OverviewPicture { extent: Extent::Radius(radius), ..OverviewPicture::default() };
        assert!(matches!(overview_picture(&flat), Err(PlotError::Radius { .. })));
    }
}
