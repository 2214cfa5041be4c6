//! How far two people agree, in JSON (docs/formats.md, section 3).

use super::agreement::{Agreement, disagreements, kappa, kappa_of_names};
use ralf::label::{ARTIFACT, PLAUSIBLE, class_name};
use ralf::metrics::Confusion;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

impl Agreement {
    /// All of it, with kappa over all, by sequence, by radar, of each label against all others,
    /// and of causes where both said one.
    pub fn json(&self) -> Value {
        let scans = self.disagreements().into_iter().map(|(scan, counts)| {
            json!({ "sequence": scan.sequence, "radar": scan.radar, "scan": scan.scan,
                "labelled_by_both": counts.total(), "disagree": disagreements(counts) })
        });
        let classes = self.classes().into_iter().map(|(id, counts)| (label_name(id), class(&counts)));
        json!({
            "overall": told(&self.overall()),
            "sequences": named(self.sequences()),
            "radars": named(self.radars()),
            "classes": classes.collect::<Map<_, _>>(),
            "causes": self.causes_json(),
            "disagreements": scans.collect::<Vec<_>>(),
        })
    }

    fn causes_json(&self) -> Value {
        let each = self.each_cause().into_iter().map(|(cause, counts)| (cause, class(&counts)));
        json!({
            "said_by_both": self.causes.values().sum::<u64>(),
            "kappa": kappa_of_names(&self.causes),
            "each": each.collect::<Map<_, _>>(),
        })
    }
}

/// What the page calls a label, or its number where it has no name.
pub fn label_name(id: u16) -> String {
    let own = match id {
        ARTIFACT => Some("artifact"),
        PLAUSIBLE => Some("plausible"),
        _ => class_name(id),
    };
    own.map_or_else(|| id.to_string(), str::to_owned)
}

fn named(counts: BTreeMap<&str, Confusion>) -> Map<String, Value> {
    counts.into_iter().map(|(name, counts)| (name.to_owned(), told(&counts))).collect()
}

fn told(counts: &Confusion) -> Value {
    json!({
        "labelled_by_both": counts.total(),
        "both_plausible": counts.tp,
        "both_artifact": counts.tn,
        "disagree": disagreements(counts),
        "kappa": kappa(counts),
    })
}

fn class(counts: &Confusion) -> Value {
    json!({ "both": counts.tp, "first_alone": counts.r#fn, "second_alone": counts.fp, "kappa": kappa(counts) })
}
