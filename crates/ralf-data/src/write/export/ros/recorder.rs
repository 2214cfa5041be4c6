//! One sequence as one file: all its messages in the order of their times.

use super::motion::{delay, header, mountings, odometry, twist, vehicle};
use super::names::{self, Names};
use super::originals::Originals;
use super::{FileWriter, cloud, images, written};
use crate::error::DataError;
use crate::read::{Altered, SequenceReader};
use crate::write::export::columns::cloud_columns;
use crate::write::export::labelled::LabelledSequence;
use crate::write::export::options::Sensors;
use ralf::sensors::{Sequence, SourceError};
use ralf::space::EgoMotion;
use ralf_ros::message::{
    CameraInfo, CompressedImage, Message, Odometry, PointCloud2, TfMessage, TwistStamped,
};
use ralf_ros::writer::{Delivery, Topic, WriteError};
use std::path::Path;

/// Writes one sequence.
pub(super) struct Recorder<'a> {
    writer: FileWriter,
    /// For messages.
    file: &'a Path,
    reader: &'a dyn SequenceReader,
    names: Names,
    topics: Topics,
    /// Where the sequence is read from such a file, uncorrected, and all its data are asked for: its own messages.
    originals: Option<Originals<'a>>,
    /// How much later than it was measured everything is written, ns.
    delay_ns: i64,
}

/// The topics; lists are empty where nothing of the kind is recorded.
struct Topics {
    tf_static: Option<Topic<TfMessage>>,
    motion: Option<Motion>,
    labelled: Vec<Topic<PointCloud2>>,
    radars: Vec<Topic<PointCloud2>>,
    lidars: Vec<Topic<PointCloud2>>,
    cameras: Vec<(Topic<CompressedImage>, Topic<CameraInfo>)>,
}

/// The topics of the vehicle's motion.
struct Motion {
    odometry: Option<Topic<Odometry>>,
    twist: Option<Topic<TwistStamped>>,
    tf: Topic<TfMessage>,
    /// The time at which the vehicle was last shown, ns.
    shown_ns: Option<i64>,
}

/// What a message is about; the order at equal times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    Original(usize),
    Wheels(usize),
    Pose(usize),
    Lidar { lidar: usize, scan: usize },
    Camera { camera: usize, image: usize },
    Radar { radar: usize, scan: usize },
}

impl<'a> Recorder<'a> {
    /// A file to be filled: with the data of these sensors, and with labels or without.
    pub(super) fn new(
        mut writer: FileWriter,
        file: &'a Path,
        reader: &'a dyn SequenceReader,
        sensors: Sensors,
        labelled: bool,
    ) -> Result<Self, DataError> {
        let unlike = |found| DataError::content(file, "sensors", "names that differ in ROS, too", found);
        let names = Names::of(&reader.sequence().rig).map_err(unlike)?;
        // Models of sensors go into the settings beside a recording, and an export has none.
        let at_most = if labelled { Altered::Models } else { Altered::Nothing };
        let originals = match sensors == Sensors::ALL {
            true => Originals::of(reader, at_most, &mut writer).map_err(written(file))?,
            false => None,
        };
        let sensors = if originals.is_some() { None } else { Some(sensors) };
        let motion = &reader.sequence().motion;
        let topics = Topics::add(&mut writer, &names, motion, sensors, labelled).map_err(written(file))?;
        Ok(Self { writer, file, reader, names, topics, originals, delay_ns: 0 })
    }

    /// What the sensors are called in the topics.
    pub(super) fn names(&self) -> &Names {
        &self.names
    }

    /// Whether the messages of another recording are copied.
    pub(super) fn copies(&self) -> bool {
        self.originals.is_some()
    }

    /// Writes all messages and ends the file. `progress` is told how many measurements are done. Returns how much later
    /// than it was measured everything is written, ns.
    pub(super) fn record(
        mut self,
        mut labelled: Option<&mut LabelledSequence>,
        progress: &dyn Fn(usize),
    ) -> Result<i64, DataError> {
        let sequence = self.reader.sequence();
        let events = self.events(sequence);
        let [begin, end] = [events.first(), events.last()].map(|event| event.map_or(0, |(t_ns, _)| *t_ns));
        // What is copied keeps its times, which ROS knows.
        self.delay_ns = if self.originals.is_some() { 0 } else { delay(begin, end) };
        if let Some(topic) = &self.topics.tf_static {
            let stamp_ns = begin + self.delay_ns;
            let mountings = mountings(stamp_ns, &sequence.rig, &self.names);
            self.writer.write(topic, stamp_ns, &mountings).map_err(written(self.file))?;
        }
        let mut done = 0;
        for (t_ns, event) in events {
            let stamp_ns = t_ns + self.delay_ns;
            match event {
                Event::Original(place) => self.original(place)?,
                Event::Wheels(_) | Event::Pose(_) => self.motion(t_ns, event)?,
                Event::Radar { radar, scan } => self.radar(stamp_ns, radar, scan, labelled.as_deref_mut())?,
                Event::Lidar { lidar, scan } => self.lidar(stamp_ns, lidar, scan)?,
                Event::Camera { camera, image } => self.camera(stamp_ns, camera, image)?,
            }
            done += usize::from(matches!(
                event,
                Event::Radar { .. } | Event::Lidar { .. } | Event::Camera { .. }
            ));
            progress(done);
        }
        self.writer.finish().map_err(written(self.file))?;
        Ok(self.delay_ns)
    }

    /// What is to be recorded, in time order.
    fn events(&self, sequence: &Sequence) -> Vec<(i64, Event)> {
        fn each(sensors: &[Vec<i64>]) -> impl Iterator<Item = (i64, usize, usize)> {
            let of = |(sensor, times): (usize, &'_ Vec<i64>)| {
                times.iter().enumerate().map(move |(index, t_ns)| (*t_ns, sensor, index)).collect::<Vec<_>>()
            };
            sensors.iter().enumerate().flat_map(of)
        }
        let mut events: Vec<(i64, Event)> = Vec::new();
        if let Some(originals) = &self.originals {
            events.extend(originals.times().map(|(t_ns, place)| (t_ns, Event::Original(place))));
        }
        let radars = self.topics.labelled.iter().chain(&self.topics.radars).next();
        let radars = radars.map_or(&[][..], |_| &sequence.times.radars);
        let log = |radar, scan| self.originals.as_ref().and_then(|found| found.radar_log(radar, scan));
        events.extend(
            each(radars)
                .map(|(t, radar, scan)| (log(radar, scan).unwrap_or(t), Event::Radar { radar, scan })),
        );
        if !self.topics.lidars.is_empty() {
            events.extend(
                each(&sequence.times.lidars).map(|(t, lidar, scan)| (t, Event::Lidar { lidar, scan })),
            );
        }
        if !self.topics.cameras.is_empty() {
            let cameras = each(&sequence.times.cameras);
            events.extend(cameras.map(|(t, camera, image)| (t, Event::Camera { camera, image })));
        }
        if self.topics.motion.is_some() {
            let (wheels, poses) = (sequence.motion.odometry(), sequence.motion.poses());
            events.extend(wheels.iter().enumerate().map(|(at, sample)| (sample.t_ns, Event::Wheels(at))));
            events.extend(poses.iter().enumerate().map(|(at, sample)| (sample.t_ns, Event::Pose(at))));
        }
        events.sort_unstable();
        events
    }

    fn original(&mut self, place: usize) -> Result<(), DataError> {
        let Some(originals) = &self.originals else { return Ok(()) };
        originals.copy(place, &mut self.writer, self.file)
    }

    /// A sample as it was recorded, and for those who show frames where the vehicle is.
    fn motion(&mut self, t_ns: i64, event: Event) -> Result<(), DataError> {
        let Some(topics) = &mut self.topics.motion else { return Ok(()) };
        let motion = &self.reader.sequence().motion;
        let (stamp_ns, refused) = (t_ns + self.delay_ns, written(self.file));
        match (event, &topics.twist, &topics.odometry) {
            (Event::Wheels(at), Some(topic), _) => {
                let twist = twist(stamp_ns, &motion.odometry()[at]);
                self.writer.write(topic, stamp_ns, &twist).map_err(&refused)?;
            }
            (Event::Pose(at), _, Some(topic)) => {
                let odometry = odometry(stamp_ns, &motion.poses()[at], motion);
                self.writer.write(topic, stamp_ns, &odometry).map_err(&refused)?;
            }
            _ => {}
        }
        // Poses and wheels of one time have the vehicle at one place.
        if topics.shown_ns.replace(t_ns) == Some(t_ns) {
            return Ok(());
        }
        let vehicle = vehicle(stamp_ns, &motion.odom_from_vehicle(t_ns));
        self.writer.write(&topics.tf, stamp_ns, &vehicle).map_err(&refused)
    }

    /// A radar's scan, recorded at this time.
    fn radar(
        &mut self,
        log_ns: i64,
        radar: usize,
        scan: usize,
        labelled: Option<&mut LabelledSequence>,
    ) -> Result<(), DataError> {
        let frames = self.originals.as_ref().map_or(&self.names.radars[..], |found| found.radar_frames());
        let Sequence { rig, times, .. } = self.reader.sequence();
        let header = header(times.radars[radar][scan] + self.delay_ns, &frames[radar]);
        let sensor = &rig.radars[radar];
        let measured = match labelled {
            Some(sequence) => {
                let found = sequence.scan(radar, scan)?;
                let measured = sequence.measured_of(&found)?;
                let columns = cloud_columns(sequence, &found, &measured, true)?;
                let cloud = cloud::of_columns(header.clone(), &columns);
                let topic = &self.topics.labelled[radar];
                self.writer.write(topic, log_ns, &cloud).map_err(written(self.file))?;
                found.kept_of(measured)
            }
            None => self.reader.radar_scan(radar, scan).map_err(unread(&sensor.name, scan))?.columns,
        };
        let Some(topic) = self.topics.radars.get(radar) else { return Ok(()) };
        let cloud = cloud::of_radar(header, sensor, measured)?;
        self.writer.write(topic, log_ns, &cloud).map_err(written(self.file))
    }

    fn lidar(&mut self, stamp_ns: i64, lidar: usize, scan: usize) -> Result<(), DataError> {
        let name = &self.reader.sequence().rig.lidars[lidar].name;
        let measured = self.reader.lidar_scan(lidar, scan).map_err(unread(name, scan))?;
        let cloud = cloud::of_lidar(header(stamp_ns, &self.names.lidars[lidar]), measured)?;
        self.writer.write(&self.topics.lidars[lidar], stamp_ns, &cloud).map_err(written(self.file))
    }

    fn camera(&mut self, stamp_ns: i64, camera: usize, image: usize) -> Result<(), DataError> {
        let sensor = &self.reader.sequence().rig.cameras[camera];
        let header = header(stamp_ns, &self.names.cameras[camera]);
        let (pixels, calibration) = &self.topics.cameras[camera];
        let found = images::image(header.clone(), self.reader, camera, image);
        let found = found.map_err(unread(&sensor.name, image))?;
        self.writer.write(pixels, stamp_ns, &found).map_err(written(self.file))?;
        let Some(info) = images::camera_info(header, sensor) else { return Ok(()) };
        self.writer.write(calibration, stamp_ns, &info).map_err(written(self.file))
    }
}

impl Topics {
    /// The topics of these sensors; of a copied recording, which has them already, the labelled clouds alone.
    fn add(
        writer: &mut FileWriter,
        names: &Names,
        motion: &EgoMotion,
        sensors: Option<Sensors>,
        labelled: bool,
    ) -> Result<Self, WriteError> {
        let tf_static = sensors.map(|_| writer.topic(names::TF_STATIC, Delivery::Latched)).transpose()?;
        let sensors = sensors.unwrap_or_default();
        let mut clouds = |of: bool, names: &[String], name: &str| {
            let names = names.iter().filter(|_| of);
            names.map(|sensor| live(writer, &names::cloud(sensor, name))).collect::<Result<Vec<_>, _>>()
        };
        let labelled = clouds(labelled, &names.radars, names::LABELLED)?;
        let radars = clouds(sensors.radar, &names.radars, names::POINTS)?;
        let lidars = clouds(sensors.lidar, &names.lidars, names::POINTS)?;
        let cameras = names.cameras.iter().filter(|_| sensors.camera).map(|camera| {
            let image = live(writer, &names::image(camera))?;
            Ok((image, live(writer, &names::camera_info(camera))?))
        });
        let cameras = cameras.collect::<Result<_, WriteError>>()?;
        let motion = match sensors.any() {
            true => Some(Motion::add(writer, motion)?),
            false => None,
        };
        Ok(Self { tf_static, motion, labelled, radars, lidars, cameras })
    }
}

impl Motion {
    /// The topics of what is known of a motion.
    fn add(writer: &mut FileWriter, motion: &EgoMotion) -> Result<Self, WriteError> {
        let (wheels, poses) = (!motion.odometry().is_empty(), !motion.poses().is_empty());
        Ok(Self {
            odometry: poses.then(|| live(writer, names::ODOMETRY)).transpose()?,
            twist: wheels.then(|| live(writer, names::TWIST)).transpose()?,
            tf: live(writer, names::TF)?,
            shown_ns: None,
        })
    }
}

fn live<M: Message>(writer: &mut FileWriter, name: &str) -> Result<Topic<M>, WriteError> {
    writer.topic(name, Delivery::Live)
}

fn unread(sensor: &str, index: usize) -> impl FnOnce(SourceError) -> DataError {
    move |error| DataError::Measurement { sensor: sensor.to_owned(), index, error }
}
