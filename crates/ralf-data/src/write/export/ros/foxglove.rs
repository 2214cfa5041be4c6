//! A layout for Foxglove beside an export: the labelled clouds coloured by plausibility, seen from behind the vehicle.

use super::names::{self, LABELLED, POINTS, VEHICLE};
use crate::disk::files;
use crate::error::DataError;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The file in an export's folder.
pub(in crate::write::export) const FILE: &str = "foxglove.json";
const SCENE: &str = "3D!ralf";

/// What the sequences of an export have to show.
#[derive(Default)]
pub(super) struct Layout {
    /// The clouds by topic, with how they are drawn.
    clouds: Map<String, Value>,
    /// Topics of images, without those of their calibrations.
    cameras: Vec<String>,
}

impl Layout {
    /// Adds a sequence's sensors, with the data of those that are asked for.
    pub(super) fn add(&mut self, names: &names::Names, sensors: super::Sensors) {
        for radar in &names.radars {
            let labelled = json!({
                "visible": true, "colorMode": "colormap", "colorMap": "turbo", "colorField": "plausibility",
                "minValue": 0, "maxValue": 1, "pointSize": 7, "pointShape": "circle",
            });
            self.clouds.insert(names::cloud(radar, LABELLED), labelled);
        }
        for lidar in names.lidars.iter().filter(|_| sensors.lidar) {
            let grey =
                json!({"visible": true, "colorMode": "flat", "flatColor": "#9aa0a6aa", "pointSize": 1.5});
            self.clouds.insert(names::cloud(lidar, POINTS), grey);
        }
        let cameras = names.cameras.iter().filter(|camera| sensors.camera && !self.cameras.contains(camera));
        let new: Vec<String> = cameras.cloned().collect();
        self.cameras.extend(new);
    }

    /// Writes it into a folder.
    pub(super) fn write(&self, file: &Path) -> Result<(), DataError> {
        let text = serde_json::to_string_pretty(&self.json()).map_err(std::io::Error::from);
        files::write_whole(file, (text.map_err(DataError::io(file))? + "\n").as_bytes())
    }

    fn json(&self) -> Value {
        let scene = json!({
            "cameraState": {
                "perspective": true, "distance": 70, "phi": 55, "thetaOffset": 90, "target": [0, 0, 0],
                "targetOffset": [15, 0, 0], "targetOrientation": [0, 0, 0, 1], "fovy": 45, "near": 0.5, "far": 5000,
            },
            "followMode": "follow-pose", "followTf": VEHICLE,
            "scene": {"backgroundColor": "#101216"}, "transforms": {}, "topics": self.clouds,
            "layers": {"grid": {"layerId": "foxglove.Grid", "instanceId": "grid", "visible": true, "frameId": VEHICLE,
                                "size": 100, "divisions": 10, "lineWidth": 1, "color": "#3c404666"}},
        });
        let mut panels = Map::from_iter([(SCENE.to_owned(), scene)]);
        let mut column: Option<Value> = None;
        for camera in self.cameras.iter().rev() {
            let panel = format!("Image!{camera}");
            let mode = json!({"imageMode": {"imageTopic": names::image(camera),
                                            "calibrationTopic": names::camera_info(camera)}});
            panels.insert(panel.clone(), mode);
            column = Some(match column {
                None => json!(panel),
                Some(below) => json!({"direction": "column", "first": panel, "second": below}),
            });
        }
        let layout = match column {
            None => json!(SCENE),
            Some(images) => {
                json!({"direction": "row", "first": SCENE, "second": images, "splitPercentage": 70})
            }
        };
        json!({"configById": panels, "globalVariables": {}, "userNodes": {}, "playbackConfig": {"speed": 1},
               "layout": layout})
    }
}
