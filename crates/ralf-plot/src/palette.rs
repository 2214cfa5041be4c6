//! The colours. Those of the labels are from Okabe and Ito's palette, made to be told apart with any colour vision.

/// A colour, not premultiplied.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Ink {
    /// Red, green, blue.
    pub(crate) rgb: [u8; 3],
    /// Opacity.
    pub(crate) alpha: u8,
}

impl Ink {
    const fn opaque(hex: u32) -> Self {
        let [_, red, green, blue] = hex.to_be_bytes();
        Self { rgb: [red, green, blue], alpha: 255 }
    }

    /// The same colour with another opacity.
    pub(crate) const fn with_alpha(self, alpha: u8) -> Self {
        Self { alpha, ..self }
    }
}

pub(crate) const PAPER: Ink = Ink::opaque(0xFF_FF_FF);
pub(crate) const TITLE: Ink = Ink::opaque(0x1B_1F_24);
pub(crate) const TEXT: Ink = Ink::opaque(0x3A_42_4C);
pub(crate) const FAINT_TEXT: Ink = Ink::opaque(0x6B_74_80);
pub(crate) const FRAME: Ink = Ink::opaque(0xC3_CA_D3);
pub(crate) const GRID: Ink = Ink::opaque(0xE9_EC_F0);
pub(crate) const RING: Ink = Ink::opaque(0xDB_E0_E7);
pub(crate) const LIDAR: Ink = Ink::opaque(0xA3_A9_B1);
pub(crate) const VEHICLE: Ink = Ink::opaque(0xF4_F6_F8);
pub(crate) const VEHICLE_GLASS: Ink = Ink::opaque(0xB9_C3_CF);
pub(crate) const VEHICLE_EDGE: Ink = Ink::opaque(0x2B_31_39);
pub(crate) const RADAR: Ink = Ink::opaque(0x00_9E_73);
pub(crate) const PATH: Ink = Ink::opaque(0x2B_31_39);

/// Okabe and Ito's blue.
pub(crate) const PLAUSIBLE: Ink = Ink::opaque(0x00_72_B2);
/// Okabe and Ito's vermilion.
pub(crate) const ARTIFACT: Ink = Ink::opaque(0xD5_5E_00);
pub(crate) const UNLABELLED: Ink = Ink::opaque(0x6B_74_80);
/// Detections before any label.
pub(crate) const RAW: Ink = Ink::opaque(0x2B_31_39);
