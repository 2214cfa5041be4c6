//! The points of one scan that stand above its ground, thinned.

use super::ground::Floor;

/// Edge of a voxel, m: of the points in one the first stands for all.
pub(super) const VOXEL: f32 = 0.15;

/// A point lower than this above the lowest one near by is ground, m.
const GROUND_BAND: f32 = 0.15;
/// Farther than this beams meet the ground too seldom to tell, m: all points stay.
const DENSE: f32 = 30.0;
/// Slots of the memory for voxels that were seen last.
const SLOTS: usize = 1 << 14;

/// The points of a scan (vehicle frame, m; not finite where there was no return) but those that are surely ground, and
/// most of those that share a voxel with another.
pub(super) fn standing_points(points: &[[f32; 3]], floor: &Floor) -> Vec<[f32; 3]> {
    let mut seen = vec![[i16::MIN; 3]; SLOTS];
    let mut standing = Vec::new();
    for &point in points {
        let [x, y, z] = point;
        // What is not finite, or lies beyond the floor's border, has no floor.
        let Some(below) = floor.at(x, y) else { continue };
        if x * x + y * y < DENSE * DENSE && z - below < GROUND_BAND {
            continue;
        }
        let voxel = point.map(|v| (v / VOXEL).floor() as i16);
        let slot = &mut seen[slot_of(voxel)];
        if *slot != voxel {
            *slot = voxel;
            standing.push(point);
        }
    }
    standing
}

fn slot_of(voxel: [i16; 3]) -> usize {
    let [x, y, z] = voxel.map(|v| v as u16 as u32);
    let mixed = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ z.wrapping_mul(0xC2B2_AE3D);
    (mixed >> 16) as usize % SLOTS
}
