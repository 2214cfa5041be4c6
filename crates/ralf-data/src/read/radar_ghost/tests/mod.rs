//! Small files to the letter of the data set's description.

mod reading;
mod recording;
mod refusals;

use crate::disk::hdf5::writing as hdf5;
