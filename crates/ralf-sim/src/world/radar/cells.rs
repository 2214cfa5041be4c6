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

#[cfg(test)]
mod tests {
    use super::super::model::tests::radar;
    use super::*;
    use crate::random::Purpose;
    use crate::truth::Truth;
    use ralf::label::Cause;

    fn echo(range: f64, azimuth: f64, rate: f64, level_db: f64, cause: Cause) -> Echo {
        Echo::new(Spherical { range, azimuth, elevation: 0.01 }, rate, level_db, Truth { class: 10, cause })
    }

    #[test]
    fn echoes_of_a_cell_are_one_and_the_strongest_tells_its_truth() {
        let random = &mut Random::new(1, Purpose::Radar, 0, 0);
        let near = [
            echo(20.11, 0.001, 1.01, 20.0, Cause::Road),
            echo(20.2, 0.02, 1.05, 30.0, Cause::Plausible),
            // Another range, another rate, another azimuth.
            echo(21.0, 0.001, 1.01, 20.0, Cause::Noise),
            echo(20.11, 0.001, 3.0, 20.0, Cause::Noise),
            echo(20.11, 0.3, 1.01, 20.0, Cause::Noise),
        ];
        let found = merged(&radar(), &near, random);
        assert_eq!(found.len(), 4);
        let both = found.iter().find(|echo| echo.truth.cause == Cause::Plausible).unwrap();
        assert!(both.power >= 0.5 * near[1].power);
        assert!((20.18..20.2).contains(&both.seen.range), "nearer the stronger: {}", both.seen.range);
        assert!(found.iter().filter(|echo| echo.truth.cause == Cause::Noise).count() == 3);
    }
}
