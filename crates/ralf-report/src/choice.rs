//! What there is to choose from, for messages.

/// One of these names: `a camera of front, rear`; of one or none it is said so.
pub fn one_of(kind: &str, names: &[&str]) -> String {
    match names {
        [] => format!("a recording with a {kind}"),
        [only] => format!("the only {kind}, {only}"),
        _ => format!("a {kind} of {}", names.join(", ")),
    }
}

/// A number below the count: `a scan of front from 0 to 17`.
pub fn one_below(kind: &str, of: &str, count: usize) -> String {
    match count {
        0 => format!("a {kind} of {of}, which has none"),
        1 => format!("{kind} 0, the only one of {of}"),
        _ => format!("a {kind} of {of} from 0 to {}", count - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_there_is_is_told_whatever_its_number() {
        assert_eq!(one_of("camera", &[]), "a recording with a camera");
        assert_eq!(one_of("camera", &["front"]), "the only camera, front");
        assert_eq!(one_of("camera", &["front", "rear"]), "a camera of front, rear");
        let scans = [0, 1, 18].map(|count| one_below("scan", "front", count));
        assert_eq!(
            scans,
            [
                "a scan of front, which has none",
                "scan 0, the only one of front",
                "a scan of front from 0 to 17"
            ]
        );
    }
}
