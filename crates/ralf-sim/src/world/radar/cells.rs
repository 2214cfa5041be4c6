//! What lies in one cell of range, range rate and angles is one echo.

use super::echo::Echo;
use super::model::RadarModel;
use crate::random::Random;
use ralf::space::Spherical;

/// Cells of range, range rate, azimuth, elevation.
type Key = [i32; 4];

fn key(radar: &RadarModel, echo: &Echo) -> Key {
    let cell = &radar.cell;
    let bin = |value: f64, width: f64| (value / width).floor() as i32;
    [
        bin(echo.seen.range, cell.range),
        bin(echo.range_rate, cell.doppler),
        bin(echo.seen.azimuth, cell.azimuth),
        if radar.elevation { bin(echo.seen.elevation, cell.elevation) } else { 0 },
    ]
}

/// One echo per cell: the sum of the powers, at their centre of mass; its truth is that of the strongest.
pub(super) fn merged(radar: &RadarModel, echoes: &[Echo], random: &mut Random) -> Vec<Echo> {
    let mut order: Vec<(Key, usize)> =
        echoes.iter().enumerate().map(|(i, echo)| (key(radar, echo), i)).collect();
    order.sort_unstable();
    order.chunk_by(|a, b| a.0 == b.0).map(|cell| sum(cell, echoes, random)).collect()
}

fn sum(cell: &[(Key, usize)], echoes: &[Echo], random: &mut Random) -> Echo {
    let members = || cell.iter().map(|(_, index)| &echoes[*index]);
    let power: f64 = members().map(|echo| echo.power).sum();
    let first = echoes[cell[0].1];
    let strongest = members().fold(first, |best, echo| if echo.power > best.power { *echo } else { best });
    if cell.len() == 1 {
        return strongest;
    }
    let mean = |value: fn(&Echo) -> f64| members().map(|echo| echo.power * value(echo)).sum::<f64>() / power;
    // Amplitudes add up with phases that nobody knows.
    let interference = random.exponential(1.0).clamp(0.15, 2.5);
    let least = strongest.power * 0.5;
    Echo {
        seen: Spherical {
            range: mean(|echo| echo.seen.range),
            azimuth: mean(|echo| echo.seen.azimuth),
            elevation: mean(|echo| echo.seen.elevation),
        },
        range_rate: mean(|echo| echo.range_rate),
        power: (power * interference).max(least),
        truth: strongest.truth,
    }
}
