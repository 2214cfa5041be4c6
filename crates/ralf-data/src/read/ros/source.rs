//! A recording as a source: measurements typed.

use super::cloud::{derives_doppler, lidar_scan, radar_columns, with_derived};
use super::messages::Messages;
use super::motion::motion;
use super::mounting::vehicle_frame;
use super::pixels;
use super::sensors::{LidarClock, Sensors};
use super::survey::survey;
use super::topics::Topics;
use super::track::MessagesPerSensor;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::recording::measurement;
use ralf::scene::Doppler;
use ralf::sensors::{
    CameraImage, DepthImage, DepthOutput, LidarScan, Radar, RadarScan, Sequence, Source, SourceError,
};
use ralf_ros::container::{Container, MessageRef};
use std::any::Any;
use std::path::{Path, PathBuf};

/// The messages behind a sequence: its [`origin`](SequenceReader::origin).
pub(crate) struct RosOrigin {
    messages: Messages,
    radar_frames: Vec<String>,
    /// When the recorder got each scan of each radar, ns.
    radar_logs: Vec<Vec<i64>>,
    /// The topics with messages that nothing was read from, by name.
    other_topics: Vec<String>,
}

impl RosOrigin {
    /// Of a sequence; `None` of one that was read from something else.
    pub(crate) fn of(reader: &dyn SequenceReader) -> Option<&Self> {
        reader.origin().and_then(<dyn Any>::downcast_ref)
    }

    /// The topics with messages that nothing was read from, by name.
    pub(crate) fn other_topics(&self) -> &[String] {
        &self.other_topics
    }

    /// All messages, which can be copied as they are.
    pub(crate) fn container(&self) -> &Container {
        self.messages.container()
    }

    /// The frame of each radar, in the order of the rig.
    pub(crate) fn radar_frames(&self) -> &[String] {
        &self.radar_frames
    }

    /// When the recorder got a scan of a radar, ns.
    pub(crate) fn radar_log(&self, radar: usize, scan: usize) -> Option<i64> {
        self.radar_logs.get(radar)?.get(scan).copied()
    }
}

fn other_topics(messages: &Messages, topics: &Topics) -> Vec<String> {
    let read: Vec<&str> = topics
        .values()
        .flat_map(|topic| [Some(&topic.topic), topic.info.as_ref()])
        .flatten()
        .map(String::as_str)
        .collect();
    let mut others: Vec<String> = messages
        .container()
        .topics()
        .iter()
        .filter(|topic| topic.count > 0 && !read.contains(&topic.name.as_str()))
        .map(|topic| topic.name.clone())
        .collect();
    others.dedup();
    others
}

/// One recording.
pub(super) struct Drive {
    sequence: Sequence,
    origin: RosOrigin,
    radars: MessagesPerSensor,
    lidars: MessagesPerSensor,
    clocks: Vec<LidarClock>,
    /// The field of each radar that tells its range rate under another name.
    rates: Vec<Option<String>>,
    cameras: MessagesPerSensor,
    warnings: Vec<String>,
    lost: Vec<String>,
    absent: Vec<String>,
}

impl Drive {
    /// Reads everything once, and keeps times, motion and calibration.
    pub(super) fn new(
        messages: Messages,
        topics: &Topics,
        mut warnings: Vec<String>,
    ) -> Result<Self, DataError> {
        let survey = survey(&messages, topics)?;
        warnings.extend(survey.losses(&messages, topics));
        let vehicle = vehicle_frame(&messages, topics, &survey)?;
        let motion = motion(&messages, topics, &survey, &vehicle, &mut warnings)?;
        let name = sequence_name(messages.path());
        let title = format!("{} topics", messages.container().topics().len());
        let sensors = Sensors::of(&messages, topics, &survey, &vehicle)?;
        let Sensors { rig, times, radars, lidars, cameras, clocks, radar_frames, rates, absent, .. } =
            sensors;
        warnings.extend(sensors.warnings);
        let losses = messages.container().losses().iter().filter(|loss| loss.hides_messages);
        let lost = losses.map(ToString::to_string).chain(sensors.lost).collect();
        let sequence = Sequence { name, title, rig, times, motion, depth_output: DepthOutput::default() };
        let logs = |messages: &Vec<MessageRef>| messages.iter().map(|message| message.log_ns).collect();
        let radar_logs = radars.iter().map(logs).collect();
        let other_topics = other_topics(&messages, topics);
        let origin = RosOrigin { messages, radar_frames, radar_logs, other_topics };
        Ok(Self { sequence, origin, radars, lidars, clocks, rates, cameras, warnings, lost, absent })
    }

    /// A scan of a radar as its message has it, with the range rates that derive from it and the model names, and that
    /// of this field.
    fn measured(
        &self,
        (radar, scan): (usize, usize),
        model: &Radar,
        rate: Option<&str>,
    ) -> Result<RadarScan, SourceError> {
        let message = measurement("radar", &self.radars, radar, scan)?;
        let is_wanted = |name: &str| model.column(name).is_some();
        let columns = radar_columns(&self.origin.messages, message, model.elevation, rate, is_wanted)?;
        let t_ns = self.sequence.times.radars[radar][scan];
        if columns.rows == 0 {
            // Some drivers leave the fields out where nothing was detected.
            return Ok(RadarScan::new(model, t_ns, vec![Vec::new(); model.fields.len()])?);
        }
        if columns.names != model.fields {
            let (expected, found) = (model.fields.join(", "), columns.names.join(", "));
            let expected = format!("those of the first scan, {expected}");
            return Err(self.origin.messages.error(message, "fields", expected, found).into());
        }
        let scan = RadarScan::new(model, t_ns, columns.values);
        Ok(scan
            .map_err(|found| self.origin.messages.error(message, "columns", "those of the radar", found))?)
    }

    /// The field that tells a radar's range rate under another name.
    fn other_rate(&self, radar: usize) -> Option<&str> {
        self.rates.get(radar)?.as_deref()
    }

    /// A LiDAR's scan as its message has it.
    fn recorded(&self, lidar: usize, scan: usize) -> Result<LidarScan, DataError> {
        let message = measurement("lidar", &self.lidars, lidar, scan)?;
        let t_ns = self.sequence.times.lidars[lidar][scan];
        lidar_scan(&self.origin.messages, message, t_ns, self.clocks[lidar].clock.as_ref())
    }
}

/// A file's name without its ending; a folder's whole, for its dots are part of it.
fn sequence_name(path: &Path) -> String {
    let name = if path.is_dir() { path.file_name() } else { path.file_stem() };
    name.unwrap_or_default().to_string_lossy().into_owned()
}

impl Source for Drive {
    fn sequence(&self) -> &Sequence {
        &self.sequence
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        let model = self.sequence.rig.radars.get(radar);
        let none = DataError::NoMeasurement { kind: "radar", sensor: radar, index: scan };
        self.measured((radar, scan), model.ok_or(none)?, self.other_rate(radar))
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
        pixels::image(&self.origin.messages, message, &self.sequence.rig.cameras[camera])
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

    fn lost(&self) -> &[String] {
        &self.lost
    }

    fn absent(&self) -> &[String] {
        &self.absent
    }

    fn rolling_scan(&self, lidar: usize, scan: usize) -> Result<Option<LidarScan>, SourceError> {
        let is_rolling = self.clocks.get(lidar).is_some_and(|clock| clock.is_rolling);
        Ok(if is_rolling { Some(self.recorded(lidar, scan)?) } else { None })
    }

    /// Whether range rates are derived, or taken from a field, is a setting, and no other content.
    fn delivered(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        if !self.alters_values(radar) {
            return self.radar_scan(radar, scan);
        }
        let model = &self.sequence.rig.radars[radar];
        let mut fields = model.fields.clone();
        fields.retain(|name| self.other_rate(radar).is_none() || name != Doppler::RAW);
        let whole = Radar { fields: with_derived(&fields), ..model.clone() };
        self.measured((radar, scan), &whole, None)
    }

    fn alters_values(&self, radar: usize) -> bool {
        let derives = |radar: &Radar| derives_doppler(&radar.fields);
        self.other_rate(radar).is_some() || self.sequence.rig.radars.get(radar).is_some_and(derives)
    }

    fn origin(&self) -> Option<&dyn Any> {
        Some(&self.origin)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_keep_their_dots() {
        let root = tempfile::tempdir().unwrap();
        let [folder, file] = ["drive.1", "drive.2.mcap"].map(|name| root.path().join(name));
        std::fs::create_dir(&folder).unwrap();
        std::fs::write(&file, "").unwrap();
        assert_eq!([sequence_name(&folder), sequence_name(&file)], ["drive.1", "drive.2"]);
    }
}
