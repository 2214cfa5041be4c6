//! What a model is worth where it was not asked yet: before somebody's own corrections are learned.

use super::asked;
use super::scores::{Scores, scored};
use super::table::{Known, TrainingTable, scans_of};
use super::view::View;
use ralf::config::Config;
use ralf::learned::{Model, Weighing};

/// What a model is worth in a world of a table, with the settings' threshold. `None` where it reads what the table
/// doesn't hold.
pub fn worth_in(model: &Model, table: &TrainingTable, world: u16, config: &Config) -> Option<Scores> {
    let columns = model.places_among(table.features.iter().map(|feature| feature.name)).ok()?;
    let is_here = |row: &usize| table.known[*row].world == world && table.known[*row].view == View::Whole;
    let here: Vec<usize> = (0..table.len()).filter(is_here).collect();
    let rows = table.rows.pick(here.iter().copied()).pick_columns(&columns);
    let weighing =
        Weighing::new(model, model.inputs.iter().map(|input| input.name.as_str()), &config.learned);
    let known: Vec<Known> = here.iter().map(|row| table.known[*row]).collect();
    let log_odds = asked::log_odds(&model.plausible, model.net.as_ref(), &rows, &known);
    let mut judged = Vec::with_capacity(here.len());
    for scan in scans_of(&known) {
        let scores = weighing.plausibilities(&rows.pick(scan.clone()), &log_odds[scan.clone()]);
        judged.extend(scored(scores, &known[scan]));
    }
    Some(Scores::new(&judged, config.fusion.threshold))
}

#[cfg(test)]
mod tests {
    use super::super::testing::{small, table};
    use super::super::{Fitting, Parameters, fit};
    use super::*;
    use ralf::learned::Origin;

    #[test]
    fn a_model_is_judged_by_the_columns_that_it_reads_whatever_their_order() {
        let (config, whole) = (Config::default(), table(120, 10));
        let parameters = Parameters { rounds: 20, rows_per_leaf: 20, ..Parameters::default() };
        let fitting = Fitting {
            parameters,
            net: Some(small()),
            expects: None,
            blanking: false,
            causes: false,
            threshold: 0.5,
            learned: Config::default().learned,
            jobs: 2,
        };
        let model = fit(&whole, &fitting, Origin::default(), &|_, _| {}).unwrap().model;
        let found = worth_in(&model, &whole, 0, &config).unwrap();
        assert!(found.average_precision.unwrap() > 0.9, "{found:?}");
        let mut turned = whole.clone();
        let order: Vec<usize> = (0..turned.features.len()).rev().collect();
        turned.rows = whole.rows.pick_columns(&order);
        turned.features.reverse();
        assert_eq!(worth_in(&model, &turned, 0, &config), Some(found));
        turned.features.remove(0);
        assert_eq!(worth_in(&model, &turned, 0, &config), None);
    }
}
