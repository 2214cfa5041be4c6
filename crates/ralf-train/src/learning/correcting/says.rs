//! What a model says of rows.

use super::super::fit::LearnError;
use super::super::table::{TrainingTable, places, scans_of};
use ralf::config::LearnedConfig;
use ralf::learned::{Model, Rows, Weighing};

/// Nobody is surer of a detection than that one in so many like it is otherwise.
const SUREST: f64 = 1e-4;

/// What a model says of the rows of a table.
pub(super) struct Says {
    /// What the model reads of each.
    pub(super) rows: Rows,
    /// Its log odds, as trees, net and calibration have them.
    pub(super) log_odds: Vec<f64>,
    /// The log odds of the plausibility that a detection gets at last, before its scan is asked how many movers are
    /// real: this is where corrections begin.
    pub(super) at_last: Vec<f64>,
    /// The plausibility that each gets at last.
    pub(super) plausibilities: Vec<f64>,
    /// How plausibilities are made.
    pub(super) weighing: Weighing,
}

impl Says {
    /// Asks a model about a table, with settings of how its answers are weighed.
    ///
    /// # Errors
    /// The first feature that the model reads and the table lacks.
    pub(super) fn new(
        model: &Model,
        table: &TrainingTable,
        config: &LearnedConfig,
    ) -> Result<Self, LearnError> {
        let columns = model.places_among(table.features.iter().map(|feature| feature.name))?;
        let rows = table.rows.pick_columns(&columns);
        let names = model.inputs.iter().map(|input| input.name.as_str());
        let by_itself = LearnedConfig { movers: false, ..config.clone() };
        let by_itself = Weighing::new(model, names.clone(), &by_itself);
        let weighing = Weighing::new(model, names, config);
        let (mut log_odds, mut at_last, mut plausibilities) = (Vec::new(), Vec::new(), Vec::new());
        for scan in scans_of(&table.known) {
            let here = rows.pick(scan.clone());
            let said = model.log_odds(&here, &places(&table.known[scan]));
            at_last.extend(by_itself.plausibilities(&here, &said).into_iter().map(in_log_odds));
            plausibilities.extend(weighing.plausibilities(&here, &said));
            log_odds.extend(said);
        }
        Ok(Self { rows, log_odds, at_last, plausibilities, weighing })
    }
}

fn in_log_odds(probability: f64) -> f64 {
    let probability = probability.clamp(SUREST, 1.0 - SUREST);
    (probability / (1.0 - probability)).ln()
}
