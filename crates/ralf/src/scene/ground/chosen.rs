//! Which of many points something holds of. That is hard to foretell, so that it is told without a branch.

/// So many points are looked at together.
pub(super) const BLOCK: usize = 256;

/// The places in a list of those points that something holds of.
pub(in crate::scene) fn ids_where(points: &[[f32; 3]], holds: impl Fn(&[f32; 3]) -> bool) -> Vec<u32> {
    let mut ids = Vec::with_capacity(points.len());
    let mut room = [0; BLOCK];
    for (block, first) in points.chunks(BLOCK).zip((0u32..).step_by(BLOCK)) {
        ids.extend(places_where(&mut room, block.iter().map(&holds)).iter().map(|place| first + place));
    }
    ids
}

/// The places in a block of those that something holds of; there is room for them.
pub(super) fn places_where(room: &mut [u32; BLOCK], holds: impl Iterator<Item = bool>) -> &[u32] {
    let mut answers = [false; BLOCK];
    // Each is written down, and the next one over it unless it holds.
    let mut count = 0;
    for (place, holds) in (0u32..).zip(answered(&mut answers, holds)) {
        room[count % BLOCK] = place;
        count += usize::from(*holds);
    }
    &room[..count]
}

/// The points of a block that something holds of, appended to columns, a coordinate each.
pub(super) fn extend_where(
    columns: &mut [Vec<f32>; 3],
    block: &[[f32; 3]],
    holds: impl Fn(&[f32; 3]) -> bool,
) {
    let mut answers = [false; BLOCK];
    let mut kept = [[0.0; BLOCK]; 3];
    let mut count = 0;
    for (point, holds) in block.iter().zip(answered(&mut answers, block.iter().map(holds))) {
        for (kept, value) in kept.iter_mut().zip(point) {
            kept[count % BLOCK] = *value;
        }
        count += usize::from(*holds);
    }
    for (column, kept) in columns.iter_mut().zip(&kept) {
        column.extend_from_slice(&kept[..count]);
    }
}

/// All answers of a block, in a loop that the compiler turns into vectors.
fn answered(room: &mut [bool; BLOCK], holds: impl Iterator<Item = bool>) -> &[bool] {
    let mut asked = 0;
    for (answer, holds) in room.iter_mut().zip(holds) {
        *answer = holds;
        asked += 1;
    }
    &room[..asked]
}
