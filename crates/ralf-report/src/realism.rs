//! What is told of how far a simulated recording is from a real one.

use ralf_data::realism::{Distributions, Realism};

/// Two recordings side by side.
pub struct RealismPage {
    /// What the real recording is called.
    pub real_name: String,
    /// What the simulated recording is called.
    pub simulated_name: String,
    /// What the real recording is like.
    pub real: Distributions,
    /// What the simulated recording is like.
    pub simulated: Distributions,
    /// How far they are apart.
    pub realism: Realism,
}

impl RealismPage {
    /// Compares two recordings.
    pub fn new(real: (String, Distributions), simulated: (String, Distributions)) -> Self {
        let realism = Realism::new(&real.1, &simulated.1);
        let ((real_name, real), (simulated_name, simulated)) = (real, simulated);
        Self { real_name, simulated_name, real, simulated, realism }
    }
}
