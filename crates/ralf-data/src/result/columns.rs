//! The columns of `plausibility.parquet`.

use ralf::sensors::Rig;

/// Decimal columns before the further radar fields.
pub(super) const PLACE: [&str; 6] = ["x", "y", "z", "range", "azimuth", "elevation"];
/// Decimal columns after them.
pub(crate) const ANSWERS: [&str; 8] = ["d_lm", "d_cm", "d_tr", "w_lm", "w_cm", "w_tr", "w_opt", "w"];
/// Names that no further radar field may have: those of the columns above have a meaning of their own, too.
const OTHERS: [&str; 7] = ["radar", "scan", "point", "t_ns", "label", "flags", "semantic"];

/// The decimal columns of one sequence, in order: place, further radar fields, answers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Columns {
    /// Of all radars, in the order in which they first appear.
    further: Vec<String>,
}

impl Columns {
    /// The columns for a rig. The error names a further field that has the name of another column.
    pub fn of(rig: &Rig) -> Result<Self, String> {
        let mut further: Vec<String> = Vec::new();
        for radar in &rig.radars {
            for (_, name) in radar.further_fields() {
                if ANSWERS.contains(&name) || OTHERS.contains(&name) {
                    return Err(format!(
                        "field `{name}` of {} has the name of a column of the result",
                        radar.name
                    ));
                }
                if !further.iter().any(|known| known == name) {
                    further.push(name.to_owned());
                }
            }
        }
        Ok(Self { further })
    }

    /// The further radar fields.
    pub fn further(&self) -> &[String] {
        &self.further
    }

    /// Names of all decimal columns.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        PLACE.into_iter().chain(self.further.iter().map(String::as_str)).chain(ANSWERS)
    }

    /// How many decimal columns.
    pub fn count(&self) -> usize {
        PLACE.len() + self.further.len() + ANSWERS.len()
    }
}
