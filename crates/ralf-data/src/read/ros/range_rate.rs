//! Which field of a radar tells its range rate, where none is called `doppler`.

use super::topics::TopicConfig;
use ralf::scene::Doppler;

/// What drivers of radars, and of nothing else, call a raw range rate, in whatever capitals: those that mean nothing
/// else first.
pub(super) const OF_RADARS: [&str; 10] = [
    "doppler_velocity",
    "radial_velocity",
    "radial_speed",
    "range_rate",
    "v_r",
    "vr",
    "v_doppler_mps",
    "v_doppler",
    "radar_relative_radial_velocity",
    "velocity",
];
/// What some call it in a cloud that is known for a radar's.
const SHORT: &str = "v";

/// The field of a radar that looks like a raw range rate, where none is called as such a one.
pub(super) fn find(fields: &[String]) -> Option<&str> {
    let is_told = |name: &String| [Doppler::RAW, Doppler::COMPENSATED].contains(&name.as_str());
    let called = |name: &&str| fields.iter().find(|known| known.eq_ignore_ascii_case(name));
    let found = OF_RADARS.iter().chain([&SHORT]).find_map(called).map(String::as_str);
    found.filter(|_| !fields.iter().any(is_told))
}

/// What is said of a field that looks like a range rate, which the settings don't name.
pub(super) fn unused(radar: &str, fields: &[String]) -> Option<String> {
    let field = find(fields)?;
    let way = format!("`topics.{radar}.doppler = \"{field}\"` if it is one, m/s and positive when receding");
    Some(format!("{radar}: the field `{field}` looks like a range rate, and is not used as such: {way}"))
}

/// Refuses a range rate that the settings name and no field tells, or two do. The fields hold the added `doppler`.
pub(super) fn check(radar: &str, topic: &TopicConfig, fields: &[String]) -> Result<(), String> {
    let Some(rate) = &topic.doppler else { return Ok(()) };
    let times_told = fields.iter().filter(|name| *name == Doppler::RAW).count();
    if times_told == 1 && fields.contains(rate) {
        return Ok(());
    }
    let found = fields.join(", ");
    Err(format!(
        "expected a field `{rate}` and none `doppler` beside it (topics.{radar}.doppler), found {found}"
    ))
}
