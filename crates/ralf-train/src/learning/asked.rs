//! What a model says of rows, scan by scan.

use super::table::{Known, places, scans_of};
use ralf::learned::net::Net;
use ralf::learned::{Forest, Rows};

/// The log odds of rows by trees, together with a net where there is one: those of a scan, seen in one way, lie side by
/// side.
pub(super) fn log_odds(forest: &Forest, net: Option<&Net>, rows: &Rows, known: &[Known]) -> Vec<f64> {
    let mut log_odds = forest.log_odds(rows);
    let Some(net) = net else { return log_odds };
    for scan in scans_of(known) {
        let trees = &mut log_odds[scan.clone()];
        let heard = net.heard(trees, &rows.pick(scan.clone()), &places(&known[scan]));
        trees.iter_mut().zip(heard).for_each(|(sum, heard)| *sum += heard);
    }
    log_odds
}
