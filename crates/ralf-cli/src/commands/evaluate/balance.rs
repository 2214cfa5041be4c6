//! Distinctiveness and class balance as text.

use crate::text::{aligned, decimal, grouped};
use ralf_data::{Balance, Balances};

/// A row for everything, for each sequence, for each radar.
pub(super) fn table(balances: &Balances) -> String {
    let head = ["of", "detections", "plausible", "artifact", "plausible share", "distinctiveness"];
    let mut rows = vec![head.map(str::to_owned).to_vec(), row("overall".to_owned(), &balances.overall)];
    let of_sequence = |(name, balance): (&String, &Balance)| row(format!("sequence {name}"), balance);
    rows.extend(balances.sequences.iter().map(of_sequence));
    rows.extend(balances.radars.iter().map(|(name, balance)| row(name.clone(), balance)));
    aligned(&rows)
}

fn row(name: String, balance: &Balance) -> Vec<String> {
    let counts = [balance.detections, balance.plausible, balance.artifact].map(grouped);
    let values = [balance.plausible_share, balance.distinctiveness].map(decimal);
    [name].into_iter().chain(counts).chain(values).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_whole_text() {
        let balance = |plausible: u64, artifact: u64, distinctiveness| Balance {
            detections: plausible + artifact,
            plausible,
            artifact,
            plausible_share: Some(plausible as f64 / (plausible + artifact) as f64),
            distinctiveness,
        };
        let (all, none) = (balance(1_000, 3_000, Some(0.625)), balance(0, 7, None));
        let balances = Balances {
            overall: all,
            sequences: [("00".to_owned(), all)].into(),
            radars: [("front".to_owned(), all), ("left".to_owned(), none)].into(),
        };
        let expected = "\
of           detections  plausible  artifact  plausible share  distinctiveness
overall           4,000      1,000     3,000            0.250            0.625
sequence 00       4,000      1,000     3,000            0.250            0.625
front             4,000      1,000     3,000            0.250            0.625
left                  7          0         7            0.000                -
";
        assert_eq!(table(&balances), expected, "\n{}", table(&balances));
    }
}
