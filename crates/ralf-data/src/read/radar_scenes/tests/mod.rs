//! Small sequences in the published layout.

mod reading;
mod recording;
mod refusals;

use crate::disk::hdf5::writing as hdf5;
