//! Which values of a scenario exist in the world.

use super::{CameraFailure, Drive, Leg, Scenario, ScenarioError, Thing};
use crate::kind::Kind;
use crate::vehicle::rig;

/// The vehicle stays below this, km/h. Those of the presets stay below 10 km/h, as in the paper.
const MAX_SPEED_KMH: f64 = 130.0;

/// No part of a way is shorter, m.
const SHORTEST_LEG: f64 = 0.01;
/// No turn is tighter, m, nor over sooner, s: odometry tells of it in some ten samples.
const TIGHTEST_TURN: f64 = 1.0;
const SOONEST_TURN_S: f64 = 0.2;

/// No row of things is longer.
const MOST: usize = 1000;
/// So many things of a row may lie over one another: that more are in one place is a mistake, and each ray meets all.
const MOST_OVERLAPPING: f64 = 10.0;
/// What all things together may fill, by [`Thing::bulk`]: each m3 is some scatterers, and all are kept in memory.
const LARGEST_BULK: f64 = 1e6;
/// Nothing lies farther from the site's origin, m.
const FARTHEST: f64 = 1e5;
/// From here on a number is told by its power of ten, and not by hundreds of digits.
const LARGE: f64 = 1e9;

impl Thing {
    /// How much room it takes, of a row all of it: volume, with what walls and edges count for, in m3 or so.
    fn bulk(&self) -> f64 {
        let [length, width, height] = self.size.unwrap_or_else(|| self.kind.usual_size());
        self.count as f64 * (length * width * height.max(1.0) + 20.0 * (length + width))
    }

    /// How far apart those of a row have to be at least, m, so that few lie over one another.
    fn least_step(&self) -> f64 {
        let [length, width, _] = self.size.unwrap_or_else(|| self.kind.usual_size());
        if self.count as f64 > MOST_OVERLAPPING { length.max(width) / MOST_OVERLAPPING } else { 0.0 }
    }
}

impl Scenario {
    /// Refuses values that don't exist in the world.
    pub fn check(&self) -> Result<(), ScenarioError> {
        self.check_drive()?;
        self.failure.iter().try_for_each(CameraFailure::check)?;
        self.check_things()?;
        let slope = self.ramp.iter().find(|ramp| ramp.slope_deg.is_nan() || ramp.slope_deg.abs() > 30.0);
        if let Some(ramp) = slope {
            return refuse("ramp.slope_deg", "a slope of 30 degrees at most", ramp.slope_deg);
        }
        if let Some(ramp) = self.ramp.iter().find(|ramp| ramp.length.is_nan() || ramp.length <= 0.0) {
            return refuse("ramp.length", "a length above 0 m", ramp.length);
        }
        match self.places().find(|(_, value)| value.is_nan() || value.abs() > FARTHEST) {
            Some((key, value)) => refuse(key, "a number from -100000 to 100000", value),
            None => self.check_turns(),
        }
    }

    fn check_drive(&self) -> Result<(), ScenarioError> {
        let Drive { speed_kmh, leg, .. } = &self.ego;
        if !(self.plausible_share > 0.0 && self.plausible_share < 1.0) {
            return refuse("plausible_share", "a share between 0 and 1", self.plausible_share);
        }
        if !(*speed_kmh > 0.0 && *speed_kmh < MAX_SPEED_KMH) {
            return refuse("ego.speed_kmh", "a speed above 0 and below 130 km/h", *speed_kmh);
        }
        let is_no_length = |leg: &&Leg| !(leg.length >= SHORTEST_LEG && leg.length.is_finite());
        match leg.iter().find(is_no_length) {
            Some(leg) => refuse("ego.leg.length", "a length of 0.01 m or more", leg.length),
            None => Ok(()),
        }
    }

    fn check_turns(&self) -> Result<(), ScenarioError> {
        let Drive { speed_kmh, leg, .. } = &self.ego;
        let soonest = SOONEST_TURN_S * speed_kmh / 3.6;
        let least = |leg: &Leg| soonest.max(TIGHTEST_TURN * leg.turn_deg.abs().to_radians());
        match leg.iter().find(|leg| leg.turn_deg != 0.0 && leg.length < least(leg)) {
            Some(leg) => {
                let expected =
                    format!("{:.2} m or more for a turn of {} degrees", least(leg), short(leg.turn_deg));
                refuse("ego.leg.length", &expected, leg.length)
            }
            None => Ok(()),
        }
    }

    fn check_things(&self) -> Result<(), ScenarioError> {
        let sizes = self.thing.iter().filter_map(|thing| thing.size).flatten();
        if let Some(size) = sizes.into_iter().find(|size| !(*size > 0.0 && size.is_finite())) {
            return refuse("thing.size", "lengths above 0 m", size);
        }
        let is_oval = |thing: &&Thing| thing.size.is_some_and(|[length, width, _]| length != width);
        let is_round = |thing: &&Thing| matches!(thing.kind, Kind::Pole | Kind::Pedestrian);
        if let Some(thing) = self.thing.iter().filter(is_round).find(is_oval) {
            let [length, width, _] = thing.size.unwrap_or_default();
            let expected = format!("a width that is the length, {length} m, of what is round");
            return refuse("thing.size", &expected, width);
        }
        if let Some(thing) = self.thing.iter().find(|thing| !(1..=MOST).contains(&thing.count)) {
            return refuse("thing.count", "1 to 1000", thing.count as f64);
        }
        let step = |thing: &Thing| thing.step[0].hypot(thing.step[1]);
        if let Some(thing) = self.thing.iter().find(|thing| step(thing) < thing.least_step()) {
            let expected =
                format!("{:.3} m or more from one to the next of {}", thing.least_step(), thing.count);
            return refuse("thing.step", &expected, step(thing));
        }
        let bulk: f64 = self.thing.iter().map(Thing::bulk).sum();
        if bulk > LARGEST_BULK {
            return refuse("thing.size", "things that fill a few streets, in all", bulk);
        }
        Ok(())
    }

    /// Every number that says where something is, or where it points, with its key.
    fn places(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let pairs = self.thing.iter().flat_map(|thing| {
            [("thing.at", thing.at), ("thing.step", thing.step), ("thing.velocity", thing.velocity)]
        });
        let pairs = pairs.chain(self.ramp.iter().map(|ramp| ("ramp.at", ramp.at)));
        let yaws = self.thing.iter().map(|thing| ("thing.yaw_deg", thing.yaw_deg));
        let turns = self.ego.leg.iter().map(|leg| ("ego.leg.turn_deg", leg.turn_deg));
        let ramps = self
            .ramp
            .iter()
            .flat_map(|ramp| [("ramp.direction_deg", ramp.direction_deg), ("ramp.length", ramp.length)]);
        let start = self.ego.start.map(|value| ("ego.start", value));
        let pairs = pairs.flat_map(|(key, pair)| pair.map(|value| (key, value)));
        pairs.chain(yaws).chain(turns).chain(ramps).chain(start)
    }
}

impl CameraFailure {
    /// Refuses a failure that happens to no camera, or never.
    fn check(&self) -> Result<(), ScenarioError> {
        let names: Vec<String> = rig().cameras.into_iter().map(|camera| camera.name).collect();
        if !names.contains(&self.camera) {
            let expected = format!("one of {}", names.join(", "));
            return Err(ScenarioError::Value { key: "failure.camera", expected, found: self.camera.clone() });
        }
        if self.from_s.is_nan() {
            return refuse("failure.from_s", "a time, s after the start", self.from_s);
        }
        if self.until_s > self.from_s {
            return Ok(());
        }
        let expected = format!("a time after failure.from_s, which is {}", short(self.from_s));
        Err(ScenarioError::Value { key: "failure.until_s", expected, found: short(self.until_s) })
    }
}

fn refuse(key: &'static str, expected: &str, found: f64) -> Result<(), ScenarioError> {
    Err(ScenarioError::Value { key, expected: expected.to_owned(), found: short(found) })
}

fn short(value: f64) -> String {
    if value.is_finite() && value.abs() >= LARGE { format!("{value:e}") } else { value.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn refused(ego: &str, rest: &str, told: &str) {
        let text = format!("title = 'x'\n{rest}\nego = {{ start = [0, 0, 0], speed_kmh = 7{ego} }}");
        let error = Scenario::from_toml(&text).unwrap_err().to_string();
        assert_eq!(error, told);
    }

    #[test]
    fn a_failure_of_no_camera_or_at_no_time_is_refused() {
        let failure = |camera: &str, from: &str, until: &str| {
            format!(
                "failure = [{{ camera = '{camera}', kind = 'dark', from_s = {from}, until_s = {until} }}]"
            )
        };
        let cameras = "camera_front, camera_left, camera_right, camera_rear";
        refused(
            "",
            &failure("nosuch", "0", "1"),
            &format!("failure.camera: expected one of {cameras}, found nosuch"),
        );
        for (from, until) in [("2", "1"), ("2", "2"), ("2", "nan")] {
            let told = format!(
                "failure.until_s: expected a time after failure.from_s, which is 2, found {}",
                until.replace("nan", "NaN")
            );
            refused("", &failure("camera_front", from, until), &told);
        }
        let told = "failure.from_s: expected a time, s after the start, found NaN";
        refused("", &failure("camera_front", "nan", "1"), told);
    }

    #[test]
    fn a_row_that_is_in_one_place_is_refused() {
        let row = |count: usize, step: &str| {
            format!("thing = [{{ kind = 'car', at = [5, 5], count = {count}{step} }}]")
        };
        let told = |count: usize, found: &str| {
            format!("thing.step: expected 0.440 m or more from one to the next of {count}, found {found}")
        };
        refused("", &row(1000, ""), &told(1000, "0"));
        refused("", &row(11, ", step = [0.3, 0.0]"), &told(11, "0.3"));
        for fine in [row(10, ""), row(1000, ", step = [0.0, -0.5]")] {
            let text = format!("title = 'x'\n{fine}\nego = {{ start = [0, 0, 0], speed_kmh = 7 }}");
            Scenario::from_toml(&text).unwrap();
        }
    }

    /// Odometry tells how fast a vehicle turns at moments: of a turn between two of them it would know nothing.
    #[test]
    fn a_turn_on_the_spot_is_refused() {
        let leg = |length: &str, turn: &str| format!(", leg = [{{ length = {length}, turn_deg = {turn} }}]");
        let told = |least: &str, turn: &str, found: &str| {
            format!("ego.leg.length: expected {least} m or more for a turn of {turn} degrees, found {found}")
        };
        refused(&leg("0.05", "90"), "", &told("1.57", "90", "0.05"));
        refused(&leg("1.5", "-90"), "", &told("1.57", "-90", "1.5"));
        refused(&leg("0.3", "1"), "", &told("0.39", "1", "0.3"));
        let told = "ego.leg.length: expected a length of 0.01 m or more, found ";
        refused(&leg("1e-320", "0"), "", &format!("{told}{}", 1e-320));
        for fine in [leg("1.6", "90"), leg("0.05", "0"), leg("0.4", "-1")] {
            let text = format!("title = 'x'\nego = {{ start = [0, 0, 0], speed_kmh = 7{fine} }}");
            Scenario::from_toml(&text).unwrap();
        }
    }

    #[test]
    fn what_is_round_has_one_width_and_usual_sizes_count() {
        let thing = |kind: &str, more: &str| format!("thing = [{{ kind = '{kind}', at = [5, 5]{more} }}]");
        let told = "thing.size: expected a width that is the length, 0.2 m, of what is round, found 3";
        refused("", &thing("pole", ", size = [0.2, 3, 4]"), told);
        let rows = ", count = 1000, step = [20, 0]";
        let told = "thing.size: expected things that fill a few streets, in all, found 1740000";
        for size in ["", ", size = [14, 10, 9]"] {
            refused("", &thing("building", &format!("{rows}{size}")), told);
        }
    }

    #[test]
    fn a_place_far_off_is_named_by_its_key_in_few_digits() {
        for (key, thing) in [
            ("at", "at = [0, 1e300]"),
            ("step", "at = [0, 0], step = [1e300, 0]"),
            ("yaw_deg", "at = [0, 0], yaw_deg = 1e300"),
        ] {
            let told = format!("thing.{key}: expected a number from -100000 to 100000, found 1e300");
            refused("", &format!("thing = [{{ kind = 'pole', {thing} }}]"), &told);
        }
        let far = ", leg = [{ length = 5, turn_deg = 100001 }]";
        refused(far, "", "ego.leg.turn_deg: expected a number from -100000 to 100000, found 100001");
        let ramp = "ramp = [{ at = [0, 0], direction_deg = 0, length = -3, slope_deg = 2 }]";
        refused("", ramp, "ramp.length: expected a length above 0 m, found -3");
        let ramp = "ramp = [{ at = [0, 0], direction_deg = nan, length = 3, slope_deg = 2 }]";
        refused("", ramp, "ramp.direction_deg: expected a number from -100000 to 100000, found NaN");
    }
}
