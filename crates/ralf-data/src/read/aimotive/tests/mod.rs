//! A small recording in aiMotive's layout, made here, and the genuine frames where they are at hand.

mod reading;
mod recording;
mod refusals;
