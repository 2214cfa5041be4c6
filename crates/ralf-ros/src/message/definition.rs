//! What a message type is called and made of, as the files want it written down.

use crate::encoding::Encoding;
use std::fmt::Write;

/// A message type: its name, its fields and those of the types that it is made of.
#[derive(Debug)]
pub struct Definition {
    /// Package and name, such as `sensor_msgs/PointCloud2`.
    pub name: &'static str,
    /// What it was called earlier, with the same fields.
    earlier: Option<&'static str>,
    /// The checksum by which ROS 1 tells versions of a type apart.
    pub md5: &'static str,
    /// A field per line, as ROS 1 writes them.
    ros1: &'static str,
    /// The same of ROS 2, where they differ.
    ros2: Option<&'static str>,
    /// Types of fields, in the order in which they are met.
    parts: &'static [&'static Definition],
}

impl Definition {
    pub(super) const fn new(
        name: &'static str,
        md5: &'static str,
        fields: &'static str,
        parts: &'static [&'static Self],
    ) -> Self {
        Self { name, earlier: None, md5, ros1: fields, ros2: None, parts }
    }

    /// A type that is only ever part of another one, and so needs no checksum.
    pub(super) const fn part(
        name: &'static str,
        fields: &'static str,
        parts: &'static [&'static Self],
    ) -> Self {
        Self::new(name, "", fields, parts)
    }

    pub(super) const fn with_ros2_fields(self, fields: &'static str) -> Self {
        Self { ros2: Some(fields), ..self }
    }

    pub(super) const fn earlier_called(self, name: &'static str) -> Self {
        Self { earlier: Some(name), ..self }
    }

    /// The type's name as files of this encoding spell it: `pkg/Type` in ROS 1, `pkg/msg/Type` in ROS 2.
    pub fn type_name(&self, encoding: Encoding) -> String {
        match encoding {
            Encoding::Ros1 => self.name.to_owned(),
            Encoding::Cdr => self.name.replacen('/', "/msg/", 1),
        }
    }

    /// Whether a file's type name is this type, in either spelling, or by an earlier name.
    pub fn is(&self, type_name: &str) -> bool {
        [Encoding::Ros1, Encoding::Cdr].into_iter().any(|encoding| self.type_name(encoding) == type_name)
            || self.earlier == Some(type_name)
    }

    /// The fields, followed by those of every type that they are made of: what bags hold, and MCAP as `ros1msg` or
    /// `ros2msg`.
    pub fn text(&self, encoding: Encoding) -> String {
        let mut parts = Vec::new();
        self.collect(&mut parts);
        let mut text = self.fields(encoding).to_owned();
        // What has no fields is no type of its own here, but one that every reader knows.
        for part in parts.into_iter().filter(|part| !part.fields(encoding).is_empty()) {
            // Writing to a string can't fail.
            let _ = write!(text, "\n{}\nMSG: {}\n{}", "=".repeat(80), part.name, part.fields(encoding));
        }
        text + "\n"
    }

    fn fields(&self, encoding: Encoding) -> &'static str {
        match encoding {
            Encoding::Ros1 => self.ros1,
            Encoding::Cdr => self.ros2.unwrap_or(self.ros1),
        }
    }

    fn collect(&self, parts: &mut Vec<&'static Self>) {
        for part in self.parts {
            if !parts.iter().any(|known| known.name == part.name) {
                parts.push(part);
                part.collect(parts);
            }
        }
    }
}

/// Known to ROS 2 alone: in ROS 1 a time is a type like any number.
pub(super) static TIME: Definition =
    Definition::part("builtin_interfaces/Time", "", &[]).with_ros2_fields("int32 sec\nuint32 nanosec");

pub(super) static HEADER: Definition = Definition::new(
    "std_msgs/Header",
    "2176decaecbce78abc3b96ef049fabed",
    "uint32 seq\ntime stamp\nstring frame_id",
    &[&TIME],
)
.with_ros2_fields("builtin_interfaces/Time stamp\nstring frame_id");

pub(super) static VECTOR3: Definition =
    Definition::part("geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z", &[]);

pub(super) static QUATERNION: Definition =
    Definition::part("geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w", &[]);

pub(super) static TWIST: Definition = Definition::part(
    "geometry_msgs/Twist",
    "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular",
    &[&VECTOR3],
);

#[cfg(test)]
mod tests {
    use super::super::{CameraInfo, DEFINITIONS, Imu, Message};
    use super::*;

    #[test]
    fn every_part_is_written_once_and_time_only_in_ros2() {
        for definition in DEFINITIONS {
            let [ros1, ros2] = [Encoding::Ros1, Encoding::Cdr].map(|encoding| definition.text(encoding));
            assert_eq!(ros1.matches("MSG: std_msgs/Header").count(), 1, "{}", definition.name);
            assert_eq!(
                ros2.matches("MSG: builtin_interfaces/Time\nint32 sec").count(),
                1,
                "{}",
                definition.name
            );
            assert!(!ros1.contains("builtin_interfaces") && ros1.contains("time stamp"), "{ros1}");
            assert!(!ros2.contains("uint32 seq"), "{ros2}");
        }
        assert_eq!(Imu::DEFINITION.text(Encoding::Cdr).matches("MSG: geometry_msgs/Vector3").count(), 1);
    }

    #[test]
    fn names_are_known_in_either_spelling() {
        let camera_info = CameraInfo::DEFINITION;
        assert_eq!(camera_info.type_name(Encoding::Cdr), "sensor_msgs/msg/CameraInfo");
        assert!(camera_info.is("sensor_msgs/CameraInfo") && camera_info.is("sensor_msgs/msg/CameraInfo"));
        assert!(!camera_info.is("sensor_msgs/Image"));
    }
}
