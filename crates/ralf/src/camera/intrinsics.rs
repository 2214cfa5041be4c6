//! Camera models: how a direction in the optical frame becomes a pixel.

/// A camera model with its parameters, in pixels. Pixel centres lie at integers.
#[derive(Debug, Clone, PartialEq)]
pub enum Intrinsics {
    /// Pinhole with Brown-Conrady distortion k1 k2 p1 p2 k3.
    Pinhole {
        /// Focal lengths.
        focal: [f64; 2],
        /// Principal point.
        center: [f64; 2],
        /// k1 k2 p1 p2 k3.
        distortion: [f64; 5],
    },
    /// Kannala-Brandt, as OpenCV's fisheye module has it.
    KannalaBrandt {
        /// Focal lengths.
        focal: [f64; 2],
        /// Principal point.
        center: [f64; 2],
        /// k1 k2 k3 k4.
        distortion: [f64; 4],
    },
    /// Scaramuzza's polynomial, as OCamCalib writes it: axes X down, Y right, Z backward.
    Scaramuzza {
        /// Radius (px) to z, ascending; empty where only the inverse is known.
        polynomial: Vec<f64>,
        /// Angle (rad) to radius (px), ascending.
        inverse_polynomial: Vec<f64>,
        /// Row and column, from 0.
        center: [f64; 2],
        /// c, d, e.
        affine: [f64; 3],
    },
}

/// A straight (pinhole) view cut out of a camera's image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Turned by this about the camera's vertical, rad, positive to the left; applied first.
    pub yaw: f64,
    /// Then about its horizontal, rad, positive down.
    pub pitch: f64,
    /// Full horizontal angle, rad.
    pub horizontal_fov: f64,
    /// px.
    pub width: usize,
    /// px.
    pub height: usize,
}
