//! Why a detection got what it got, as bits.

/// A floor detection: lower above the ground than `ground.radar_clearance`. The paper's method calls it an artifact
/// whatever `w` is; a model knows that it lies there, and decides by `w`.
pub const GROUND: u16 = 1;
/// In the LiDAR's blind spot, where the cameras answer.
pub const BLIND_SPOT: u16 = 2;
/// A failed camera view would have seen it.
pub const CAMERA_FAILED: u16 = 4;
/// No LiDAR scan near in time.
pub const NO_LIDAR: u16 = 8;
/// No neighbouring radar scan.
pub const NO_NEIGHBOURS: u16 = 16;
/// No branch could say anything: `w` is 0, the label an artifact's.
pub const UNOBSERVED: u16 = 32;
/// A model was asked for, and the paper's method answered: the evidence is unlike what the model was trained on.
pub const PAPER: u16 = 64;
/// A model was asked, and neither another sensor nor time confirms the radar, though a LiDAR sees as far: beyond the
/// LiDAR's map, or where no ray goes in a single scan of the radar, with no LiDAR point near, or behind a wall.
pub const UNCONFIRMED: u16 = 128;

pub(crate) fn when(applies: bool, flag: u16) -> u16 {
    if applies { flag } else { 0 }
}
