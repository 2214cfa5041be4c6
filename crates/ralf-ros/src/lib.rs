//! ROS recordings and the messages in them.
//!
//! [`container`] finds the messages of a ROS 1 bag, an MCAP file or a ROS 2 folder, and reads any of them by its place,
//! in bounded memory. [`encoding`] is how values lie in a message: ROS 1 or CDR. [`message`] knows the types that a
//! radar recording is made of, once for both. [`point_cloud`] gives the columns of a cloud by the names of its fields,
//! [`tf`] the transform between two frames. [`writer`] makes MCAP files and bags:
//!
//! ```
//! use ralf_ros::message::{Header, Imu};
//! use ralf_ros::writer::{Compression, Delivery, MessageWriter};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let file = std::io::Cursor::new(Vec::new());
//! let mut writer = MessageWriter::mcap(file, Compression::Zstd)?;
//! let topic = writer.topic::<Imu>("/imu", Delivery::Live)?;
//! let header = Header { stamp_ns: 1_000, frame_id: "base_link".to_owned(), ..Header::default() };
//! writer.write(&topic, 1_500, &Imu { header, ..Imu::default() })?;
//! writer.finish()?;
//! # Ok(())
//! # }
//! ```

pub mod container;
pub mod encoding;
pub mod message;
pub mod point_cloud;
pub mod tf;
pub mod writer;
