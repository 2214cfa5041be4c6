//! What a LiDAR scan gives.

use super::Quantity;
use super::values::Values;
use crate::read::SequenceReader;
use ralf::config::Config;
use ralf::scene::Ground;
use ralf::sensors::is_return;
use ralf::space::Point;

/// Points of a scan whose range is taken.
const RANGES: usize = 2000;
/// Of every random choice of the ground's fit.
const SEED: u64 = 0;

/// The values of one scan; the error says why it can't be read.
pub(super) fn values(
    reader: &dyn SequenceReader,
    config: &Config,
    lidar: usize,
    scan: usize,
) -> Result<Values, String> {
    let mount = reader.sequence().rig.lidars[lidar].vehicle_from_lidar;
    let read = reader.lidar_scan(lidar, scan).map_err(|error| error.to_string())?;
    let returns: Vec<Point> = read
        .points
        .iter()
        .filter(|point| is_return(point))
        .map(|[x, y, z]| Point::new((*x).into(), (*y).into(), (*z).into()))
        .collect();
    let mut values = Values::default();
    values.push(Quantity::LidarPoints, returns.len() as f64);
    for point in returns.iter().step_by(returns.len().div_ceil(RANGES).max(1)) {
        values.push(Quantity::LidarRange, point.coords.norm());
    }
    let placed: Vec<Point> = returns.iter().map(|point| mount * point).collect();
    let cloud: Vec<[f32; 3]> = placed.iter().map(|p| [p.x as f32, p.y as f32, p.z as f32]).collect();
    if let Some(ground) = Ground::fit(&cloud, &config.ground, SEED) {
        let low = placed.iter().filter(|p| ground.height(p) < config.ground.lidar_margin).count();
        values.push(Quantity::LidarGround, low as f64 / placed.len() as f64);
    }
    Ok(values)
}
