//! The families: in what each differs from the usual.

use super::mounts::{
    AHEAD, AROUND, CORNERS, FIVE, FRONT_REAR, ONE, ROOF_16, ROOF_32, ROOF_40, ROOF_64, ROOF_64_EVEN,
    ROOF_128, ROOF_128_WIDE, ROOF_AND_CORNERS, SIDES, SIX, TWO,
};
use super::ranges::{
    CalibrationRanges, Family, LidarRanges, MotionRanges, PlaceKind, RadarRanges, WaveRanges,
};
use super::usual::{CALIBRATION, LIDARS, MOTION, RADARS, WAVES};
use crate::world::radar::Keeps;
use crate::world::span::span;

/// All families, by their numbers.
pub const FAMILIES: [Family; 8] = [
    Family {
        name: "city",
        about: "4D radars on all sides, a roof LiDAR of 32 to 64 beams, streets and crossings",
        radars: RADARS,
        waves: WAVES,
        lidars: LIDARS,
        places: &[
            (PlaceKind::Street, 2.0),
            (PlaceKind::Crossing, 2.0),
            (PlaceKind::Residential, 1.0),
            (PlaceKind::Tunnel, 0.5),
        ],
        motion: MOTION,
        calibration: CALIBRATION,
    },
    Family {
        name: "survey",
        about: "five sparse radars without elevation, as in nuScenes, and 32 beams at 20 Hz",
        radars: RadarRanges {
            layouts: &[FIVE],
            elevation: 0.0,
            // Continental ARS 408-21: 120 degrees near, 18 far.
            fov_azimuth: span(90.0, 120.0),
            fov_elevation: span(14.0, 20.0),
            rate: span(13.0, 14.0),
            // Measured, nuScenes: a scan is full (125) more often than not, its detections are 50 m away (median), and
            // -4.5 dBsm are heard at 100 to 140 m: 10 dBsm would be 13 dB above noise at 260 m.
            car_range: span(160.0, 280.0),
            // Measured, nuScenes: 95 % within 91 to 108 m, the farthest at 193 m.
            max_range: span(100.0, 190.0),
            // ARS 408-21: 0.39 m near, 1.79 m far; angles 3.2 to 12.3 degrees near; 0.37 km/h.
            range_cell: span(0.39, 1.2),
            azimuth_cell: span(3.2, 6.0),
            doppler_cell: span(0.1, 0.3),
            accuracy: span(0.15, 0.3),
            // Measured, nuScenes: 125 wherever there is enough to see.
            room: span(80.0, 125.0),
            // Measured, nuScenes: 5 % of what stands still lies below -4.5 dBsm near by and below -2.5 beyond 100 m.
            keeps: &[(Keeps::Largest, 1.0)],
            least_rcs: span(-9.0, -2.0),
            false_alarms: span(0.5, 30.0),
            side_lobe: span(13.0, 22.0),
            ..RADARS
        },
        waves: WaveRanges {
            asphalt: span(-28.0, -14.0),
            spike_mean: span(-36.0, 0.0),
            spike_scale: span(-1.0, 7.0),
            lumps: span(0.02, 0.1),
            mirror_loss: span(1.0, 6.0),
            ..WAVES
        },
        lidars: LidarRanges { layouts: &[ROOF_32], rate: span(20.0, 20.0), ..LIDARS },
        places: &[(PlaceKind::Street, 2.0), (PlaceKind::Crossing, 2.0), (PlaceKind::CarPark, 1.0)],
        motion: MotionRanges { speed: span(0.6, 1.4), ..MOTION },
        calibration: CalibrationRanges { poses: 1.0, drift: span(0.0, 0.003), ..CALIBRATION },
    },
    Family {
        name: "motorway",
        about: "long range ahead and behind at up to 35 m/s, guard rails, a LiDAR that turns while the world moves",
        radars: RadarRanges {
            layouts: &[FRONT_REAR, FRONT_REAR, SIX],
            elevation: 0.7,
            // Measured, aiMotive: azimuths within 17, elevations within 7.8 degrees to a side.
            fov_azimuth: span(30.0, 90.0),
            fov_elevation: span(12.0, 18.0),
            rate: span(15.0, 18.2),
            // Measured, aiMotive: at 150 m -0.5 dBsm are 14.5 dB above noise, as 10 dBsm would be at 300 m.
            car_range: span(160.0, 320.0),
            // Measured, aiMotive: 13 to 180 m.
            max_range: span(150.0, 200.0),
            range_cell: span(0.4, 1.5),
            azimuth_cell: span(1.5, 4.0),
            elevation_cell: span(3.0, 6.0),
            // Measured, aiMotive: 5 % are off by 32 to 33.4 m/s.
            doppler_interval: span(55.0, 90.0),
            doppler_failure: span(0.03, 0.3),
            // Measured, aiMotive: 26 to 55 in a scan; radars of the next generation give hundreds.
            room: span(40.0, 240.0),
            keeps: &[(Keeps::Largest, 0.7), (Keeps::Clearest, 0.3)],
            // Measured, aiMotive: 5 % lie below -7 to -4 dBsm from 20 to 140 m.
            least_rcs: span(-16.0, -2.0),
            false_alarms: span(0.5, 30.0),
            side_lobe: span(13.0, 22.0),
            ..RADARS
        },
        waves: WaveRanges {
            asphalt: span(-36.0, -24.0),
            spike_mean: span(-40.0, 3.0),
            spike_scale: span(-3.0, 8.0),
            mirror_loss: span(1.0, 6.0),
            interference: span(0.0, 0.1),
            ..WAVES
        },
        lidars: LidarRanges { layouts: &[ROOF_128, ROOF_64], rolling: 0.9, ..LIDARS },
        places: &[(PlaceKind::Motorway, 4.0), (PlaceKind::Country, 1.0), (PlaceKind::Tunnel, 0.8)],
        motion: MotionRanges { speed: span(0.7, 1.1), standing: 0.03, reversing: 0.0, ..MOTION },
        calibration: CALIBRATION,
    },
    Family {
        name: "carpark",
        about: "short range at walking speed, standing and reversing, between cars that one sees into; small LiDARs",
        radars: RadarRanges {
            layouts: &[CORNERS, SIDES, SIX],
            elevation: 0.6,
            fov_azimuth: span(130.0, 160.0),
            fov_elevation: span(16.0, 40.0),
            rate: span(15.0, 20.0),
            car_range: span(40.0, 80.0),
            max_range: span(30.0, 60.0),
            range_cell: span(0.08, 0.25),
            azimuth_cell: span(2.0, 6.0),
            elevation_cell: span(4.0, 10.0),
            room: span(150.0, 400.0),
            side_lobe: span(13.0, 22.0),
            ..RADARS
        },
        waves: WaveRanges {
            asphalt: span(-26.0, -15.0),
            spike_mean: span(-38.0, 3.0),
            // Sheet metal of cars' sides, close by.
            mirror_loss: span(0.5, 4.0),
            bumper: span(1.0, 5.0),
            ..WAVES
        },
        lidars: LidarRanges {
            layouts: &[AROUND, ROOF_AND_CORNERS, ROOF_16],
            glass: span(0.5, 0.95),
            ..LIDARS
        },
        places: &[(PlaceKind::CarPark, 4.0), (PlaceKind::Residential, 1.0), (PlaceKind::Industrial, 1.0)],
        motion: MotionRanges { speed: span(0.3, 1.0), standing: 0.2, reversing: 0.3, ..MOTION },
        calibration: CALIBRATION,
    },
    Family {
        name: "imaging",
        about: "one 4D radar and 64 beams, as in View-of-Delft: grass, hedges, cyclists",
        radars: RadarRanges {
            layouts: &[ONE],
            fov_azimuth: span(100.0, 120.0),
            rate: span(10.0, 13.0),
            // Measured, View-of-Delft: half of the detections within 23 m, the farthest at 100 m; -20 dBsm are heard at
            // 80 to 100 m, by its own calibration. How far that is off is chosen.
            car_range: span(80.0, 240.0),
            max_range: span(80.0, 105.0),
            range_cell: span(0.1, 0.3),
            azimuth_cell: span(1.0, 2.2),
            // Measured, View-of-Delft: half of the detections have another within 0.8 m, 5 % within 12 cm.
            grouping: span(0.5, 1.5),
            elevation_cell: span(1.5, 4.0),
            // Measured, View-of-Delft: cross-sections from -39 to 4 dBsm (5 to 95 %): a low threshold.
            threshold: span(9.0, 12.0),
            // Measured, View-of-Delft: 322 detections in a scan.
            room: span(250.0, 450.0),
            // A low threshold lets more of the noise pass.
            false_alarms: span(1.0, 150.0),
            ..RADARS
        },
        waves: WaveRanges {
            asphalt: span(-27.0, -16.0),
            spike_mean: span(-38.0, 1.0),
            strength: span(-8.0, 0.0),
            ..WAVES
        },
        lidars: LidarRanges { layouts: &[ROOF_64], sigma: span(0.015, 0.03), rolling: 0.0, ..LIDARS },
        places: &[(PlaceKind::Residential, 2.0), (PlaceKind::Street, 2.0), (PlaceKind::Country, 1.0)],
        motion: MotionRanges { speed: span(0.4, 0.9), traffic: span(0.6, 2.5), ..MOTION },
        calibration: CalibrationRanges { poses: 1.0, angle: span(0.05, 0.3), ..CALIBRATION },
    },
    Family {
        name: "yard",
        about: "sparse arrays with high side lobes and ambiguities among halls, containers and lorries",
        radars: RadarRanges {
            layouts: &[TWO, SIDES, FRONT_REAR],
            elevation: 0.8,
            fov_azimuth: span(90.0, 150.0),
            car_range: span(60.0, 140.0),
            max_range: span(60.0, 120.0),
            azimuth_cell: span(0.8, 2.5),
            side_lobe: span(9.0, 18.0),
            // So few elements leave no room above the lobes: chosen.
            accepted: span(0.0, 6.0),
            angle_failure: span(0.1, 0.35),
            // A cascade of chips with long chirps: the interval shrinks to a few tens of m/s.
            doppler_interval: span(20.0, 60.0),
            room: span(200.0, 800.0),
            ..RADARS
        },
        waves: WaveRanges { mirror_loss: span(1.0, 6.0), interference: span(0.0, 0.15), ..WAVES },
        lidars: LidarRanges { layouts: &[AHEAD, ROOF_128_WIDE, ROOF_64_EVEN], ..LIDARS },
        places: &[(PlaceKind::Industrial, 4.0), (PlaceKind::CarPark, 1.0)],
        motion: MotionRanges { standing: 0.15, reversing: 0.15, ..MOTION },
        calibration: CalibrationRanges { wheels: span(-0.02, 0.02), ..CALIBRATION },
    },
    Family {
        name: "country",
        about: "hills, banks, gravel, grass and trees, sometimes rain; one radar and 16 or 32 beams",
        radars: RadarRanges {
            layouts: &[ONE, FRONT_REAR, TWO],
            elevation: 0.4,
            fov_azimuth: span(60.0, 120.0),
            car_range: span(80.0, 160.0),
            max_range: span(80.0, 160.0),
            azimuth_cell: span(1.5, 5.0),
            room: span(100.0, 300.0),
            ..RADARS
        },
        waves: WaveRanges {
            // Dry grass and soil: less than in town, or grass alone would be heard.
            asphalt: span(-36.0, -26.0),
            spike_mean: span(-38.0, 1.0),
            texture: span(5.0, 9.0),
            mirror_loss: span(1.0, 7.0),
            strength: span(-9.0, 1.0),
            rain: 0.4,
            ..WAVES
        },
        lidars: LidarRanges { layouts: &[ROOF_16, ROOF_32], lost: span(0.0, 0.15), ..LIDARS },
        places: &[(PlaceKind::Country, 4.0), (PlaceKind::Residential, 1.0)],
        motion: MotionRanges { slope: span(2.0, 9.0), traffic: span(0.2, 1.0), ..MOTION },
        calibration: CALIBRATION,
    },
    Family {
        name: "anything",
        about: "all places and sensors, each range as wide as that of the other families together",
        radars: RadarRanges {
            layouts: &[ONE, FRONT_REAR, SIDES, CORNERS, FIVE, SIX, TWO],
            elevation: 0.6,
            fov_azimuth: span(30.0, 160.0),
            fov_elevation: span(12.0, 40.0),
            rate: span(10.0, 20.0),
            car_range: span(50.0, 200.0),
            max_range: span(40.0, 190.0),
            range_cell: span(0.1, 1.2),
            azimuth_cell: span(0.8, 6.0),
            elevation_cell: span(1.5, 10.0),
            doppler_cell: span(0.06, 0.35),
            accuracy: span(0.1, 0.35),
            threshold: span(9.0, 15.0),
            doppler_interval: span(25.0, 140.0),
            doppler_failure: span(0.0, 0.3),
            side_lobe: span(10.0, 26.0),
            angle_failure: span(0.02, 0.35),
            room: span(50.0, 600.0),
            least_rcs: span(-60.0, -4.0),
            // A threshold of 9 dB above noise lets 36 of a hundred thousand cells pass, and a scan may have a million.
            false_alarms: span(0.5, 300.0),
            ..RADARS
        },
        waves: WaveRanges {
            asphalt: span(-36.0, -17.0),
            texture: span(4.0, 9.0),
            mirror_loss: span(0.5, 12.0),
            strength: span(-8.0, 4.0),
            interference: span(0.0, 0.15),
            bumper: span(0.0, 5.0),
            rain: 0.2,
            ..WAVES
        },
        lidars: LidarRanges {
            layouts: &[
                ROOF_16,
                ROOF_32,
                ROOF_40,
                ROOF_64,
                ROOF_64_EVEN,
                ROOF_128,
                ROOF_128_WIDE,
                AHEAD,
                ROOF_AND_CORNERS,
                AROUND,
            ],
            rate: span(10.0, 20.0),
            sigma: span(0.01, 0.06),
            lost: span(0.0, 0.15),
            glass: span(0.2, 0.95),
            ..LIDARS
        },
        places: &[
            (PlaceKind::Street, 1.0),
            (PlaceKind::Crossing, 1.0),
            (PlaceKind::Residential, 1.0),
            (PlaceKind::CarPark, 1.0),
            (PlaceKind::Industrial, 1.0),
            (PlaceKind::Motorway, 1.0),
            (PlaceKind::Country, 1.0),
            (PlaceKind::Tunnel, 1.0),
        ],
        motion: MotionRanges {
            speed: span(0.3, 1.3),
            standing: 0.1,
            reversing: 0.1,
            slope: span(0.0, 7.0),
            ..MOTION
        },
        calibration: CALIBRATION,
    },
];
