//! Pictures of labelled radar scans, as PNG bytes.
//!
//! Three figures: [`scan_picture`] shows one scan from above in the vehicle frame, [`overview_picture`] all scans of a
//! sequence in a fixed frame, raw beside those labelled plausible, and [`camera_picture`] what a camera sees, beside
//! its depth. From above, x points up and y to the left, so that the vehicle of a single scan drives upwards. Plausible
//! and artifact detections differ in colour and in shape.
//!
//! Nothing here reads, writes or prints: data in, bytes out, and the same data give the same bytes.
//!
//! ```
//! use ralf_plot::{Mark, MarkLabel, ScanPicture, scan_picture};
//! let marks = [Mark { x: 12.0, y: -3.0, label: MarkLabel::Plausible }];
//! let png = scan_picture(&ScanPicture { title: "radar_front", marks: &marks, ..ScanPicture::default() })?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), ralf_plot::PlotError>(())
//! ```

mod birds_eye;
mod camera;
mod canvas;
mod check;
mod colormap;
mod depth_bar;
mod dots;
mod error;
mod extent;
mod legend;
mod marks;
mod overview;
mod page;
mod palette;
mod panel;
mod scale;
mod text;
mod values;
mod vehicle;
mod viewport;

pub use birds_eye::{ScanPicture, scan_picture};
pub use camera::{CameraPicture, PixelDepth, ViewPicture, camera_picture};
pub use check::{CheckPicture, CheckRow, MOST_CHECK_ROWS, check_picture};
pub use error::PlotError;
pub use extent::Extent;
pub use marks::{Mark, MarkLabel, Marks};
pub use overview::{OverviewPicture, overview_picture};
pub use values::ValueScale;
pub use vehicle::{RadarMount, VehicleOutline};
