//! People on foot and on bicycles: many small parts, each with a motion of its own, so that a radar of fine cells hears
//! several of them.
//!
//! Measured, View-of-Delft: 4 to 8 detections of a person 13 to 20 m away, whose range rates differ by 0.1 to 0.4 m/s,
//! and 10 to 14 of a cyclist 9 to 17 m away, spread by 0.1 to 0.3 m/s about the bicycle's own.

use super::Parts;

/// How fast a body sways, m/s (measured, see above).
const SWAY: f64 = 0.1;

/// A trunk, arms, and legs whose feet swing as far ahead as the body moves on.
pub(super) fn on_foot(w: f64, height: f64, parts: &mut Parts<'_>) {
    let trunk = [0.45 * height, 0.95 * height];
    limb(6, [0.6 * w, 0.8 * w], trunk, -17.0, 0.0, parts);
    limb(4, [w, w], [0.4 * height, 0.8 * height], -20.0, 0.5, parts);
    limb(6, [w, 0.6 * w], [0.03 * height, 0.45 * height], -18.0, 1.0, parts);
}

/// A rider who pedals, a frame, and wheels whose tops go twice as fast as the bicycle.
pub(super) fn on_bicycle(l: f64, w: f64, height: f64, parts: &mut Parts<'_>) {
    limb(6, [0.3 * l, 0.7 * w], [0.55 * height, 0.95 * height], -15.0, 0.0, parts);
    limb(3, [0.3 * l, 0.5 * w], [0.15 * height, 0.5 * height], -18.0, 0.4, parts);
    limb(8, [0.7 * l, 0.3 * w], [0.2 * height, 0.6 * height], -12.0, 0.0, parts);
    for x in [-0.62 * l, 0.62 * l] {
        for _ in 0..3 {
            let random = &mut parts.random;
            let (forth, up) = (random.between(-0.33, 0.33), random.between(0.05, 0.65));
            parts.put([x + forth, 0.0, up], None, -14.0, 4.0).swing = 1.0;
        }
    }
}

/// So many parts anywhere within a box, which swing by a share of the motion.
fn limb(
    count: usize,
    half: [f64; 2],
    heights: [f64; 2],
    strength_db: f64,
    swing: f64,
    parts: &mut Parts<'_>,
) {
    let from = parts.found.len();
    parts.scatter(count, half, heights, strength_db, 4.0);
    for part in &mut parts.found[from..] {
        (part.swing, part.sway) = (swing, SWAY);
    }
}
