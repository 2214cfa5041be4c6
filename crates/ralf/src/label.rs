//! SemanticKITTI ids.
/// 0.
pub const UNLABELED: u16 = 0;
