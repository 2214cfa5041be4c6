//! `.label` files: one little-endian uint32 per detection or point, in the order of the `.bin` (docs/formats.md,
//! section 1).

use crate::disk::files;
use crate::error::DataError;
use std::path::Path;

const BYTES: usize = size_of::<u32>();

/// One value of a `.label` file.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Label {
    /// SemanticKITTI id: the low 16 bits. [`ralf::label`] says what it means.
    pub id: u16,
    /// Which instance of its class, 0 for none: the high 16 bits.
    pub instance: u16,
}

impl Label {
    /// A label without an instance.
    pub fn of_class(id: u16) -> Self {
        Self { id, instance: 0 }
    }

    fn from_bytes([id_low, id_high, instance_low, instance_high]: [u8; BYTES]) -> Self {
        Self {
            id: u16::from_le_bytes([id_low, id_high]),
            instance: u16::from_le_bytes([instance_low, instance_high]),
        }
    }

    fn to_bytes(self) -> [u8; BYTES] {
        (u32::from(self.instance) << 16 | u32::from(self.id)).to_le_bytes()
    }
}

/// All labels of a file. One that ends within a value is refused.
pub fn read_labels(file: &Path) -> Result<Vec<Label>, DataError> {
    labels_of_bytes(file, &files::read(file)?)
}

/// The labels that a file's content holds.
pub(crate) fn labels_of_bytes(file: &Path, bytes: &[u8]) -> Result<Vec<Label>, DataError> {
    files::check_rows(file, bytes.len(), BYTES, "values of uint32")?;
    Ok(bytes.as_chunks().0.iter().copied().map(Label::from_bytes).collect())
}

/// Writes labels, whole or not at all. Folders are made as needed.
pub fn write_labels(file: &Path, labels: &[Label]) -> Result<(), DataError> {
    files::write_whole(file, &label_bytes(labels))
}

/// The content of a file with these labels.
pub(crate) fn label_bytes(labels: &[Label]) -> Vec<u8> {
    labels.iter().copied().flat_map(Label::to_bytes).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_id_comes_first_and_all_little_endian() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("sequences/00/radar_front/000000.label");
        let labels = [Label::of_class(99), Label { id: 259, instance: 0x1234 }, Label::default()];
        write_labels(&file, &labels).unwrap();
        assert_eq!(fs::read(&file).unwrap(), [99, 0, 0, 0, 3, 1, 0x34, 0x12, 0, 0, 0, 0]);
        assert_eq!(read_labels(&file).unwrap(), labels);
        write_labels(&file, &[]).unwrap();
        assert_eq!(read_labels(&file).unwrap(), []);
    }

    #[test]
    fn a_cut_file_is_named_with_the_place() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("000003.label");
        fs::write(&file, [1, 0, 0, 0, 99, 0]).unwrap();
        let error = read_labels(&file).unwrap_err().to_string();
        let expected =
            "000003.label: byte 4: expected values of uint32 (4 bytes), found 2 bytes left over at the end";
        assert!(error.ends_with(expected), "{error}");
        let error = read_labels(&folder.path().join("000004.label")).unwrap_err().to_string();
        assert!(error.contains("000004.label"), "{error}");
    }
}
