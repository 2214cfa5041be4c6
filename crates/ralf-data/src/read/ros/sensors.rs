//! The sensors of a recording: what they are by their settings, their messages and the tree of frames, and when they
//! measured.

use super::camera::{intrinsics, left_to_frames};
use super::cloud::{Columns, point_clock, radar_columns};
use super::messages::Messages;
use super::mounting::{mounting, sensor_frame};
use super::point_clock::{PointClock, Said};
use super::range_rate;
use super::survey::{Survey, info_topics};
use super::topics::{TopicConfig, TopicKind, Topics};
use super::track::{MessagesPerSensor, Track};
use super::unread::ByReason;
use crate::error::DataError;
use crate::read::models::{LIDARS, RADARS};
use ralf::sensors::{Camera, Elevation, Radar, Rig, Timelines, check_fields};
use ralf::space::Transform;
use ralf_ros::container::MessageRef;
use ralf_ros::message::CameraInfo;

/// All sensors, in the order of the rig.
#[derive(Default)]
pub(super) struct Sensors {
    pub(super) rig: Rig,
    pub(super) times: Timelines,
    pub(super) radars: MessagesPerSensor,
    pub(super) lidars: MessagesPerSensor,
    pub(super) cameras: MessagesPerSensor,
    pub(super) clocks: Vec<LidarClock>,
    /// The frame of each radar.
    pub(super) radar_frames: Vec<String>,
    /// The field of each radar that tells its range rate under another name.
    pub(super) rates: Vec<Option<String>>,
    /// What is left out, and what is done with the points' times, a sentence each.
    pub(super) warnings: Vec<String>,
    /// Names of sensors none of whose messages can be read.
    pub(super) absent: Vec<String>,
    /// LiDARs and cameras none of whose messages can be read.
    left_out: ByReason,
    /// Radars none of whose scans can be read, a sentence each: nothing tells what they measure.
    pub(super) lost: Vec<String>,
}

/// How a LiDAR's points tell when they were measured.
pub(super) struct LidarClock {
    pub(super) clock: Option<PointClock>,
    /// Whether they lie where they were measured.
    pub(super) is_rolling: bool,
}

/// What a radar measures none of whose scans tell it.
const UNTOLD: [&str; 3] = ["x", "y", "z"];

/// A sensor that is asked for, with what is known of the recording.
struct Asked<'a> {
    messages: &'a Messages,
    survey: &'a Survey,
    vehicle: &'a str,
    name: &'a str,
    topic: &'a TopicConfig,
    track: &'a Track,
}

impl Sensors {
    /// The sensors of these topics on a vehicle, whose frame is named.
    pub(super) fn of(
        messages: &Messages,
        topics: &Topics,
        survey: &Survey,
        vehicle: &str,
    ) -> Result<Self, DataError> {
        let (mut sensors, silent) = (Self::default(), Track::default());
        for (name, topic) in topics {
            let track = survey.sensors.get(name).unwrap_or(&silent);
            let asked = Asked { messages, survey, vehicle, name, topic, track };
            if topic.kind.is_sensor() && !sensors.leave_out_silent(&asked) {
                sensors.add(&asked)?;
            }
        }
        let sentence = |names: &str, reason: &str| {
            format!("left out, for none of their messages can be read: {names}; the first: {reason}")
        };
        sensors.warnings.extend(sensors.left_out.sentences(sentence));
        Ok(sensors)
    }

    fn add(&mut self, asked: &Asked) -> Result<(), DataError> {
        match asked.topic.kind {
            TopicKind::Radar => self.add_radar(asked)?,
            TopicKind::Lidar => self.add_lidar(asked)?,
            _ => self.add_camera(asked),
        }
        Ok(())
    }

    /// Says of a sensor without messages that it has none. Without a frame it has no place either, and is left out.
    fn leave_out_silent(&mut self, asked: &Asked) -> bool {
        let Asked { name, topic, track, .. } = *asked;
        if !track.is_silent() {
            return false;
        }
        let none = format!("{name}: no messages of {}", topic.topic);
        if topic.frame.is_some() {
            self.warnings.push(none);
            return false;
        }
        let why = format!("nothing tells its frame (`topics.{name}.frame` would): left out");
        self.warnings.push(format!("{none}, and {why}"));
        self.absent.push(name.to_owned());
        true
    }

    fn add_radar(&mut self, asked: &Asked) -> Result<(), DataError> {
        let Some(vehicle_from_radar) = asked.vehicle_from_sensor()? else {
            self.lose(asked, asked.unread());
            return Ok(());
        };
        let fields = match asked.radar_fields() {
            Ok(found) => found,
            Err(error @ DataError::Io { .. }) => return Err(error),
            Err(error) => {
                self.lose(asked, &error.to_string());
                return Ok(());
            }
        };
        let radar = asked.radar(fields, vehicle_from_radar)?;
        self.warnings.extend(range_rate::unused(asked.name, &radar.fields));
        self.rig.radars.push(radar);
        self.rates.push(asked.topic.other_rate().map(str::to_owned));
        self.radar_frames.push(asked.frame().to_owned());
        asked.track.keep(&mut self.times.radars, &mut self.radars);
        Ok(())
    }

    /// Names a radar none of whose scans can be read.
    fn lose(&mut self, asked: &Asked, reason: &str) {
        self.lost.push(format!("{}: {}", asked.name, asked.nothing(reason)));
        self.absent.push(asked.name.to_owned());
    }

    fn add_lidar(&mut self, asked: &Asked) -> Result<(), DataError> {
        let Some(vehicle_from_lidar) = asked.vehicle_from_sensor()? else {
            self.leave_out("LiDAR", asked);
            return Ok(());
        };
        let model = asked.model(&LIDARS)?;
        let clock = self.clock(asked)?;
        self.clocks.push(clock);
        self.rig.lidars.push(model.mounted(asked.name, vehicle_from_lidar));
        asked.track.keep(&mut self.times.lidars, &mut self.lidars);
        Ok(())
    }

    /// Labels need radars and LiDARs; without a camera they are labels still.
    fn add_camera(&mut self, asked: &Asked) {
        let mounted = match asked.vehicle_from_sensor() {
            Ok(None) => return self.leave_out("camera", asked),
            Ok(Some(vehicle_from_camera)) => asked.camera(vehicle_from_camera),
            Err(error) => Err(error),
        };
        match mounted {
            Ok(camera) => {
                self.warnings.extend(asked.left_to_frames());
                self.rig.cameras.push(camera);
                asked.track.keep(&mut self.times.cameras, &mut self.cameras);
            }
            Err(error) => self.warnings.push(format!("the camera {} is left out: {error}", asked.name)),
        }
    }

    /// Leaves out a sensor of which no message can be read: nothing tells its frame.
    fn leave_out(&mut self, kind: &str, asked: &Asked) {
        self.absent.push(asked.name.to_owned());
        self.left_out.add(asked.unread(), format!("the {kind} {}", asked.name));
    }

    /// How a LiDAR's scans tell times, with a warning of what is done with them.
    fn clock(&mut self, asked: &Asked) -> Result<LidarClock, DataError> {
        let Asked { name, topic, .. } = *asked;
        let found = match asked.point_clock() {
            Ok(found) => found,
            Err(error @ DataError::Io { .. }) => return Err(error),
            Err(error) => Err(asked.nothing(&error.to_string())),
        };
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
        Ok(LidarClock { clock, is_rolling })
    }
}

impl Asked<'_> {
    fn frame(&self) -> &str {
        sensor_frame(self.topic, &self.track.frame)
    }

    /// Where it is mounted; `None` where no message tells its frame and the times of its measurements.
    fn vehicle_from_sensor(&self) -> Result<Option<Transform>, DataError> {
        let silent = || self.track.is_silent().then(|| [self.survey.first_time(); 2]);
        let Some(span) = self.track.span().or_else(silent) else { return Ok(None) };
        mounting(self.messages, self.survey, self.vehicle, self.frame(), span).map(Some)
    }

    /// What the first message tells that tells anything, at its time; the error of the first one where none can be
    /// read.
    fn first<T>(
        &self,
        mut read: impl FnMut(i64, &MessageRef) -> Result<Option<T>, DataError>,
    ) -> Result<Option<T>, DataError> {
        let (mut failed, mut is_read) = (None, false);
        for (t_ns, message) in self.track.timeline() {
            match read(t_ns, &message) {
                Ok(None) => is_read = true,
                Err(error @ DataError::Io { .. }) => return Err(error),
                Err(error) => drop(failed.get_or_insert(error)),
                found => return found,
            }
        }
        failed.filter(|_| !is_read).map_or(Ok(None), Err)
    }

    /// The fields of the first scan with detections, and the message that tells them; where there is none, of the first
    /// scan that names any.
    fn radar_fields(&self) -> Result<Option<(MessageRef, Vec<String>)>, DataError> {
        let mut of_empty = None;
        let is_wanted = |_: &str| self.topic.derive_doppler != Some(false);
        let found = self.first(|_, message| {
            let rate = self.topic.other_rate();
            let Columns { names, rows, .. } =
                radar_columns(self.messages, message, Elevation::None, rate, is_wanted)?;
            if rows > 0 {
                return Ok(Some((*message, names)));
            }
            if !names.is_empty() {
                of_empty.get_or_insert((*message, names));
            }
            Ok(None)
        })?;
        Ok(found.or(of_empty))
    }

    /// How a LiDAR's points tell times, by its first scans. The error inside is a sentence, of times that are not used.
    fn point_clock(&self) -> Result<Result<Option<PointClock>, String>, DataError> {
        let mut said = Said::default();
        self.first(|t_ns, message| {
            let told = point_clock(self.messages, message, t_ns)?;
            Ok(said.hear(told).then_some(()))
        })?;
        let idle = said.idle.filter(|_| self.topic.motion_corrected != Some(true));
        let unused = |field| format!("`{field}` is the same for all points of each scan, and is not used");
        Ok(match (said.clock(), idle) {
            (Ok(None), Some(field)) => Err(unused(field)),
            (found, _) => found,
        })
    }

    /// Why the first message can't be read whose header can't.
    fn unread(&self) -> &str {
        let first = self.track.unreadable.first();
        first
            .and_then(|message| self.survey.unread.reason(self.messages.topic_of(message)))
            .unwrap_or_default()
    }

    /// What is said of a sensor none of whose messages can be read.
    fn nothing(&self, reason: &str) -> String {
        let count = self.track.readable.len() + self.track.unreadable.len();
        format!("none of its {count} messages can be read; the first: {reason}")
    }

    /// A radar with the fields of this message; with those that every radar may have where no message tells them.
    fn radar(
        &self,
        told: Option<(MessageRef, Vec<String>)>,
        vehicle_from_radar: Transform,
    ) -> Result<Radar, DataError> {
        let Self { messages, name, topic, .. } = *self;
        let (message, fields) = told.map_or_else(
            || (None, UNTOLD.map(str::to_owned).to_vec()),
            |(message, fields)| (Some(message), fields),
        );
        let mut radar = self.model(&RADARS)?.mounted(name, &fields, vehicle_from_radar);
        match topic.elevation {
            Some(true) => radar.elevation = Elevation::Measured,
            Some(false) => radar.elevation = Elevation::None,
            None => {}
        }
        if let Some(message) = message {
            let checked = check_fields(&radar).and_then(|()| range_rate::check(name, topic, &radar.fields));
            checked.map_err(|why| messages.refused(&message, "fields", &why))?;
        }
        radar.check().map_err(|expected| {
            let found = format!("the model `{}`", topic.model.as_deref().unwrap_or_default());
            DataError::content(messages.path(), format!("topics.{name}"), expected, found)
        })?;
        Ok(radar)
    }

    fn calibration(&self) -> Result<&(MessageRef, CameraInfo), DataError> {
        let places = info_topics(self.messages, self.name, self.topic)?;
        places.iter().find_map(|place| self.survey.infos.get(place)).ok_or_else(|| {
            let (asked_by, found) = (format!("topics.{}.info", self.name), "none that can be read");
            DataError::content(self.messages.path(), asked_by, "a calibration", found)
        })
    }

    /// What is said of a calibration that moves rectified images against their frame.
    fn left_to_frames(&self) -> Option<String> {
        let (_, info) = self.calibration().ok().filter(|_| self.topic.rectified == Some(true))?;
        let name = self.name;
        let frame = self.frame();
        let hint =
            format!("right if the frame `{frame}` is theirs, else `corrections.{name}` moves the camera");
        left_to_frames(info).map(|sentence| format!("{name}: {sentence}: {hint}"))
    }

    fn camera(&self, vehicle_from_camera: Transform) -> Result<Camera, DataError> {
        let Self { messages, name, topic, .. } = *self;
        let (message, info) = self.calibration()?;
        let intrinsics = intrinsics(info, topic.rectified.unwrap_or_default())
            .map_err(|(expected, found)| messages.error(message, "calibration", expected, found))?;
        let (width, height) = (info.width as usize, info.height as usize);
        let name = name.to_owned();
        let camera = Camera { name, vehicle_from_camera, width, height, intrinsics, views: Vec::new() };
        camera.check().map_err(|reason| messages.refused(message, "calibration", &reason))?;
        Ok(camera)
    }

    fn model<M: Copy>(&self, models: &[(&str, M)]) -> Result<M, DataError> {
        let wanted = self.topic.model.as_deref().unwrap_or_default();
        models.iter().find(|(known, _)| *known == wanted).map(|(_, model)| *model).ok_or_else(|| {
            let known: Vec<&str> = models.iter().map(|(known, _)| *known).collect();
            let place = format!("topics.{}.model", self.name);
            let expected = format!("one of the models {}", known.join(", "));
            DataError::content(self.messages.path(), place, expected, format!("`{wanted}`"))
        })
    }
}
