//! What can happen to the bytes of a file.

use rand::{Rng, RngExt};

/// Numbers that are more or less than anyone thought of.
const NUMBERS: [&str; 20] = [
    "0",
    "-0",
    "1",
    "-1",
    "2",
    "255",
    "256",
    "65536",
    "2147483647",
    "-2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "-9223372036854775808",
    "18446744073709551615",
    "1e308",
    "1e-308",
    "1e999",
    "nan",
    "inf",
];

/// Nothing is longer than this afterwards.
const LONGEST: usize = 4 << 20;

/// Damages bytes in one to three places, as their kind makes it hurt the most. `other` is another file's content.
pub(crate) fn damage(bytes: &mut Vec<u8>, other: &[u8], random: &mut impl Rng) {
    if random.random_range(0..40) == 0 {
        *bytes = other.to_vec();
        return;
    }
    for _ in 0..random.random_range(1..4) {
        let is_text =
            bytes.iter().take(2000).all(|byte| byte.is_ascii_graphic() || byte.is_ascii_whitespace());
        if is_text && random.random_range(0..4) > 0 {
            damage_text(bytes, random);
        } else {
            damage_bytes(bytes, random);
        }
    }
    bytes.truncate(LONGEST);
}

fn damage_bytes(bytes: &mut Vec<u8>, random: &mut impl Rng) {
    if bytes.is_empty() {
        return bytes.push(random.random());
    }
    let at = place(bytes, random);
    let end = (at + random.random_range(1..64)).min(bytes.len());
    match random.random_range(0..9) {
        0 => bytes[at] ^= 1 << random.random_range(0..8),
        1 => bytes[at] = random.random(),
        2 => bytes.truncate(at),
        3 => drop(bytes.drain(at..end)),
        4 => {
            let copied = bytes[at..end].to_vec();
            bytes.splice(at..at, copied);
        }
        5 => bytes.splice(at..at, (0..random.random_range(1..9)).map(|_| 0)).for_each(drop),
        _ => overwrite(bytes, at, random),
    }
}

/// Mostly near the beginning or the end, where what is said of all the rest lies.
fn place(bytes: &[u8], random: &mut impl Rng) -> usize {
    let near = bytes.len().min(256);
    match random.random_range(0..3) {
        0 => random.random_range(0..near),
        1 => bytes.len() - 1 - random.random_range(0..near),
        _ => random.random_range(0..bytes.len()),
    }
}

/// Lengths, counts, times and coordinates become extreme ones.
fn overwrite(bytes: &mut [u8], at: usize, random: &mut impl Rng) {
    let value: Vec<u8> = match random.random_range(0..8) {
        0 => vec![0xff; 4],
        1 => vec![0xff; 8],
        2 => vec![0; 8],
        3 => i32::MAX.to_le_bytes().to_vec(),
        4 => i64::MAX.to_le_bytes().to_vec(),
        5 => f32::NAN.to_le_bytes().to_vec(),
        6 => 3e38_f32.to_le_bytes().to_vec(),
        _ => 1e300_f64.to_le_bytes().to_vec(),
    };
    for (byte, value) in bytes[at..].iter_mut().zip(value) {
        *byte = value;
    }
}

fn damage_text(bytes: &mut Vec<u8>, random: &mut impl Rng) {
    let text = String::from_utf8_lossy(bytes).into_owned();
    let is_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let numbers: Vec<(usize, usize)> = text
        .split(|c| !is_number(c))
        .filter(|part| part.bytes().any(|byte| byte.is_ascii_digit()))
        .map(|part| (part.as_ptr() as usize - text.as_ptr() as usize, part.len()))
        .collect();
    let lines: Vec<&str> = text.lines().collect();
    let line = if lines.is_empty() { 0 } else { random.random_range(0..lines.len()) };
    let mut changed = lines.clone();
    *bytes = match random.random_range(0..8) {
        0..4 if !numbers.is_empty() => {
            let (at, length) = numbers[random.random_range(0..numbers.len())];
            let number = NUMBERS[random.random_range(0..NUMBERS.len())];
            format!("{}{number}{}", &text[..at], &text[at + length..]).into_bytes()
        }
        4 if !lines.is_empty() => {
            changed.remove(line);
            changed.join("\n").into_bytes()
        }
        5 if !lines.is_empty() => {
            changed.insert(line, lines[line]);
            changed.join("\n").into_bytes()
        }
        6 => {
            let deep = ["[", "{\"a\":", "{a=", "a."][random.random_range(0..4)].repeat(50_000);
            let at = (0..=text.len()).rev().find(|at| text.is_char_boundary(*at) && *at <= text.len() / 2);
            let (before, after) = text.split_at(at.unwrap_or(0));
            [before, &deep, after].concat().into_bytes()
        }
        _ => text
            .replacen(&['=', ',', ':', '"', '\n'][random.random_range(0..5)].to_string(), "", 1)
            .into_bytes(),
    };
}
