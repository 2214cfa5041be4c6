//! Which echoes become detections.

use super::Echo;
use crate::random::Random;
use ralf::label::Cause;

/// How the artifacts of a scan are made up, as far as there are echoes of each cause; the road and noise fill the rest.
const MIX: [(Cause, f64); 6] = [
    (Cause::Mirror, 0.17),
    (Cause::InsideBuilding, 0.17),
    (Cause::DoubleBounce, 0.05),
    (Cause::SideLobe, 0.11),
    (Cause::Road, 0.30),
    (Cause::Noise, 0.20),
];

/// The strongest echoes of each cause. A scan with fewer real ones has fewer artifacts, too: the threshold is adapted
/// to the scene, so that the share stays about the same.
pub(super) fn detected(
    real: Vec<Echo>,
    ghosts: Vec<Echo>,
    size: f64,
    share: f64,
    random: &mut Random,
) -> Vec<Echo> {
    let of = |cause: Cause| real.iter().chain(&ghosts).filter(move |echo| echo.truth.cause == cause).copied();
    let mut detected = strongest(of(Cause::Plausible).collect(), random.poisson(size * share));
    // A scene without any scatterer still has a tenth of the usual clutter.
    let plausible = (detected.len() as f64).max(0.1 * size * share);
    let artifacts = plausible * (1.0 - share) / share;
    let mut given = 0.0;
    let mut missing = 0.0;
    for (cause, part) in MIX {
        given += part;
        // What one cause lacks is shared by those that follow.
        let wanted = artifacts * (part + missing * part / (1.0 - given + part));
        let count = random.poisson(wanted);
        let found = strongest(of(cause).collect(), count);
        missing += part - found.len() as f64 / artifacts;
        detected.extend(found);
    }
    detected
}

/// So many of the echoes, the strongest first.
fn strongest(mut echoes: Vec<Echo>, count: usize) -> Vec<Echo> {
    echoes.sort_by(|a, b| b.level_db.total_cmp(&a.level_db));
    echoes.truncate(count);
    echoes
}
