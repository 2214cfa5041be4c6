use super::*;
use std::sync::Arc;

/// Of the files that h5py made (`testdata/make_hdf5.py`).
fn made_by_h5py(name: &str) -> Hdf5File {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/hdf5");
    Hdf5File::open(&folder.join(format!("{name}.h5"))).unwrap()
}

#[test]
fn a_table_is_the_same_in_whatever_way_it_is_stored() {
    let rows = 0..40_i32;
    for name in ["contiguous", "packed", "growing", "big_endian", "latest", "lzf"] {
        let table = made_by_h5py(name).table("rows").unwrap();
        assert_eq!(table.rows(), 40, "{name}");
        let all = |value: fn(i32) -> f64| rows.clone().map(value).collect::<Vec<f64>>();
        assert_eq!(table.numbers("whole").unwrap(), all(|n| f64::from(n - 3)), "{name}");
        assert_eq!(table.numbers("single").unwrap(), all(|n| f64::from(n) / 4.0));
        assert_eq!(table.numbers("double").unwrap(), all(|n| f64::from(n) / -8.0));
        assert_eq!(table.floats("double").unwrap()[39], -4.875);
        assert_eq!(table.integers("whole").unwrap()[0], -3);
        assert_eq!(table.integers("large").unwrap()[39], 39 << 50);
        let thirds: Vec<i64> = rows.clone().map(|n| i64::from(n % 3 == 0)).collect();
        assert_eq!(table.integers("truth").unwrap(), thirds);
        let fixed = table.texts("fixed").unwrap();
        assert_eq!([&*fixed[0], &*fixed[39]], ["right", "left"]);
        if table.has("varying") {
            let texts = table.texts("varying").unwrap();
            assert_eq!([&*texts[0], &*texts[1], &*texts[38]], ["", "M\u{e4}rz 0", "M\u{e4}rz 9"]);
            assert!(Arc::ptr_eq(&texts[1], &texts[2]));
        } else {
            assert!(["growing", "big_endian", "lzf"].contains(&name));
        }
    }
}

#[test]
fn whole_numbers_may_have_any_size_up_to_eight_bytes() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("sizes.h5");
    for bytes in 1..=8 {
        let most = i64::MAX >> (64 - 8 * bytes);
        let values = vec![0, 1, -1, most, -most - 1];
        let columns = vec![("whole", writing::Values::Whole(bytes, values.clone()))];
        writing::write_tables(&file, &[("rows", &columns)], 2);
        let table = Hdf5File::open(&file).unwrap().table("rows").unwrap();
        assert_eq!(table.integers("whole").unwrap(), values, "{bytes} bytes");
        let decimals: Vec<f64> = values.iter().map(|value| *value as f64).collect();
        assert_eq!(table.numbers("whole").unwrap(), decimals, "{bytes} bytes");
    }
    let columns = vec![("whole", writing::Values::Whole(9, vec![0]))];
    let refused = || {
        writing::write_tables(&file, &[("rows", &columns)], 2);
        Hdf5File::open(&file)?.table("rows")?.integers("whole").map(drop)
    };
    let error = refused().unwrap_err().to_string();
    let words =
        "rows, whole: expected whole numbers of at most 8 bytes, or floats of 4 or 8, found FixedPoint";
    assert!(error.contains("sizes.h5: ") && error.contains(words), "{error}");
}

#[test]
fn a_table_may_have_no_rows() {
    let table = made_by_h5py("none").table("rows").unwrap();
    assert_eq!(
        (table.rows(), table.numbers("whole").unwrap(), table.texts("fixed").unwrap()),
        (0, vec![], vec![])
    );
}

#[test]
fn what_is_no_table_or_column_of_this_kind_is_named() {
    let file = made_by_h5py("no_table");
    let refused = |name: &str| file.table(name).err().unwrap().to_string();
    for (name, words) in [
        ("rows", "no_table.h5: rows: expected a table, found"),
        ("numbers", "no_table.h5: numbers: expected a table, found FloatingPoint"),
        ("square", "no_table.h5: square: expected one dimension, found 2 dimensions"),
    ] {
        assert!(refused(name).contains(words), "{}", refused(name));
    }
    let odd = file.table("odd").unwrap();
    let error = odd.numbers("list").unwrap_err().to_string();
    assert!(error.contains("odd, list: expected numbers or texts in a row, found Array"), "{error}");
    assert!(odd.numbers("inside").is_err());
    let table = made_by_h5py("growing").table("rows").unwrap();
    for (error, words) in [
        (
            table.numbers("fixed").err(),
            "rows, fixed: expected whole numbers of at most 8 bytes, or floats of 4 or 8, found String",
        ),
        (table.texts("whole").err(), "rows, whole: expected texts, found FixedPoint"),
        (
            table.integers("double").err(),
            "rows, double, row 1: expected a whole number of at most 63 bits, found -0.125",
        ),
        (
            table.numbers("w").err(),
            "rows, columns: expected a column `w`, found whole, large, single, double, truth, fixed",
        ),
    ] {
        let error = error.unwrap().to_string();
        assert!(error.contains(words), "{error}");
    }
}

/// Whatever is wrong with a file, it is refused or read, and nothing else.
#[test]
fn damaged_files_are_refused_or_read() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/hdf5");
    let mut refused = 0;
    for name in ["contiguous", "packed", "latest", "lzf"] {
        let whole = std::fs::read(source.join(format!("{name}.h5"))).unwrap();
        assert!(reads(whole.clone()), "{name}");
        for at in (0..whole.len()).step_by(29) {
            for damage in [&[0xff_u8; 8][..], &[0; 4], &[0x7f]] {
                let mut bytes = whole.clone();
                bytes[at..].iter_mut().zip(damage).for_each(|(byte, damage)| *byte = *damage);
                refused += usize::from(!reads(bytes));
            }
            refused += usize::from(!reads(whole[..at].to_vec()));
        }
    }
    assert!(refused > 500, "{refused}");
    let error = Hdf5File::of_bytes(Path::new("a.h5"), b"no such file".to_vec()).err().unwrap().to_string();
    assert!(error.contains("a.h5: content: expected an HDF5 file, found"), "{error}");
}

fn reads(bytes: Vec<u8>) -> bool {
    let read = || {
        let table = Hdf5File::of_bytes(Path::new("a.h5"), bytes)?.table("rows")?;
        table.numbers("double")?;
        table.integers("whole")?;
        table.texts(if table.has("varying") { "varying" } else { "fixed" }).map(drop)
    };
    read().is_ok()
}
