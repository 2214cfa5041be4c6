//! What recorders of ROS 2 note of how publishers offer messages: their quality of service.

/// What tells it: a column of a topic, or a pair of a channel's metadata.
pub(super) const OFFERED: &str = "offered_qos_profiles";
/// The durability where messages are also for those who come later: as rosbag2 had it until Humble, and since.
const LATCHED: [&str; 2] = ["1", "transient_local"];

/// Whether messages are also for those who come later: as the recorder was offered them, or where it doesn't tell, as
/// every static frame is.
pub(super) fn is_latched(topic: &str, offered: &str) -> bool {
    if !offered.contains("durability") {
        return topic.ends_with("/tf_static");
    }
    let keys = offered.lines().map(|line| line.trim().trim_start_matches("- "));
    keys.filter_map(|key| key.strip_prefix("durability:")).any(|value| LATCHED.contains(&value.trim()))
}
