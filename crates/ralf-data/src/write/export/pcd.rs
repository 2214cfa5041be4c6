//! Point clouds as PCL has them (PCD 0.7, binary): `sequences/NAME/RADAR/000000.pcd`, one per scan.
//!
//! Points are in the radar's frame; `VIEWPOINT` tells how the radar is mounted on the vehicle. Fields are the radar's
//! own, under their names, and what was found about each detection.

use super::Writer;
use super::bytes;
use super::columns::cloud_columns;
use super::labelled::LabelledSequence;
use crate::disk::files;
use crate::error::DataError;
use crate::result::{Column, Component, Kind, OutFolder, Table};
use ralf::space::Transform;
use std::collections::BTreeSet;
use unicode_ident::is_xid_start;

/// Writes the clouds.
pub(super) struct Pcd;

impl Writer for Pcd {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let folder = folder.own("sequences").folder(&sequence.names.sequence);
        for (radar, sensor) in sequence.reader.sequence().rig.radars.iter().enumerate() {
            for scan in 0..sequence.scans(radar) {
                let labelled = sequence.scan(radar, scan)?;
                let columns = cloud_columns(sequence, &labelled, &sequence.measured_of(&labelled)?, false)?;
                let file =
                    folder.folder(&sequence.names.radars[radar]).file(&Component::numbered(scan, "pcd"));
                files::write_whole(&file, &cloud(&columns, &sensor.vehicle_from_radar))?;
            }
        }
        Ok(())
    }
}

/// The bytes of a cloud.
fn cloud(table: &Table, vehicle_from_radar: &Transform) -> Vec<u8> {
    let points = table.len();
    let columns = table.schema().columns();
    let of = |text: fn(&Column) -> String| columns.iter().map(text).collect::<Vec<_>>().join(" ");
    let fields = field_names(columns).join(" ");
    let (letters, sizes) =
        (of(|column| letter(column).into()), of(|column| bytes::size(column.kind).to_string()));
    let counts = of(|_| "1".into());
    let viewpoint = viewpoint(vehicle_from_radar);
    let header = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {letters}\n\
         COUNT {counts}\nWIDTH {points}\nHEIGHT 1\nVIEWPOINT {viewpoint}\nPOINTS {points}\nDATA binary\n"
    );
    let mut all = header.into_bytes();
    for row in 0..points {
        table.columns().for_each(|(_, values)| bytes::append(values, row, &mut all));
    }
    all
}

/// A name for each column, of characters that readers know; one that another column has already gets longer.
fn field_names(columns: &[Column]) -> Vec<String> {
    let mut taken: BTreeSet<String> = columns.iter().map(|column| column.name.to_string()).collect();
    let mut free = |column: &Column| {
        let mut name = column.name.replace(|c| !is_plain(c), "_");
        if *name != *column.name {
            while !taken.insert(name.clone()) {
                name.push('_');
            }
        }
        name
    };
    columns.iter().map(&mut free).collect()
}

/// Whether readers take a character for part of a field's name. Spaces part names; at others pypcd4 stops reading the
/// line, and takes the fields that it has for all. So it does at the signs of a script that only stand on letters.
fn is_plain(c: char) -> bool {
    let is_letter = c.is_alphabetic() && is_xid_start(c);
    is_letter || c.is_numeric() || "_-.?+*".contains(c)
}

/// PCD's letter for the kind of a column.
fn letter(column: &Column) -> &'static str {
    match column.kind {
        Kind::F32 => "F",
        Kind::U8 | Kind::U16 | Kind::U32 | Kind::Class | Kind::Text => "U",
        Kind::I64 | Kind::Truth => "I",
    }
}

/// x y z (m), then the rotation as qw qx qy qz.
fn viewpoint(vehicle_from_radar: &Transform) -> String {
    let (place, turn) = (vehicle_from_radar.translation.vector, vehicle_from_radar.rotation);
    [place.x, place.y, place.z, turn.w, turn.i, turn.j, turn.k].map(|value| value.to_string()).join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::schema::field;

    #[test]
    fn fields_have_names_of_their_own_that_readers_know() {
        let columns = ["my field", "x", "my\tfield", "my_field", "my_field_"].map(field);
        assert_eq!(field_names(&columns), ["my_field__", "x", "my_field___", "my_field", "my_field_"]);
        let columns = ["m/s", "RCS [dBsm]", "m_s", "größe", "a-b.c?+*", "100%"].map(field);
        assert_eq!(field_names(&columns), ["m_s_", "RCS__dBsm_", "m_s", "größe", "a-b.c?+*", "100_"]);
        // Devanagari: letters, signs of vowels, and a digit.
        assert_eq!(field_names(&["गति", "र्९²"].map(field)), ["गत_", "र_९²"]);
    }
}
