//! One sequence as one file: all its messages in the order of their times.

use super::motion::{header, mountings, odometry, times, vehicle};
use super::names::Names;
use super::{FileWriter, cloud, images, written};
use crate::export::columns::cloud_columns;
use crate::export::labelled::LabelledSequence;
use crate::export::options::Sensors;
use crate::{DataError, SequenceReader};
use ralf::source::{Sequence, SourceError};
use ralf_ros::message::{CameraInfo, CompressedImage, Message, Odometry, PointCloud2, TfMessage};
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
}

/// The topics; lists are empty where nothing of the kind is recorded.
struct Topics {
    tf_static: Topic<TfMessage>,
    motion: Option<(Topic<Odometry>, Topic<TfMessage>)>,
    labelled: Vec<Topic<PointCloud2>>,
    radars: Vec<Topic<PointCloud2>>,
    lidars: Vec<Topic<PointCloud2>>,
    cameras: Vec<(Topic<CompressedImage>, Topic<CameraInfo>)>,
}

/// What a message is about; the order at equal times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Event {
    Motion,
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
        let topics = Topics::add(&mut writer, &names, sensors, labelled).map_err(written(file))?;
        Ok(Self { writer, file, reader, names, topics })
    }

    /// Writes all messages and ends the file. `progress` is told how many measurements are done.
    pub(super) fn record(
        mut self,
        mut labelled: Option<&mut LabelledSequence>,
        progress: &dyn Fn(usize),
    ) -> Result<(), DataError> {
        let sequence = self.reader.sequence();
        let events = self.events(sequence);
        let begin = events.first().map_or(0, |(t_ns, _)| *t_ns);
        let mountings = mountings(begin, &sequence.rig, &self.names);
        self.writer.write(&self.topics.tf_static, begin, &mountings).map_err(written(self.file))?;
        let mut done = 0;
        for (t_ns, event) in events {
            match event {
                Event::Motion => self.motion(t_ns)?,
                Event::Radar { radar, scan } => self.radar(t_ns, radar, scan, labelled.as_deref_mut())?,
                Event::Lidar { lidar, scan } => self.lidar(t_ns, lidar, scan)?,
                Event::Camera { camera, image } => self.camera(t_ns, camera, image)?,
            }
            done += usize::from(event != Event::Motion);
            progress(done);
        }
        self.writer.finish().map_err(written(self.file))?;
        Ok(())
    }

    /// What is to be recorded, in time order.
    fn events(&self, sequence: &Sequence) -> Vec<(i64, Event)> {
        fn each(sensors: &[Vec<i64>]) -> impl Iterator<Item = (i64, usize, usize)> {
            let of = |(sensor, times): (usize, &'_ Vec<i64>)| {
                times.iter().enumerate().map(move |(index, t_ns)| (*t_ns, sensor, index)).collect::<Vec<_>>()
            };
            sensors.iter().enumerate().flat_map(of)
        }
        let mut events = Vec::new();
        events.extend(each(&sequence.times.radars).map(|(t, radar, scan)| (t, Event::Radar { radar, scan })));
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
            events.extend(times(&sequence.motion).into_iter().map(|t_ns| (t_ns, Event::Motion)));
        }
        events.sort_unstable();
        events
    }

    fn motion(&mut self, t_ns: i64) -> Result<(), DataError> {
        let Some((odom, tf)) = &self.topics.motion else { return Ok(()) };
        let motion = &self.reader.sequence().motion;
        self.writer.write(odom, t_ns, &odometry(t_ns, motion)).map_err(written(self.file))?;
        self.writer.write(tf, t_ns, &vehicle(t_ns, motion)).map_err(written(self.file))
    }

    fn radar(
        &mut self,
        t_ns: i64,
        radar: usize,
        scan: usize,
        labelled: Option<&mut LabelledSequence>,
    ) -> Result<(), DataError> {
        let header = header(t_ns, &self.names.radars[radar]);
        let sensor = &self.reader.sequence().rig.radars[radar];
        let measured = match labelled {
            Some(sequence) => {
                let found = sequence.scan(radar, scan)?;
                let measured = sequence.measured_of(&found)?;
                let columns = cloud_columns(sequence, &found, &measured)?;
                let cloud = cloud::of_columns(header.clone(), &columns);
                let topic = &self.topics.labelled[radar];
                self.writer.write(topic, t_ns, &cloud).map_err(written(self.file))?;
                measured
            }
            None => self.reader.radar_scan(radar, scan).map_err(unread(&sensor.name, scan))?,
        };
        let Some(topic) = self.topics.radars.get(radar) else { return Ok(()) };
        let cloud = cloud::of_radar(header, sensor, measured);
        self.writer.write(topic, t_ns, &cloud).map_err(written(self.file))
    }

    fn lidar(&mut self, t_ns: i64, lidar: usize, scan: usize) -> Result<(), DataError> {
        let name = &self.reader.sequence().rig.lidars[lidar].name;
        let measured = self.reader.lidar_scan(lidar, scan).map_err(unread(name, scan))?;
        let cloud = cloud::of_lidar(header(t_ns, &self.names.lidars[lidar]), measured);
        self.writer.write(&self.topics.lidars[lidar], t_ns, &cloud).map_err(written(self.file))
    }

    fn camera(&mut self, t_ns: i64, camera: usize, image: usize) -> Result<(), DataError> {
        let sensor = &self.reader.sequence().rig.cameras[camera];
        let header = header(t_ns, &self.names.cameras[camera]);
        let (pixels, calibration) = &self.topics.cameras[camera];
        let found = images::image(header.clone(), self.reader, camera, image);
        let found = found.map_err(unread(&sensor.name, image))?;
        self.writer.write(pixels, t_ns, &found).map_err(written(self.file))?;
        let Some(info) = images::camera_info(header, sensor) else { return Ok(()) };
        self.writer.write(calibration, t_ns, &info).map_err(written(self.file))
    }
}

impl Topics {
    fn add(
        writer: &mut FileWriter,
        names: &Names,
        sensors: Sensors,
        labelled: bool,
    ) -> Result<Self, WriteError> {
        let mut clouds = |of: bool, names: &[String], name: &str| {
            let names = names.iter().filter(|_| of);
            names.map(|sensor| live(writer, &format!("/{sensor}/{name}"))).collect::<Result<Vec<_>, _>>()
        };
        let labelled = clouds(labelled, &names.radars, "points_labelled")?;
        let radars = clouds(sensors.radar, &names.radars, "points")?;
        let lidars = clouds(sensors.lidar, &names.lidars, "points")?;
        let cameras = names.cameras.iter().filter(|_| sensors.camera).map(|camera| {
            let image = live(writer, &format!("/{camera}/image_raw/compressed"))?;
            Ok((image, live(writer, &format!("/{camera}/camera_info"))?))
        });
        let cameras = cameras.collect::<Result<_, WriteError>>()?;
        let motion = match sensors.any() {
            true => Some((live(writer, "/odom")?, live(writer, "/tf")?)),
            false => None,
        };
        let tf_static = writer.topic("/tf_static", Delivery::Latched)?;
        Ok(Self { tf_static, motion, labelled, radars, lidars, cameras })
    }
}

fn live<M: Message>(writer: &mut FileWriter, name: &str) -> Result<Topic<M>, WriteError> {
    writer.topic(name, Delivery::Live)
}

fn unread(sensor: &str, index: usize) -> impl FnOnce(SourceError) -> DataError {
    move |error| DataError::Measurement { sensor: sensor.to_owned(), index, error }
}
