//! The recordings in `testdata/ros`.

/// Which topic is which sensor; the camera is left out, for its frame is missing in the files.
pub(crate) const ROS_TOPICS: &str = "
[topics.radar]
topic = '/radar/points'
kind = 'radar'
model = 'ars408-21'
[topics.odom]
topic = '/odom'
kind = 'odometry'
[topics.tf]
topic = '/tf_static'
kind = 'tf_static'
";
