//! What a model says of rows, scan by scan.

use super::table::Known;
use ralf::learned::net::{Around, Net, with_trees};
use ralf::learned::{Forest, Rows};

/// The log odds of rows by trees, together with a net where there is one: those of a scan, seen in one way, lie side by
/// side.
pub(super) fn log_odds(forest: &Forest, net: Option<&Net>, rows: &Rows, known: &[Known]) -> Vec<f64> {
    let mut log_odds = forest.log_odds(rows);
    let Some(net) = net else { return log_odds };
    let mut begin = 0;
    for scan in known.chunk_by(|a, b| (a.scan, a.view) == (b.scan, b.view)) {
        let places: Vec<[f32; 3]> = scan.iter().map(|known| known.place).collect();
        let of_scan = begin..begin + scan.len();
        let said = net.log_odds(&rows.pick(of_scan.clone()), &Around::of(&places, net.nearest));
        for (log_odds, said) in log_odds[of_scan].iter_mut().zip(said) {
            *log_odds += with_trees(*log_odds, said);
        }
        begin += scan.len();
    }
    log_odds
}
