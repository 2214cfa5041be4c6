//! Values of every quantity.

use super::Quantity;

/// Values of every quantity, none of them infinite or no number.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Values([Vec<f32>; Quantity::ALL.len()]);

impl Values {
    /// Takes what is a number.
    pub(super) fn push(&mut self, quantity: Quantity, value: f64) {
        if value.is_finite() {
            self.0[quantity as usize].push(value as f32);
        }
    }

    /// Takes all of another's.
    pub(super) fn append(&mut self, mut other: Self) {
        for (own, others) in self.0.iter_mut().zip(&mut other.0) {
            own.append(others);
        }
    }

    /// Puts each quantity's in ascending order.
    pub(super) fn sort(&mut self) {
        for values in &mut self.0 {
            values.sort_by(f32::total_cmp);
        }
    }

    /// Those of a quantity.
    pub(super) fn of(&self, quantity: Quantity) -> &[f32] {
        &self.0[quantity as usize]
    }
}
