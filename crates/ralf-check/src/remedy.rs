//! What would put a fault right, in words and as settings that `ralf label` takes.

use crate::change::SensorChange;
use serde::Serialize;

/// Whose numbers are no positions, and of which nothing else can be asked, has one of these to be looked into.
pub(crate) const OTHER_TYPE: &str = "its file holds numbers of another type";
/// What nothing came back of, or nothing was detected in, has this.
pub(crate) const EMPTY_FILES: &str = "are its files empty, as of a copy that broke off?";
pub(crate) const OTHER_ORDER: &str =
    "the numbers of quaternions look like w, x, y, z: x, y, z, w are expected";
pub(crate) const OTHER_WAY: &str =
    "its mounting looks told the other way round: that of the vehicle in the sensor's frame";
/// Whose scans lie in another order than their times has one of these, and nothing else can be asked of it either.
pub(crate) const AS_TEXT: &str = "its scans look sorted by their numbers as text: 0, 1, 10, 11, 2";
pub(crate) const BACKWARDS: &str = "its scans look sorted backwards, the last one first";

/// The key of the angle at which a LiDAR's lowest beam looks down.
pub(crate) const LOWEST_BEAM: &str = "lowest_beam_deg";

/// A remedy. Angles in degrees, lengths in m, times in ms.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Remedy {
    /// The mounting or the clock, as a change.
    Sensor(SensorChange),
    /// The mounting or the clock of a camera: turns about its optical axes, x right, y down and z ahead.
    Camera(SensorChange),
    /// Its mounting is that of this sensor, and the other way round.
    SwapWith(String),
    /// x and y stand in each other's place. No setting puts it right: its field of view would lie aside.
    Exchanged,
    /// Range rates times this.
    Doppler(f64),
    /// Positions times this.
    Positions(f64),
    /// This field is in degrees.
    InDegrees(&'static str),
    /// This key's value is in radians, or what is measured asks for this value, degrees.
    Value {
        /// As in `sequence.toml`.
        key: &'static str,
        /// What it should be.
        value: f64,
    },
    /// Recorded speed times this.
    Speed(f64),
    /// Recorded yaw rate times this.
    YawRate(f64),
    /// Added to the motion's timestamps.
    MotionClock(f64),
    /// This, of the odometry that is recorded beside poses. Settings change both alike, so none puts it right.
    Odometry(Box<Self>),
    /// This, of poses. Settings turn none, and change odometry beside them alike, so none puts it right.
    Poses(Box<Self>),
    /// Something to look into that no setting puts right.
    LookInto(&'static str),
}

/// One setting: its key and value as TOML has them.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Setting {
    /// Dotted, as TOML has it.
    pub key: String,
    /// As TOML.
    pub value: String,
}

impl Remedy {
    /// For people, after the subject's name: `fits better with yaw -4.8 degrees`.
    pub fn words(&self) -> String {
        match self {
            Self::Sensor(change) => change_in_words(change),
            Self::Camera(change) => camera_in_words(change),
            Self::SwapWith(other) => format!("looks swapped with {other}"),
            Self::Exchanged => "x and y look exchanged".into(),
            Self::Doppler(factor) if *factor == -1.0 => "range rate has the other sign".into(),
            Self::Doppler(factor) => format!("range rate looks like {}", unit_of_speed(*factor)),
            Self::Positions(factor) => format!("positions look like {}", unit_of_length(*factor)),
            Self::InDegrees(field) => format!("{field} looks like degrees"),
            Self::Value { key, value } => format!("{key} should rather be {value:.2}"),
            Self::Speed(factor) if *factor == -1.0 => "speed has the other sign".into(),
            Self::Speed(factor) => format!("speed looks like {}", unit_of_speed(*factor)),
            Self::YawRate(factor) if *factor == -1.0 => "yaw rate has the other sign".into(),
            Self::YawRate(factor) if *factor < 1.0 => "yaw rate looks like deg/s".into(),
            Self::YawRate(factor) => format!("yaw rate fits better times {factor:.3}"),
            Self::MotionClock(ms) => lag(-ms),
            Self::Odometry(remedy) if matches!(**remedy, Self::MotionClock(_)) => {
                format!("odometry {}", remedy.words())
            }
            Self::Odometry(remedy) => format!("odometry's {}", remedy.words()),
            Self::Poses(remedy) if matches!(**remedy, Self::MotionClock(_)) => {
                format!("its poses' clock {}", remedy.words())
            }
            Self::Poses(remedy) => format!("poses' {}", remedy.words()),
            Self::LookInto(what) => (*what).to_owned(),
        }
    }

    /// The same of the motion as one of its poses alone.
    pub(crate) fn of_poses(self) -> Self {
        match self {
            Self::Speed(_) | Self::YawRate(_) | Self::MotionClock(_) => Self::Poses(Box::new(self)),
            other => other,
        }
    }

    /// As settings; none where settings can't put it right.
    pub fn settings(&self, subject: &str) -> Vec<Setting> {
        let subject = toml_key(subject);
        let of_sensor =
            |key: &str, value: String| Setting { key: format!("corrections.{subject}.{key}"), value };
        let of_rig =
            |key: &str, value: f64| Setting { key: format!("sensors.{subject}.{key}"), value: number(value) };
        let of_motion =
            |key: &str, value: f64| Setting { key: format!("motion.{key}"), value: number(value) };
        match self {
            Self::Sensor(change) | Self::Camera(change) => change_as_settings(change, of_sensor),
            Self::Doppler(factor) => vec![of_sensor("doppler_factor", number(*factor))],
            Self::Positions(factor) => vec![of_sensor("position_factor", number(*factor))],
            Self::Value { key, value } => vec![of_rig(key, *value)],
            Self::Speed(factor) => vec![of_motion("speed_factor", *factor)],
            Self::YawRate(factor) => vec![of_motion("yaw_rate_factor", *factor)],
            Self::MotionClock(ms) => vec![of_motion("time_offset_ms", *ms)],
            Self::SwapWith(_)
            | Self::Exchanged
            | Self::InDegrees(_)
            | Self::Odometry(_)
            | Self::Poses(_)
            | Self::LookInto(_) => Vec::new(),
        }
    }
}

/// A sensor's name as a key of TOML: in quotes where it holds more than letters, digits, `-` and `_`.
pub fn toml_key(name: &str) -> String {
    let is_bare = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'-' || byte == b'_';
    match !name.is_empty() && name.bytes().all(is_bare) {
        true => name.to_owned(),
        false => toml::Value::from(name).to_string(),
    }
}

/// A number as TOML has it: with a point.
fn number(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    if rounded == rounded.trunc() { format!("{rounded:.1}") } else { format!("{rounded}") }
}

fn lag(ms: f64) -> String {
    let way = if ms > 0.0 { "lags" } else { "runs ahead" };
    format!("{way} by {:.0} ms", ms.abs())
}

/// Turns as a person behind the camera has them.
fn camera_in_words(change: &SensorChange) -> String {
    let [pitch, yaw, roll] = change.turn_deg;
    let ways = [
        (yaw, "to the right", "to the left"),
        (pitch, "up", "down"),
        (roll, "clockwise", "counterclockwise"),
    ];
    for (degrees, positive, negative) in ways {
        if degrees != 0.0 {
            let way = if degrees > 0.0 { positive } else { negative };
            return format!("fits better when turned {way} by {:.1} degrees", degrees.abs());
        }
    }
    lag(-change.clock_ms)
}

fn change_in_words(change: &SensorChange) -> String {
    let mut parts = Vec::new();
    for (name, degrees) in ["roll", "pitch", "yaw"].iter().zip(change.turn_deg).rev() {
        if degrees != 0.0 {
            parts.push(format!("{name} {degrees:+.1} degrees"));
        }
    }
    for (name, metres) in ["forward", "left", "up"].iter().zip(change.shift_m) {
        if metres != 0.0 {
            parts.push(format!("{metres:+.2} m {name}"));
        }
    }
    let mut sentences = Vec::new();
    if !parts.is_empty() {
        sentences.push(format!("fits better with {}", parts.join(", ")));
    }
    if change.clock_ms != 0.0 {
        sentences.push(lag(-change.clock_ms));
    }
    if change.mirrored {
        sentences.push("y looks mirrored".into());
    }
    sentences.join(", ")
}

fn change_as_settings(change: &SensorChange, of_sensor: impl Fn(&str, String) -> Setting) -> Vec<Setting> {
    let mut settings = Vec::new();
    for (key, degrees) in ["add_roll_deg", "add_pitch_deg", "add_yaw_deg"].iter().zip(change.turn_deg).rev() {
        if degrees != 0.0 {
            settings.push(of_sensor(key, number(degrees)));
        }
    }
    if change.shift_m != [0.0; 3] {
        let [x, y, z] = change.shift_m.map(number);
        settings.push(of_sensor("add_translation", format!("[{x}, {y}, {z}]")));
    }
    if change.clock_ms != 0.0 {
        settings.push(of_sensor("time_offset_ms", number(change.clock_ms)));
    }
    if change.mirrored {
        settings.push(of_sensor("mirror_y", "true".into()));
    }
    settings
}

/// Units by what they are in m/s or m.
fn unit(factor: f64, units: &[(f64, &'static str)]) -> String {
    let known = units.iter().find(|(value, _)| (factor / value - 1.0).abs() < 0.05);
    known.map_or_else(|| format!("its value over {:.3}", 1.0 / factor), |(_, name)| (*name).to_owned())
}

fn unit_of_speed(factor: f64) -> String {
    unit(factor, &SPEEDS)
}

fn unit_of_length(factor: f64) -> String {
    unit(factor, &[&LENGTHS[..], &OTHER_LENGTHS].concat())
}

/// Units that speeds are given in by mistake, in m/s.
pub(crate) const SPEEDS: [(f64, &str); 7] = [
    (1.0 / 3.6, "km/h"),
    (0.01, "cm/s"),
    (0.001, "mm/s"),
    (0.447, "mph"),
    (3.6, "m/s that were divided by 3.6 again"),
    (100.0, "hundreds of m/s"),
    (0.514, "knots"),
];

/// Units that positions are given in by mistake, in m.
pub(crate) const LENGTHS: [(f64, &str); 4] = [(0.01, "cm"), (0.001, "mm"), (0.3048, "feet"), (1000.0, "km")];

/// Factors of positions that are no other unit's, in m.
const OTHER_LENGTHS: [(f64, &str); 3] = [
    (0.5, "twice the range: there and back"),
    (2.0, "half the range: there or back"),
    (1.0 / 0.3048, "m that were taken for feet"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn remedies_are_said_in_words_and_as_settings() {
        let yaw = Remedy::Sensor(SensorChange::yaw(-4.8));
        assert_eq!(yaw.words(), "fits better with yaw -4.8 degrees");
        assert_eq!(yaw.settings("radar_left")[0].key, "corrections.radar_left.add_yaw_deg");
        assert_eq!(yaw.settings("radar_left")[0].value, "-4.8");
        let late = Remedy::Sensor(SensorChange::clock(-180.0));
        assert_eq!(late.words(), "lags by 180 ms");
        assert_eq!(late.settings("a")[0].value, "-180.0");
        assert_eq!(Remedy::Speed(1.0 / 3.6).words(), "speed looks like km/h");
        assert_eq!(Remedy::Positions(0.01).words(), "positions look like cm");
        assert_eq!(Remedy::YawRate(1.0_f64.to_radians()).words(), "yaw rate looks like deg/s");
        assert_eq!(Remedy::Sensor(SensorChange::mirror()).words(), "y looks mirrored");
        assert_eq!(Remedy::MotionClock(200.0).words(), "runs ahead by 200 ms");
        let of_odometry = Remedy::Odometry(Box::new(Remedy::Speed(1.0 / 3.6)));
        assert_eq!(of_odometry.words(), "odometry's speed looks like km/h");
        assert_eq!(of_odometry.settings("motion"), []);
    }

    #[test]
    fn settings_of_a_sensor_of_any_name_are_read_back_as_its_own() {
        for name in ["radar_left", "front left", "front.left", "vorn \"links\"", "größer", "a'b", "7"] {
            let Setting { key, value } = &Remedy::Sensor(SensorChange::yaw(-4.8)).settings(name)[0];
            let read: toml::Table = format!("{key} = {value}").parse().unwrap();
            assert_eq!(read["corrections"][name]["add_yaw_deg"].as_float(), Some(-4.8), "{key}");
        }
    }
}
