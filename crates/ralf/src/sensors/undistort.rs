//! Straightening: a view cut out of a raw image through a map that is computed once per camera and view
//! (docs/method.md, section 5).

use super::image::CameraImage;
use super::intrinsics::Intrinsics;
use super::view::StraightView;
use crate::space::Point;
use std::array;
use wide::{i16x8, i32x4, i32x8, u8x16};

/// For every pixel of a view where it lies in the raw image.
#[derive(Debug, Clone)]
pub struct UndistortMap {
    /// Size of the raw image, px.
    source: [usize; 2],
    /// Size of the view, px.
    target: [usize; 2],
    /// One per pixel of the view, row by row; what fills up the last group lies nowhere.
    taps: Vec<[Tap; LANES]>,
}

/// So many pixels are interpolated side by side.
const LANES: usize = 4;

/// The four raw pixels around a place, and how much of the right and the lower ones.
#[derive(Debug, Clone, Copy)]
struct Tap {
    /// Place of the upper left one in the raw image, row by row; [`OUTSIDE`] where there is none.
    place: u32,
    /// How much the right ones count, in parts of [`ONE`].
    right: u16,
    /// How much the lower ones count, in parts of [`ONE`].
    down: u16,
}

const OUTSIDE: u32 = u32::MAX;
/// Weights are fractions of this: a place is kept to 1/256 px.
const ONE: u16 = 256;

impl UndistortMap {
    /// The map from a raw image of `width` by `height` px to a straight view.
    ///
    /// A place outside the raw image (farther than half a pixel from its outermost pixels' centres), or one that the
    /// lens doesn't see, becomes black. An image needs two rows and two columns for anything to lie between.
    pub fn new(intrinsics: &Intrinsics, width: usize, height: usize, view: &StraightView) -> Self {
        let limit = intrinsics.limit();
        let count = view.width * view.height;
        let tap = |pixel: usize| {
            let [column, row] = [pixel % view.width, pixel / view.width];
            let ray = view.camera_from_view * view.ray([column as f64, row as f64]);
            let place = intrinsics.project_within(&Point::from(ray), limit);
            place.and_then(|[u, v]| Tap::new(u, v, width, height)).unwrap_or(Tap::NOTHING)
        };
        let in_view = |pixel: usize| if pixel < count { tap(pixel) } else { Tap::NOTHING };
        let taps = (0..count).step_by(LANES).map(|first| array::from_fn(|lane| in_view(first + lane)));
        let taps = taps.collect();
        Self { source: [width, height], target: [view.width, view.height], taps }
    }

    /// The straight view of an image, interpolated between the four nearest pixels and rounded. The error says which
    /// size of image was expected.
    pub fn apply(&self, image: &CameraImage) -> Result<CameraImage, String> {
        let [width, height] = self.source;
        if [image.width, image.height] != self.source || image.rgb.len() != width * height {
            let ([found_width, found_height], pixels) = ([image.width, image.height], image.rgb.len());
            return Err(format!(
                "an image of {width} x {height} px, found {found_width} x {found_height} px with {pixels} pixels"
            ));
        }
        let rows = Rows::new(image.rgb.as_flattened(), 3 * width);
        let mut rgb = self.taps.iter().map(|taps| rows.sample(taps)).collect::<Vec<_>>().into_flattened();
        rgb.truncate(self.target[0] * self.target[1]);
        Ok(CameraImage { width: self.target[0], height: self.target[1], rgb })
    }
}

impl Tap {
    const NOTHING: Self = Self { place: OUTSIDE, right: 0, down: 0 };

    fn new(u: f64, v: f64, width: usize, height: usize) -> Option<Self> {
        let (column, right) = split(u, width)?;
        let (row, down) = split(v, height)?;
        let place = u32::try_from(row * width + column).ok()?;
        Some(Self { place, right, down })
    }
}

/// The weights of four pixels together; each fits 16 bits with a sign.
const WEIGHTS: i32 = 1 << WEIGHT_BITS;
const WEIGHT_BITS: i32 = 13;

/// How much the four pixels around each of some places count.
struct Weights {
    /// Of the two left ones: the upper one's in the lower half of a number, the lower one's in the upper half.
    left: [i32; LANES],
    /// Of the two right ones.
    right: [i32; LANES],
}

impl Weights {
    #[inline]
    fn new(taps: &[Tap; LANES]) -> Self {
        let right = i32x4::new(taps.map(|tap| i32::from(tap.right)));
        let down = i32x4::new(taps.map(|tap| i32::from(tap.down)));
        // The four weights add up to WEIGHTS whatever is rounded, so that even areas stay as they are.
        let [right_halves, down_halves]: [i16x8; 2] = bytemuck::cast([right, down]);
        let both = (right_halves.dot(down_halves) + i32x4::splat(4)) >> 3_i32;
        let (right, down) = ((right << 5_i32) - both, (down << 5_i32) - both);
        let upper_left = i32x4::splat(WEIGHTS) - right - down - both;
        Self { left: (upper_left | down << 16_i32).to_array(), right: (right | both << 16_i32).to_array() }
    }
}

/// The bytes of a raw image, and the same from the second row on: a pixel and the one below it have the same place.
struct Rows<'a> {
    upper: &'a [u8],
    lower: &'a [u8],
}

impl<'a> Rows<'a> {
    /// Of an image whose rows are so many bytes long.
    fn new(bytes: &'a [u8], row: usize) -> Self {
        let lower = bytes.get(row..).unwrap_or_default();
        Self { upper: &bytes[..lower.len()], lower }
    }

    /// The interpolated pixels at some places; black outside.
    #[inline]
    fn sample(&self, taps: &[Tap; LANES]) -> [[u8; 3]; LANES] {
        let around = |lane: usize| self.around(taps[lane].place);
        let all = || Some([around(0)?, around(1)?, around(2)?, around(3)?]);
        all().map_or_else(|| self.sample_at_the_border(taps), |around| blended(taps, around))
    }

    /// Two neighbouring pixels and a byte more, and the same below them; `None` outside, and where the image ends with
    /// these pixels.
    #[inline]
    fn around(&self, place: u32) -> Option<[&'a [u8; 7]; 2]> {
        let first = 3 * place as usize;
        let upper = self.upper.get(first..first + 7)?;
        let lower = self.lower.get(first..first + 7)?;
        Some([upper.first_chunk()?, lower.first_chunk()?])
    }

    /// As [`Self::sample`], where some of the places lie outside or at the image's end.
    #[cold]
    #[inline(never)]
    fn sample_at_the_border(&self, taps: &[Tap; LANES]) -> [[u8; 3]; LANES] {
        let around = taps.map(|tap| {
            let first = 3 * tap.place as usize;
            [self.upper, self.lower].map(|row| {
                let mut pixels = [0; 7];
                if let Some(found) = row.get(first..first + 6) {
                    pixels[..6].copy_from_slice(found);
                }
                pixels
            })
        });
        blended(taps, around.each_ref().map(|[upper, lower]| [upper, lower]))
    }
}

/// The interpolated pixels at some places, each of the two pixels above and the two below.
#[inline]
fn blended(taps: &[Tap; LANES], around: [[&[u8; 7]; 2]; LANES]) -> [[u8; 3]; LANES] {
    let Weights { left, right } = Weights::new(taps);
    let sum = |lane: usize| {
        let left = above_one_another::<0>(around[lane]).dot(halves(left[lane]));
        let right = above_one_another::<3>(around[lane]).dot(halves(right[lane]));
        (left + right + i32x4::splat(WEIGHTS / 2)) >> WEIGHT_BITS
    };
    side_by_side([sum(0), sum(1), sum(2), sum(3)])
}

/// A pixel and the one below it channel by channel, from a byte on: red of both, green of both, blue of both, and what
/// doesn't matter.
#[inline]
fn above_one_another<const FIRST: usize>(rows: [&[u8; 7]; 2]) -> i16x8 {
    let [upper, lower] = rows.map(|row| {
        let pixel = [row[FIRST], row[FIRST + 1], row[FIRST + 2], row[FIRST + 3]];
        bytemuck::cast::<_, u8x16>([u32::from_ne_bytes(pixel), 0, 0, 0])
    });
    i16x8::from_u8x16_low(u8x16::unpack_low(upper, lower))
}

/// Two weights in turn.
#[inline]
fn halves(both: i32) -> i16x8 {
    bytemuck::cast(i32x4::splat(both))
}

/// Pixels side by side, of numbers that fit a byte, three of four.
#[inline]
fn side_by_side([a, b, c, d]: [i32x4; LANES]) -> [[u8; 3]; LANES] {
    let two = |a, b| i16x8::from_i32x8_saturate(bytemuck::cast::<_, i32x8>([a, b]));
    let bytes = u8x16::narrow_i16x8(two(a, b), two(c, d));
    let [a, b, c, d] = bytemuck::cast::<_, [u32; LANES]>(bytes).map(u32::from_le);
    let words = [a & 0xff_ffff | b << 24, b >> 8 & 0xffff | c << 16, c >> 16 & 0xff | d << 8];
    bytemuck::cast(words.map(u32::to_le))
}

/// The pixel before a coordinate that has a successor, and the successor's share; `None` outside the image, and where
/// no two pixels are.
fn split(coordinate: f64, size: usize) -> Option<(usize, u16)> {
    let last = size.checked_sub(2)?;
    if !(coordinate >= -0.5 && coordinate < size as f64 - 0.5) {
        return None;
    }
    let fixed = (coordinate.clamp(0.0, size as f64 - 1.0) * f64::from(ONE)).round() as usize;
    let whole = (fixed / usize::from(ONE)).min(last);
    Some((whole, (fixed - whole * usize::from(ONE)) as u16))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::View;
    use proptest::prelude::*;

    fn straight(width: usize, height: usize, horizontal_fov: f64) -> StraightView {
        StraightView::from(&View { yaw: 0.2, pitch: -0.1, horizontal_fov, width, height })
    }

    fn noise(width: usize, height: usize) -> CameraImage {
        let value = |i: usize| (i.wrapping_mul(2_654_435_761) >> 7) as u8;
        let rgb = (0..width * height).map(|i| [value(3 * i), value(3 * i + 1), value(3 * i + 2)]).collect();
        CameraImage { width, height, rgb }
    }

    /// Interpolation in floating point, at the place to 1/256 px.
    fn naive(image: &CameraImage, place: Option<[f64; 2]>) -> [f64; 3] {
        let [width, height] = [image.width as f64, image.height as f64];
        let inside = |[u, v]: &[f64; 2]| *u >= -0.5 && *v >= -0.5 && *u < width - 0.5 && *v < height - 0.5;
        let Some([u, v]) = place.filter(inside) else { return [0.0; 3] };
        let kept = |value: f64, size: f64| (value.clamp(0.0, size - 1.0) * 256.0).round() / 256.0;
        let [u, v] = [kept(u, width), kept(v, height)];
        std::array::from_fn(|channel| {
            let at = |column: f64, row: f64| {
                let [column, row] = [column.min(width - 1.0) as usize, row.min(height - 1.0) as usize];
                f64::from(image.rgb[row * image.width + column][channel])
            };
            let (x, y) = (u.fract(), v.fract());
            let row = |row: f64| at(u.floor(), row) * (1.0 - x) + at(u.floor() + 1.0, row) * x;
            row(v.floor()) * (1.0 - y) + row(v.floor() + 1.0) * y
        })
    }

    proptest! {
        #[test]
        fn it_is_what_the_naive_way_gives(
            width in 2_usize..40, height in 2_usize..40, focal in 3.0..60.0, fov in 0.3..3.0, k in -0.05..0.05,
        ) {
            let center = [width as f64 / 2.1, height as f64 / 1.9];
            let lens = Intrinsics::KannalaBrandt { focal: [focal; 2], center, distortion: [k, 0.0, 0.0, 0.0] };
            let (image, view) = (noise(width, height), straight(31, 21, fov));
            let found = UndistortMap::new(&lens, width, height, &view).apply(&image).unwrap();
            prop_assert_eq!((found.width, found.height, found.rgb.len()), (31, 21, 651));
            for (i, pixel) in found.rgb.iter().enumerate() {
                let ray = view.camera_from_view * view.ray([(i % 31) as f64, (i / 31) as f64]);
                let expected = naive(&image, lens.project(&Point::from(ray)));
                for (a, b) in pixel.iter().zip(expected) {
                    // Rounded to a whole number, from weights that are rounded to 1/8192.
                    prop_assert!((f64::from(*a) - b).abs() <= 0.55, "pixel {}: {:?} {:?}", i, pixel, expected);
                }
            }
        }
    }

    #[test]
    fn an_image_seen_by_its_own_pinhole_stays_as_it_is() {
        let image = noise(32, 24);
        let view =
            StraightView::from(&View { yaw: 0.0, pitch: 0.0, horizontal_fov: 1.2, width: 32, height: 24 });
        let lens = Intrinsics::Pinhole { focal: [view.focal; 2], center: view.center, distortion: [0.0; 5] };
        assert_eq!(UndistortMap::new(&lens, 32, 24, &view).apply(&image).unwrap(), image);
    }

    #[test]
    fn an_image_of_another_size_is_refused() {
        let lens = Intrinsics::Pinhole { focal: [20.0; 2], center: [16.0, 12.0], distortion: [0.0; 5] };
        let map = UndistortMap::new(&lens, 32, 24, &straight(8, 8, 1.0));
        let error = map.apply(&noise(24, 32)).unwrap_err();
        assert!(error.contains("32 x 24") && error.contains("found 24 x 32 px"), "{error}");
        assert!(map.apply(&CameraImage { width: 32, height: 24, rgb: vec![] }).is_err());
    }

    #[test]
    fn the_border_is_held_and_ends_half_a_pixel_out() {
        assert_eq!(split(-0.5, 10), Some((0, 0)));
        assert_eq!(split(-0.51, 10), None);
        assert_eq!(split(3.25, 10), Some((3, 64)));
        assert_eq!(split(9.49, 10), Some((8, 256)));
        assert_eq!(split(9.5, 10), None);
        assert_eq!(split(0.2, 1), None);
        assert_eq!(split(f64::NAN, 10), None);
    }
}
