//! A recording as a source: measurements typed.

use super::camera::intrinsics;
use super::cloud::{lidar_scan, point_clock, radar_columns};
use super::messages::Messages;
use super::motion::motion;
use super::mounting::{mounting, sensor_frame, vehicle_frame};
use super::pixels;
use super::point_clock::PointClock;
use super::survey::{Survey, Track, info_topic, survey};
use super::topics::{TopicConfig, TopicKind, Topics};
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::models::{LIDARS, RADARS};
use crate::read::recording::measurement;
use ralf::sensors::{
    Camera, CameraImage, DepthImage, DepthOutput, Elevation, LidarScan, RadarScan, Rig, Sequence, Source,
    SourceError, Timelines, check_fields,
};
use ralf::space::Transform;
use ralf_ros::container::{Container, MessageRef};
use std::any::Any;
use std::path::PathBuf;

/// The messages of each sensor, in the order of its timeline.
type MessagesPerSensor = Vec<Vec<MessageRef>>;

/// The messages behind a sequence: its [`origin`](SequenceReader::origin).
pub(crate) struct RosOrigin {
    messages: Messages,
    radar_frames: Vec<String>,
}

impl RosOrigin {
    /// All messages, which can be copied as they are.
    pub(crate) fn container(&self) -> &Container {
        self.messages.container()
    }

    /// The frame of each radar, in the order of the rig.
    pub(crate) fn radar_frames(&self) -> &[String] {
        &self.radar_frames
    }
}

/// One recording.
pub(super) struct Drive {
    sequence: Sequence,
    origin: RosOrigin,
    radars: MessagesPerSensor,
    lidars: MessagesPerSensor,
    clocks: Vec<LidarClock>,
    cameras: MessagesPerSensor,
    warnings: Vec<String>,
}

/// How a LiDAR's points tell when they were measured.
struct LidarClock {
    clock: Option<PointClock>,
    /// Whether they lie where they were measured.
    is_rolling: bool,
}

impl Drive {
    /// Reads everything once, and keeps times, motion and calibration.
    pub(super) fn new(
        messages: Messages,
        topics: &Topics,
        mut warnings: Vec<String>,
    ) -> Result<Self, DataError> {
        let mut survey = survey(&messages, topics)?;
        warnings.append(&mut survey.losses);
        let vehicle = vehicle_frame(&messages, topics, &survey)?;
        let motion = motion(&messages, topics, &survey, &vehicle, &mut warnings)?;
        let name = messages.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let title = format!("{} topics", messages.container().topics().len());
        let (rig, times, depth_output) = (Rig::default(), Timelines::default(), DepthOutput::default());
        let sequence = Sequence { name, title, rig, times, motion, depth_output };
        let [radars, lidars, cameras] = [const { Vec::new() }; 3];
        let origin = RosOrigin { messages, radar_frames: Vec::new() };
        let clocks = Vec::new();
        let mut drive = Self { sequence, origin, radars, lidars, clocks, cameras, warnings };
        for (name, topic) in topics {
            if let Some(track) = survey.sensors.get(name) {
                drive.add(name, topic, track, &survey, &vehicle)?;
            }
        }
        Ok(drive)
    }

    fn add(
        &mut self,
        name: &str,
        topic: &TopicConfig,
        track: &Track,
        survey: &Survey,
        vehicle: &str,
    ) -> Result<(), DataError> {
        let Some((first, last)) = track.measurements.first().zip(track.measurements.last()) else {
            return Ok(());
        };
        let frame = sensor_frame(topic, &track.frame);
        let vehicle_from_sensor =
            match mounting(&self.origin.messages, survey, vehicle, frame, [first.0, last.0]) {
                // Labels need radars and LiDARs; without a camera they are labels still.
                Err(error) if topic.kind == TopicKind::Camera => {
                    self.warnings.push(format!("the camera {name} is left out: {error}"));
                    return Ok(());
                }
                found => found?,
            };
        let times = track.measurements.iter().map(|(t_ns, _)| *t_ns).collect();
        let messages = track.measurements.iter().map(|(_, message)| *message).collect();
        match topic.kind {
            TopicKind::Radar => {
                self.add_radar(name, topic, &first.1, vehicle_from_sensor)?;
                self.sequence.times.radars.push(times);
                self.radars.push(messages);
                self.origin.radar_frames.push(frame.to_owned());
            }
            TopicKind::Lidar => {
                let model = self.model(name, topic, &LIDARS)?;
                let clock = self.clock(name, topic, first.0, &first.1);
                self.clocks.push(clock);
                self.sequence.rig.lidars.push(model.mounted(name, vehicle_from_sensor));
                self.sequence.times.lidars.push(times);
                self.lidars.push(messages);
            }
            _ => match self.camera(name, topic, survey, vehicle_from_sensor) {
                Ok(camera) => {
                    self.sequence.rig.cameras.push(camera);
                    self.sequence.times.cameras.push(times);
                    self.cameras.push(messages);
                }
                Err(error) => self.warnings.push(format!("the camera {name} is left out: {error}")),
            },
        }
        Ok(())
    }

    /// How a LiDAR's first scan tells times, with a warning of what is done with them.
    fn clock(&mut self, name: &str, topic: &TopicConfig, t_ns: i64, first: &MessageRef) -> LidarClock {
        let found = point_clock(&self.origin.messages, first, t_ns);
        let clock = found.unwrap_or_else(|sentence| {
            self.warnings.push(format!("{name}: {sentence}"));
            None
        });
        let is_rolling = clock.is_some() && topic.motion_corrected != Some(true);
        if let Some(PointClock { field, unit, .. }) =
            clock.as_ref().filter(|_| topic.motion_corrected.is_none())
        {
            self.warnings.push(format!(
                "{name}: points carry their times (`{field}`, {unit}) and are moved to the scan's with the vehicle's \
                 motion; `topics.{name}.motion_corrected = true` if the recorder has done so, `false` if not"
            ));
        }
        LidarClock { clock, is_rolling }
    }

    /// A LiDAR's scan as its message has it.
    fn recorded(&self, lidar: usize, scan: usize) -> Result<LidarScan, DataError> {
        let message = measurement("lidar", &self.lidars, lidar, scan)?;
        let t_ns = self.sequence.times.lidars[lidar][scan];
        lidar_scan(&self.origin.messages, message, t_ns, self.clocks[lidar].clock.as_ref())
    }

    /// The fields are those of the first scan.
    fn add_radar(
        &mut self,
        name: &str,
        topic: &TopicConfig,
        first: &MessageRef,
        vehicle_from_radar: Transform,
    ) -> Result<(), DataError> {
        let names = radar_columns(&self.origin.messages, first)?.names;
        let mut radar = self.model(name, topic, &RADARS)?.mounted(name, &names, vehicle_from_radar);
        match topic.elevation {
            Some(true) => radar.elevation = Elevation::Measured,
            Some(false) => radar.elevation = Elevation::None,
            None => {}
        }
        check_fields(&radar)
            .map_err(|found| self.origin.messages.error(first, "fields", "those of a radar", found))?;
        radar.check().map_err(|expected| {
            let found = format!("the model `{}`", topic.model.as_deref().unwrap_or_default());
            DataError::content(self.origin.messages.path(), format!("topics.{name}"), expected, found)
        })?;
        self.sequence.rig.radars.push(radar);
        Ok(())
    }

    fn camera(
        &self,
        name: &str,
        topic: &TopicConfig,
        survey: &Survey,
        vehicle_from_camera: Transform,
    ) -> Result<Camera, DataError> {
        let place = info_topic(&self.origin.messages, name, topic)?;
        let (message, info) = survey.infos.get(&place).ok_or_else(|| {
            let found = "none that can be read";
            DataError::content(
                self.origin.messages.path(),
                format!("topics.{name}.info"),
                "a calibration",
                found,
            )
        })?;
        let intrinsics =
            intrinsics(info, topic.rectified.unwrap_or_default()).map_err(|(expected, found)| {
                self.origin.messages.error(message, "calibration", expected, found)
            })?;
        Ok(Camera {
            name: name.to_owned(),
            vehicle_from_camera,
            width: info.width as usize,
            height: info.height as usize,
            intrinsics,
            views: Vec::new(),
        })
    }

    fn model<M: Copy>(&self, name: &str, topic: &TopicConfig, models: &[(&str, M)]) -> Result<M, DataError> {
        let wanted = topic.model.as_deref().unwrap_or_default();
        models.iter().find(|(known, _)| *known == wanted).map(|(_, model)| *model).ok_or_else(|| {
            let known: Vec<&str> = models.iter().map(|(known, _)| *known).collect();
            let expected = format!("one of the models {}", known.join(", "));
            DataError::content(
                self.origin.messages.path(),
                format!("topics.{name}.model"),
                expected,
                format!("`{wanted}`"),
            )
        })
    }
}

impl Source for Drive {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let message = measurement("radar", &self.radars, radar, scan)?;
        let model = &self.sequence.rig.radars[radar];
        let columns = radar_columns(&self.origin.messages, message)?;
        if columns.names != model.fields {
            let (expected, found) = (model.fields.join(", "), columns.names.join(", "));
            let expected = format!("those of the first scan, {expected}");
            return Err(self.origin.messages.error(message, "fields", expected, found).into());
        }
        let t_ns = self.sequence.times.radars[radar][scan];
        let scan = RadarScan::new(model, t_ns, columns.values);
        Ok(scan
            .map_err(|found| self.origin.messages.error(message, "columns", "those of the radar", found))?)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        let recorded = self.recorded(lidar, scan)?;
        let Sequence { rig, motion, .. } = &self.sequence;
        Ok(if self.clocks[lidar].is_rolling && motion.is_known() {
            recorded.motion_corrected(&rig.lidars[lidar].vehicle_from_lidar, motion)
        } else {
            recorded
        })
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        let message = measurement("camera", &self.cameras, camera, image)?;
        let model = &self.sequence.rig.cameras[camera];
        let image = pixels::image(&self.origin.messages, message)?;
        if (image.width, image.height) == (model.width, model.height) {
            return Ok(image);
        }
        let expected = format!("{} x {} px, as the camera has", model.width, model.height);
        let found = format!("{} x {} px", image.width, image.height);
        Err(self.origin.messages.error(message, "image size", expected, found).into())
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        measurement("camera", &self.cameras, camera, image)?;
        Ok(None)
    }
}

impl SequenceReader for Drive {
    fn inputs(&self) -> Vec<PathBuf> {
        self.origin.messages.container().files().to_vec()
    }

    fn warnings(&self) -> &[String] {
        &self.warnings
    }

    fn rolling_scan(&self, lidar: usize, scan: usize) -> Result<Option<LidarScan>, SourceError> {
        let is_rolling = self.clocks.get(lidar).is_some_and(|clock| clock.is_rolling);
        Ok(if is_rolling { Some(self.recorded(lidar, scan)?) } else { None })
    }

    fn origin(&self) -> Option<&dyn Any> {
        Some(&self.origin)
    }
}
