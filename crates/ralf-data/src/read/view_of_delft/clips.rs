//! Which frames were taken in one drive. KITTI's layout says nothing of it; the data set's documentation does
//! (on sensors and data, "Scenes").

use super::raw::Frame;

/// The name of a sequence whose frames are all of one clip, or of none that was published.
const TRAINING: &str = "training";
/// The published clips: number, first and last frame.
const CLIPS: [(u32, u32, u32); 24] = [
    (1, 0, 543),
    (2, 544, 1311),
    (3, 1312, 1802),
    (4, 1803, 2199),
    (6, 2200, 2531),
    (7, 2532, 2797),
    (8, 2798, 3276),
    (9, 3277, 3574),
    (10, 3575, 3609),
    (11, 3610, 4047),
    (12, 4049, 4386),
    (13, 4387, 4651),
    (14, 4652, 5085),
    (16, 6334, 6570),
    (18, 6571, 6758),
    (19, 6759, 7542),
    (20, 7543, 7899),
    (21, 7900, 8197),
    (22, 8198, 8480),
    (23, 8481, 8748),
    (24, 8749, 9095),
    (25, 9096, 9517),
    (26, 9518, 9775),
    (27, 9776, 9930),
];

/// Frames in their order by the clips that they are of, as they are published (`delft_2`). Those of one clip alone are
/// called `training`, after their folder, as are frames that no clip has.
pub(super) fn clips(frames: Vec<Frame>) -> Vec<(String, Vec<Frame>)> {
    let mut clips: Vec<(String, Vec<Frame>)> = Vec::new();
    for frame in frames {
        let name = name(&frame);
        match clips.iter_mut().find(|(known, _)| *known == name) {
            Some((_, frames)) => frames.push(frame),
            None => clips.push((name, vec![frame])),
        }
    }
    if let [(name, _)] = &mut clips[..] {
        TRAINING.clone_into(name);
    }
    clips
}

fn name(frame: &Frame) -> String {
    let clip = CLIPS.iter().find(|(_, first, last)| (*first..=*last).contains(&frame.number));
    clip.map_or_else(|| TRAINING.to_owned(), |(number, ..)| format!("delft_{number}"))
}
