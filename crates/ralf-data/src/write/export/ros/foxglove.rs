//! A layout for Foxglove beside an export: the labelled clouds coloured by plausibility, seen from behind the vehicle.

use super::names::{self, LABELLED, POINTS, VEHICLE};
use crate::disk::files;
use crate::error::DataError;
use crate::write::export::columns::{ARTIFACT, PLAUSIBLE};
use serde_json::{Map, Value, json};
use std::path::Path;

/// The file in an export's folder.
pub(in crate::write::export) const FILE: &str = "foxglove.json";
const SCENE: &str = "3D!ralf";

/// What the sequences of an export have to show.
#[derive(Default)]
pub(super) struct Layout {
    /// The labelled clouds by topic, with how they are drawn.
    labelled: Map<String, Value>,
    /// The clouds of LiDARs.
    lidars: Map<String, Value>,
    /// Topics of images, without those of their calibrations.
    cameras: Vec<String>,
}

impl Layout {
    /// Adds a sequence's sensors, with the data of those that are asked for.
    pub(super) fn add(&mut self, names: &names::Names, sensors: super::Sensors) {
        let colour = |rgba: u32| format!("#{rgba:08x}");
        for radar in &names.radars {
            let labelled = json!({
                "visible": true, "colorMode": "gradient", "colorField": "plausibility", "minValue": 0, "maxValue": 1,
                "gradient": [colour(ARTIFACT), colour(PLAUSIBLE)], "pointSize": 7, "pointShape": "circle",
            });
            self.labelled.insert(names::cloud(radar, LABELLED), labelled);
        }
        for lidar in names.lidars.iter().filter(|_| sensors.lidar) {
            // Without a field Foxglove takes one, and colours by it.
            let grey = json!({"visible": true, "colorMode": "flat", "flatColor": "#9aa0a6aa", "colorField": "intensity",
                              "pointSize": 1.5});
            self.lidars.insert(names::cloud(lidar, POINTS), grey);
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
        let clouds = self.lidars.iter().chain(&self.labelled);
        let topics: Map<String, Value> =
            clouds.map(|(topic, drawn)| (topic.clone(), drawn.clone())).collect();
        let scene = json!({
            "cameraState": {
                "perspective": true, "distance": 70, "phi": 55, "thetaOffset": 90, "target": [0, 0, 0],
                "targetOffset": [15, 0, 0], "targetOrientation": [0, 0, 0, 1], "fovy": 45, "near": 0.5, "far": 5000,
            },
            "followMode": "follow-pose", "followTf": VEHICLE,
            "scene": {"backgroundColor": "#101216", "transforms": {"showLabel": false, "lineWidth": 0}},
            "transforms": {}, "topics": topics,
            "layers": {"grid": {"layerId": "foxglove.Grid", "instanceId": "grid", "visible": true, "frameId": VEHICLE,
                                "size": 100, "divisions": 10, "lineWidth": 1, "color": "#3c404666"}},
        });
        let mut panels = Map::from_iter([(SCENE.to_owned(), scene)]);
        let mut column: Option<Value> = None;
        for (below, camera) in self.cameras.iter().rev().enumerate() {
            let panel = format!("Image!{camera}");
            panels.insert(panel.clone(), self.image(camera));
            column = Some(match column {
                None => json!(panel),
                Some(others) => json!({"direction": "column", "first": panel, "second": others,
                                       "splitPercentage": 100.0 / (below + 1) as f64}),
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

    /// A camera's images with the labelled detections in them.
    fn image(&self, camera: &str) -> Value {
        json!({"imageMode": {"imageTopic": names::image(camera), "calibrationTopic": names::camera_info(camera)},
               "topics": self.labelled})
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_share_a_column_equally_and_show_the_labels() {
        let list = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let (radars, lidars) = (list(&["radar"]), list(&["lidar"]));
        let names = names::Names { radars, lidars, cameras: list(&["a", "b", "c"]) };
        let mut layout = Layout::default();
        layout.add(&names, super::super::Sensors::ALL);
        layout.add(&names, super::super::Sensors::ALL);
        let json = layout.json();
        let column = &json["layout"]["second"];
        assert_eq!(
            (column["first"].as_str(), column["second"]["first"].as_str()),
            (Some("Image!a"), Some("Image!b"))
        );
        assert_eq!(column["second"]["second"], "Image!c");
        let shares =
            [column, &column["second"]].map(|place| place["splitPercentage"].as_f64().unwrap().round());
        assert_eq!(shares, [33.0, 50.0]);
        let panels = &json["configById"];
        assert_eq!(panels["Image!b"]["imageMode"]["calibrationTopic"], "/b/camera_info");
        let drawn = &panels["Image!b"]["topics"];
        assert_eq!(drawn["/radar/points_labelled"]["gradient"], json!(["#f0803cff", "#4ba8eaff"]));
        assert_eq!(
            (drawn.get("/lidar/points"), panels[SCENE]["topics"].as_object().unwrap().len()),
            (None, 2)
        );
    }
}
