//! Lists of so many numbers and no more, for `#[serde(deserialize_with)]`: a parser of TOML takes the first numbers of
//! a longer list for an array and says nothing of the rest.

use serde::de::{Deserialize, Deserializer, Error};

/// `N` values.
///
/// # Errors
/// A list of fewer or more values.
pub fn array<'de, D, T, const N: usize>(from: D) -> Result<[T; N], D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    exactly(Vec::deserialize(from)?)
}

/// `N` values where there are any; beside it, `#[serde(default)]` takes the key's absence for `None`.
///
/// # Errors
/// A list of fewer or more values.
pub fn optional<'de, D, T, const N: usize>(from: D) -> Result<Option<[T; N]>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    array(from).map(Some)
}

/// Any number of lists of `N` values each.
///
/// # Errors
/// A list of fewer or more values among them.
pub fn rows<'de, D, T, const N: usize>(from: D) -> Result<Vec<[T; N]>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    Vec::deserialize(from)?.into_iter().map(exactly).collect()
}

/// Any number of lists of `N` values each, where there are any; for fields with `#[serde(default)]`.
///
/// # Errors
/// A list of fewer or more values among them.
pub fn optional_rows<'de, D, T, const N: usize>(from: D) -> Result<Option<Vec<[T; N]>>, D::Error>
where
    D: Deserializer<'de>,
    T: Deserialize<'de>,
{
    rows(from).map(Some)
}

fn exactly<T, E: Error, const N: usize>(values: Vec<T>) -> Result<[T; N], E> {
    let found = values.len();
    values.try_into().map_err(|_| E::invalid_length(found, &format!("an array of length {N}").as_str()))
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    #[derive(Debug, PartialEq, Deserialize)]
    struct Lists {
        #[serde(deserialize_with = "super::array")]
        place: [f64; 2],
        #[serde(default, deserialize_with = "super::optional")]
        size: Option<[f64; 2]>,
        #[serde(default, deserialize_with = "super::rows")]
        rows: Vec<[f64; 2]>,
        #[serde(default, deserialize_with = "super::optional_rows")]
        more: Option<Vec<[f64; 2]>>,
    }

    #[test]
    fn lists_of_another_length_are_refused_wherever_they_stand() {
        let read = |text: &str| toml::from_str::<Lists>(text).map_err(|error| error.message().to_owned());
        let nothing = Lists { place: [1.0, 2.0], size: None, rows: Vec::new(), more: None };
        assert_eq!(read("place = [1, 2]").unwrap(), nothing);
        let all = read("place = [1, 2]\nsize = [3, 4]\nrows = [[5, 6]]\nmore = [[7, 8], [9, 10]]").unwrap();
        assert_eq!((all.size, all.rows), (Some([3.0, 4.0]), vec![[5.0, 6.0]]));
        assert_eq!(all.more, Some(vec![[7.0, 8.0], [9.0, 10.0]]));
        for key in ["size = [1, 2, 3]", "rows = [[1, 2, 3]]", "more = [[1, 2], [1, 2, 3]]"] {
            let refused = read(&format!("place = [1, 2]\n{key}")).unwrap_err();
            assert_eq!(refused, "invalid length 3, expected an array of length 2", "{key}");
        }
        assert_eq!(read("place = [1]").unwrap_err(), "invalid length 1, expected an array of length 2");
    }
}
