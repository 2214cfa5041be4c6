//! The label that counts where several speak: the one place that knows whose word stands above whose.

use crate::disk::label_file::Label;

/// The labels of a scan with people's word above the machine's: of each detection its correction (`corrections`: its
/// place in the scan and the SemanticKITTI id), else the label that was accepted when the scan was marked as reviewed
/// (one per detection), else the machine's. A label that stays keeps its instance. What is said of detections that the
/// scan doesn't have is passed over.
pub fn effective_labels(
    machine: Vec<Label>,
    accepted: Option<&[u16]>,
    corrections: &[(u32, u16)],
) -> Vec<Label> {
    let mut labels = machine;
    for (label, accepted) in labels.iter_mut().zip(accepted.into_iter().flatten()) {
        say(label, *accepted);
    }
    correct(&mut labels, corrections);
    labels
}

/// Gives detections their corrections.
pub(super) fn correct(labels: &mut [Label], corrections: &[(u32, u16)]) {
    for (point, id) in corrections {
        if let Some(label) = labels.get_mut(*point as usize) {
            say(label, *id);
        }
    }
}

/// Gives a detection this id. One that has it already stays with its instance.
pub(super) fn say(label: &mut Label, id: u16) {
    if label.id != id {
        *label = Label::of_class(id);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_correction_stands_above_what_was_accepted_and_that_above_the_machine() {
        let machine = vec![Label { id: 99, instance: 7 }, Label::of_class(1), Label::of_class(99)];
        let ids = |labels: Vec<Label>| labels.iter().map(|label| label.id).collect::<Vec<_>>();
        assert_eq!(effective_labels(machine.clone(), None, &[]), machine);
        let accepted = effective_labels(machine.clone(), Some(&[99, 99, 1]), &[]);
        assert_eq!((accepted[0].instance, ids(accepted)), (7, vec![99, 99, 1]));
        assert_eq!(ids(effective_labels(machine.clone(), None, &[(1, 10)])), [99, 10, 99]);
        assert_eq!(ids(effective_labels(machine, Some(&[99, 99, 1]), &[(1, 10), (3, 1)])), [99, 10, 1]);
    }
}
