//! Things, each with its bodies and spots. Strengths are those of the parts that a radar of 77 GHz tells apart, in dBsm
//! (all chosen, within what docs/worlds.md cites for whole things).

mod built;
mod green;
mod traffic;

pub(super) use built::{
    Facade, barrier, building, fence, furniture, kerb, lamp, noise_wall, pole, post, sign, stack, stall,
};
pub(super) use green::{bush, hedge, tree};
pub(super) use traffic::{car, carrier, cyclist, lorry, pedestrian};
