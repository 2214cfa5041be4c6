//! Clouds of every storage and type, and damaged ones.

use super::*;

const HEADER: &str = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x t n\nSIZE 4 8 2\nTYPE F U I\n\
    COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ";
/// Microseconds that float32 doesn't hold.
const TIMES: [u64; 2] = [1_695_473_372_704_727, 1_695_473_372_704_728];

/// The columns `x`, `t` and `n`.
type Columns = (Vec<f32>, Vec<i64>, Vec<f32>);

fn read(storage: &str, body: &[u8]) -> Result<Columns, String> {
    let file = tempfile::NamedTempFile::new().unwrap();
    std::fs::write(file.path(), [HEADER.as_bytes(), storage.as_bytes(), b"\n", body].concat()).unwrap();
    let pcd = Pcd::read(file.path()).map_err(|error| error.to_string())?;
    let all = || Ok((pcd.column("x")?, pcd.integers("t")?, pcd.column("n")?));
    all().map_err(|error: DataError| error.to_string())
}

fn by_record() -> Vec<u8> {
    let records = TIMES.iter().zip([(1.5f32, -2i16), (f32::NAN, 300)]);
    records
        .flat_map(|(t, (x, n))| [&x.to_le_bytes()[..], &t.to_le_bytes(), &n.to_le_bytes()].concat())
        .collect()
}

/// All bytes as new ones, which is LZF as well.
fn by_field() -> Vec<u8> {
    let records = by_record();
    let field =
        |range: std::ops::Range<usize>| [&records[range.clone()], &records[range.start + 14..range.end + 14]];
    let all = [field(0..4), field(4..12), field(12..14)].concat().concat();
    let packed = [&[27], &all[..]].concat();
    let sizes = [packed.len() as u32, all.len() as u32].map(u32::to_le_bytes);
    [&sizes.concat()[..], &packed].concat()
}

#[test]
fn every_storage_holds_the_same() {
    let text = format!("1.5 {} -2\nnan {} 300\n", TIMES[0], TIMES[1]);
    for (storage, body) in
        [("binary", by_record()), ("binary_compressed", by_field()), ("ascii", text.into_bytes())]
    {
        let (x, t, n) = read(storage, &body).unwrap();
        assert!(x[0] == 1.5 && x[1].is_nan(), "{storage}");
        assert_eq!((t, n), (TIMES.map(u64::cast_signed).to_vec(), vec![-2.0, 300.0]), "{storage}");
    }
}

#[test]
fn what_is_cut_or_of_another_size_is_refused() {
    let refused = |storage: &str, body: &[u8], words: &str| {
        let error = read(storage, body).unwrap_err();
        assert!(error.contains(words), "{error} lacks {words}");
    };
    let (records, packed) = (by_record(), by_field());
    refused("binary", &records[..27], "expected 2 records of 14 bytes from byte");
    refused("binary_compressed", &packed[..7], "expected two sizes of 4 bytes");
    refused("binary_compressed", &packed[..20], "expected 29 compressed bytes, found 12 of them");
    let mut other = packed.clone();
    other[4] = 29;
    refused("binary_compressed", &other, "expected 28 bytes, as many as the points take, found 29");
    other[4] = 28;
    other[8] = 200;
    refused("binary_compressed", &other, "expected 28 bytes, compressed by LZF");
    refused("ascii", b"1.5 12 -2\n3 4", "point 1, `n`: expected a number of the field's type, found the end");
    refused("ascii", b"1.5 -1 2 3 4 5", "point 0, `t`: expected a number of the field's type, found `-1`");
    refused("ascii", b"1.5 1 40000 3 4 5", "point 0, `n`");
    refused("ascii", b"1.5 18446744073709551615 2 3 4 5", "a whole number of at most 63 bits");
    refused("zip", b"", "DATA: expected binary, binary_compressed or ascii, found zip");
}

#[test]
fn what_a_header_claims_is_not_believed() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let claims = HEADER.replace("WIDTH 2", "WIDTH 99999999999").replace("POINTS 2", "POINTS 99999999999");
    for storage in ["ascii", "binary", "binary_compressed"] {
        std::fs::write(file.path(), format!("{claims}{storage}\n")).unwrap();
        let error = Pcd::read(file.path()).map(drop).unwrap_err().to_string();
        assert!(error.contains("POINTS: expected at most 1073741824 bytes of points"), "{error}");
    }
}
