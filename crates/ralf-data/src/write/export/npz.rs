//! NumPy archives: `sequences/NAME/RADAR/000000.npz`, one per scan, one array per column, in the order of the
//! recording.

use super::Writer;
use super::columns::table_columns;
use super::labelled::LabelledSequence;
use super::npy_array;
use crate::disk::files;
use crate::error::DataError;
use crate::result::{Component, OutFolder, Table};
use std::io::{Cursor, Write};
use zip::result::ZipError;
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, DateTime};

/// Writes the archives.
pub(super) struct Npz;

impl Writer for Npz {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let folder = folder.own("sequences").folder(&sequence.names.sequence);
        for radar in 0..sequence.names.radars.len() {
            for scan in 0..sequence.scans(radar) {
                let labelled = sequence.scan(radar, scan)?;
                let file =
                    folder.folder(&sequence.names.radars[radar]).file(&Component::numbered(scan, "npz"));
                let refused = |error: ZipError| DataError::io(&file)(error.into());
                let bytes = archive(&table_columns(sequence, &labelled)?).map_err(refused)?;
                files::write_whole(&file, &bytes)?;
            }
        }
        Ok(())
    }
}

/// A column's name as that of a file which no program that unpacks the archive puts elsewhere: a separator or a control
/// character stands as `%` and two hex digits for each of its bytes.
fn member(column: &str) -> String {
    let plain = |c: char| !c.is_control() && !"/\\:".contains(c);
    let escaped = |c: char| c.to_string().bytes().map(|byte| format!("%{byte:02X}")).collect();
    column.chars().map(|c| if plain(c) { c.to_string() } else { escaped(c) }).collect()
}

/// The bytes of an archive, uncompressed as `numpy.savez` leaves them. It is told no time, so that it is always the
/// same.
fn archive(table: &Table) -> Result<Vec<u8>, ZipError> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    // The long sentences would take most of the archive; the numbers that they put into words are there.
    for (column, values) in table.columns().filter(|(column, _)| column.name != "reason") {
        zip.start_file(format!("{}.npy", member(&column.name)), options)?;
        zip.write_all(&npy_array::of_column(values))?;
    }
    Ok(zip.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_member_leads_elsewhere() {
        for (column, expected) in [
            ("RCS [dBsm]", "RCS [dBsm]"),
            ("..", ".."),
            ("../../x", "..%2F..%2Fx"),
            ("C:\\x\u{1b}\u{85}", "C%3A%5Cx%1B%C2%85"),
        ] {
            assert_eq!(member(column), expected);
        }
    }
}
