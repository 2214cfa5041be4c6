//! Detections: what they are labelled, how they look, how many there are.

use crate::canvas::Canvas;
use crate::colormap::viridis;
use crate::error::PlotError;
use crate::extent::is_place;
use crate::palette::{ARTIFACT, Ink, PAPER, PLAUSIBLE, UNLABELLED};
use crate::viewport::Viewport;

/// What a detection is labelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MarkLabel {
    /// Belongs to an object.
    Plausible,
    /// Caused by no object at its place.
    Artifact,
    /// Neither, for want of evidence or of a decision.
    Unlabelled,
    /// Of a value, whose colour it has: from 0, dark, the least of the picture's [`ValueScale`](crate::ValueScale), to
    /// 255, bright, its largest.
    Valued(u8),
}

/// A detection, in the frame of its picture. One that is not finite is counted and not drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mark {
    /// Forward in the vehicle frame, m.
    pub x: f64,
    /// To the left in the vehicle frame, m.
    pub y: f64,
    /// What it is labelled.
    pub label: MarkLabel,
}

impl Mark {
    /// x and y, m.
    pub(crate) fn place(&self) -> [f64; 2] {
        [self.x, self.y]
    }
}

/// Detections that can be gone through again and again, in the same order: a slice of them, or a reader that keeps but
/// a part in memory.
pub trait Marks {
    /// Shows each detection.
    ///
    /// # Errors
    /// [`PlotError::Marks`] where they can't be read.
    fn each(&self, see: &mut dyn FnMut(&Mark)) -> Result<(), PlotError>;
}

impl<const N: usize> Marks for [Mark; N] {
    fn each(&self, see: &mut dyn FnMut(&Mark)) -> Result<(), PlotError> {
        self.iter().for_each(see);
        Ok(())
    }
}

impl Marks for Vec<Mark> {
    fn each(&self, see: &mut dyn FnMut(&Mark)) -> Result<(), PlotError> {
        self.iter().for_each(see);
        Ok(())
    }
}

/// How many detections there are of each kind, and how many of them are not seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Counts {
    pub(crate) plausible: usize,
    pub(crate) artifact: usize,
    pub(crate) unlabelled: usize,
    pub(crate) valued: usize,
    /// Without a place.
    pub(crate) nowhere: usize,
    /// Outside the view.
    pub(crate) outside: usize,
}

impl Counts {
    /// Counts the detections of a picture.
    pub(crate) fn of(marks: &[Mark], viewport: &Viewport) -> Self {
        let mut counts = Self::default();
        marks.iter().for_each(|mark| counts.add(mark, viewport));
        counts
    }

    /// Counts one more.
    pub(crate) fn add(&mut self, mark: &Mark, viewport: &Viewport) {
        match mark.label {
            MarkLabel::Plausible => self.plausible += 1,
            MarkLabel::Artifact => self.artifact += 1,
            MarkLabel::Unlabelled => self.unlabelled += 1,
            MarkLabel::Valued(_) => self.valued += 1,
        }
        if !is_place(&mark.place()) {
            self.nowhere += 1;
        } else if !viewport.contains(viewport.pixel_from_world(mark.place()), 0.0) {
            self.outside += 1;
        }
    }

    /// All of them.
    pub(crate) fn all(&self) -> usize {
        self.plausible + self.artifact + self.unlabelled + self.valued
    }
}

/// Draws one detection: plausible a disc, artifact a cross, unlabelled a ring, one of a value a disc in its colour,
/// each with a thin white edge.
pub(crate) fn draw(canvas: &mut Canvas, at: [f32; 2], radius: f32, label: MarkLabel) {
    let edge = radius * 0.22;
    let halo = PAPER.with_alpha(190);
    match label {
        MarkLabel::Plausible => {
            canvas.disc(at, radius + edge, halo);
            canvas.disc(at, radius, PLAUSIBLE);
        }
        MarkLabel::Valued(shade) => {
            canvas.disc(at, radius + edge, halo);
            canvas.disc(at, radius, Ink { rgb: viridis(f64::from(shade) / 255.0), alpha: 255 });
        }
        MarkLabel::Artifact => {
            let (arm, line) = (radius * 0.78, radius * 0.5);
            canvas.cross(at, arm, line + edge * 1.5, halo);
            canvas.cross(at, arm, line, ARTIFACT);
        }
        MarkLabel::Unlabelled => {
            canvas.circle(at, radius * 0.75, radius * 0.4, UNLABELLED);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extent::Window;

    #[test]
    fn every_detection_is_counted_seen_or_not() {
        let viewport = Viewport::showing(&Window { centre: [0.0; 2], half: [10.0; 2] }, [40, 40]);
        let mark = |x, label| Mark { x, y: 0.0, label };
        let marks = [
            mark(1.0, MarkLabel::Plausible),
            mark(11.0, MarkLabel::Plausible),
            mark(f64::NAN, MarkLabel::Artifact),
            mark(-9.0, MarkLabel::Unlabelled),
        ];
        let counts = Counts::of(&marks, &viewport);
        assert_eq!(
            counts,
            Counts { plausible: 2, artifact: 1, unlabelled: 1, valued: 0, nowhere: 1, outside: 1 }
        );
        assert_eq!(counts.all(), 4);
    }
}
