//! Very many points as a density: each adds a small dot to a buffer, which is then inked once. Millions take a second.

use crate::canvas::Canvas;
use crate::palette::Ink;
use crate::viewport::Viewport;

/// How many dots lie on each pixel; a dot's edge counts in part.
pub(crate) struct DotField {
    size: [usize; 2],
    weight: Vec<f32>,
}

/// Opacity of a lone dot where others are crowded.
const LONE: f32 = 0.35;
/// Part of the inked pixels that are less crowded than those drawn in full ink.
const FULL_AT: f64 = 0.99;

impl DotField {
    /// A dot of `radius` pixels for each place (x, y in m); places outside the view are left out.
    pub(crate) fn of(places: impl Iterator<Item = [f64; 2]>, viewport: &Viewport, radius: f32) -> Self {
        let mut field = Self::empty(viewport);
        places.for_each(|place| field.add_place(place, viewport, radius));
        field
    }

    /// No dots yet.
    pub(crate) fn empty(viewport: &Viewport) -> Self {
        let size = viewport.size().map(|pixels| pixels as usize);
        Self { size, weight: vec![0.0; size[0] * size[1]] }
    }

    /// One dot more, unless it lies outside the view.
    pub(crate) fn add_place(&mut self, place: [f64; 2], viewport: &Viewport, radius: f32) {
        let pixel = viewport.pixel_from_world(place);
        if viewport.contains(pixel, -radius) {
            self.add(pixel, radius);
        }
    }

    fn add(&mut self, [x, y]: [f32; 2], radius: f32) {
        let reach = radius + 0.5;
        let span = |centre: f32, size: usize| {
            let last = (centre + reach).ceil().max(0.0) as usize;
            (centre - reach).floor().max(0.0) as usize..last.min(size)
        };
        for row in span(y, self.size[1]) {
            for column in span(x, self.size[0]) {
                let distance = (column as f32 + 0.5 - x).hypot(row as f32 + 0.5 - y);
                self.weight[row * self.size[0] + column] += (reach - distance).clamp(0.0, 1.0);
            }
        }
    }

    /// The weight from which pixels are drawn in full ink.
    pub(crate) fn full(&self) -> f32 {
        let mut inked: Vec<f32> = self.weight.iter().copied().filter(|weight| *weight > 0.0).collect();
        let Some(last) = inked.len().checked_sub(1) else { return 1.0 };
        let at = (last as f64 * FULL_AT) as usize;
        let (_, full, _) = inked.select_nth_unstable_by(at, f32::total_cmp);
        full.max(1.0)
    }

    /// Inks the canvas: the more dots on a pixel the darker, up to `full`, on a logarithmic scale.
    pub(crate) fn paint(&self, canvas: &mut Canvas, ink: Ink, full: f32) {
        for (index, weight) in self.weight.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            let pixel = [index % self.size[0], index / self.size[0]].map(|edge| edge as i64);
            canvas.blend(pixel, ink, opacity(*weight, full));
        }
    }
}

fn opacity(weight: f32, full: f32) -> f32 {
    let crowded = weight.ln_1p() / full.ln_1p();
    (LONE * weight.min(1.0) + (1.0 - LONE) * crowded).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::extent::Window;
    use crate::palette::{PAPER, PLAUSIBLE};

    fn view() -> Viewport {
        Viewport::showing(&Window { centre: [0.0; 2], half: [10.0; 2] }, [40, 40])
    }

    #[test]
    fn opacity_grows_with_the_crowd() {
        assert_eq!([opacity(0.0, 9.0), opacity(9.0, 9.0), opacity(90.0, 9.0)], [0.0, 1.0, 1.0]);
        assert_eq!(opacity(1.0, 1.0), 1.0);
        assert!(opacity(1.0, 1e6) >= LONE && opacity(2.0, 9.0) < opacity(3.0, 9.0));
    }

    #[test]
    fn lone_dots_are_full_ink_and_the_rest_stays_white() {
        let field = DotField::of([[5.0, 5.0], [f64::NAN, 0.0], [500.0, 0.0]].into_iter(), &view(), 2.0);
        assert_eq!(field.full(), 1.0);
        let mut canvas = Canvas::new([40, 40]).unwrap();
        field.paint(&mut canvas, PLAUSIBLE, field.full());
        assert_eq!(canvas.rgb([10, 10]), PLAUSIBLE.rgb);
        let inked = (0..1600).filter(|index| canvas.rgb([index % 40, index / 40]) != PAPER.rgb).count();
        assert!((12..=24).contains(&inked), "{inked}");
    }

    #[test]
    fn dots_on_the_edge_are_cut() {
        let corners = [[10.0, 10.0], [-10.0, -10.0], [10.0, -10.0], [-10.0, 10.0]];
        let field = DotField::of(corners.into_iter(), &view(), 3.0);
        for index in [0, 39, 39 * 40, 1599] {
            assert!(field.weight[index] > 0.9, "{index}");
        }
    }
}
