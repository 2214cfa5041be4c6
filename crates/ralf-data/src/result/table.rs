//! Named, typed columns of equal length: the one shape that results have in memory.

use super::schema::{Column, Kind, Schema};
use crate::error::DataError;
use std::ops::Range;
use std::sync::Arc;

/// The values of a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// See [`Kind::Text`].
    Text(Vec<Arc<str>>),
    /// See [`Kind::U8`].
    U8(Vec<u8>),
    /// See [`Kind::U16`].
    U16(Vec<u16>),
    /// See [`Kind::U32`].
    U32(Vec<u32>),
    /// See [`Kind::I64`].
    I64(Vec<i64>),
    /// What is not finite is absent.
    F32(Vec<f32>),
    /// See [`Kind::Class`].
    Class(Vec<Option<u16>>),
    /// See [`Kind::Truth`].
    Truth(Vec<Option<bool>>),
}

/// Does the same with the values of any column.
macro_rules! each_kind {
    ($values:expr, $found:ident => $done:expr) => {
        match $values {
            Values::Text($found) => $done,
            Values::U8($found) => $done,
            Values::U16($found) => $done,
            Values::U32($found) => $done,
            Values::I64($found) => $done,
            Values::F32($found) => $done,
            Values::Class($found) => $done,
            Values::Truth($found) => $done,
        }
    };
}

/// A type that a column may hold.
pub trait Value: Sized {
    /// The values, where they are of this type.
    fn of(values: &Values) -> Option<&[Self]>;
}

macro_rules! value {
    ($($kind:ident: $type:ty),*) => {$(
        impl Value for $type {
            fn of(values: &Values) -> Option<&[Self]> {
                match values {
                    Values::$kind(found) => Some(found),
                    _ => None,
                }
            }
        }
    )*};
}

value!(Text: Arc<str>, U8: u8, U16: u16, U32: u32, I64: i64, F32: f32, Class: Option<u16>, Truth: Option<bool>);

impl Values {
    /// None of this kind.
    pub(crate) fn none(kind: Kind) -> Self {
        match kind {
            Kind::Text => Self::Text(Vec::new()),
            Kind::U8 => Self::U8(Vec::new()),
            Kind::U16 => Self::U16(Vec::new()),
            Kind::U32 => Self::U32(Vec::new()),
            Kind::I64 => Self::I64(Vec::new()),
            Kind::F32 => Self::F32(Vec::new()),
            Kind::Class => Self::Class(Vec::new()),
            Kind::Truth => Self::Truth(Vec::new()),
        }
    }

    /// So many that are absent: no number, no class, unknown, an empty text; 0 of a kind that never is.
    pub(crate) fn absent(kind: Kind, rows: usize) -> Self {
        match kind {
            Kind::Text => Self::Text(vec!["".into(); rows]),
            Kind::U8 => Self::U8(vec![0; rows]),
            Kind::U16 => Self::U16(vec![0; rows]),
            Kind::U32 => Self::U32(vec![0; rows]),
            Kind::I64 => Self::I64(vec![0; rows]),
            Kind::F32 => Self::F32(vec![f32::NAN; rows]),
            Kind::Class => Self::Class(vec![None; rows]),
            Kind::Truth => Self::Truth(vec![None; rows]),
        }
    }

    /// Their kind.
    pub fn kind(&self) -> Kind {
        match self {
            Self::Text(_) => Kind::Text,
            Self::U8(_) => Kind::U8,
            Self::U16(_) => Kind::U16,
            Self::U32(_) => Kind::U32,
            Self::I64(_) => Kind::I64,
            Self::F32(_) => Kind::F32,
            Self::Class(_) => Kind::Class,
            Self::Truth(_) => Kind::Truth,
        }
    }

    /// How many.
    pub fn len(&self) -> usize {
        each_kind!(self, values => values.len())
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Those of some rows.
    pub fn slice(&self, rows: Range<usize>) -> Self {
        match self {
            Self::Text(values) => Self::Text(values[rows].to_vec()),
            Self::U8(values) => Self::U8(values[rows].to_vec()),
            Self::U16(values) => Self::U16(values[rows].to_vec()),
            Self::U32(values) => Self::U32(values[rows].to_vec()),
            Self::I64(values) => Self::I64(values[rows].to_vec()),
            Self::F32(values) => Self::F32(values[rows].to_vec()),
            Self::Class(values) => Self::Class(values[rows].to_vec()),
            Self::Truth(values) => Self::Truth(values[rows].to_vec()),
        }
    }

    /// Those of these rows, in their order.
    pub fn pick(&self, rows: &[usize]) -> Self {
        fn of<T: Clone>(values: &[T], rows: &[usize]) -> Vec<T> {
            rows.iter().map(|row| values[*row].clone()).collect()
        }
        match self {
            Self::Text(values) => Self::Text(of(values, rows)),
            Self::U8(values) => Self::U8(of(values, rows)),
            Self::U16(values) => Self::U16(of(values, rows)),
            Self::U32(values) => Self::U32(of(values, rows)),
            Self::I64(values) => Self::I64(of(values, rows)),
            Self::F32(values) => Self::F32(of(values, rows)),
            Self::Class(values) => Self::Class(of(values, rows)),
            Self::Truth(values) => Self::Truth(of(values, rows)),
        }
    }

    /// Adds values of the same kind. Returns whether they are.
    pub(crate) fn append(&mut self, others: &Self) -> bool {
        match (self, others) {
            (Self::Text(all), Self::Text(more)) => all.extend_from_slice(more),
            (Self::U8(all), Self::U8(more)) => all.extend_from_slice(more),
            (Self::U16(all), Self::U16(more)) => all.extend_from_slice(more),
            (Self::U32(all), Self::U32(more)) => all.extend_from_slice(more),
            (Self::I64(all), Self::I64(more)) => all.extend_from_slice(more),
            (Self::F32(all), Self::F32(more)) => all.extend_from_slice(more),
            (Self::Class(all), Self::Class(more)) => all.extend_from_slice(more),
            (Self::Truth(all), Self::Truth(more)) => all.extend_from_slice(more),
            _ => return false,
        }
        true
    }
}

/// Columns by name. Asking for one that isn't there, or for another type than it has, is an error.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    schema: Arc<Schema>,
    values: Vec<Values>,
}

impl Table {
    /// A table without rows.
    pub fn empty(schema: Arc<Schema>) -> Self {
        let values = schema.columns().iter().map(|column| Values::none(column.kind)).collect();
        Self { schema, values }
    }

    /// The same with room for so many.
    pub(crate) fn with_room(schema: Arc<Schema>, rows: usize) -> Self {
        let mut table = Self::empty(schema);
        table.values.iter_mut().for_each(|values| each_kind!(values, values => values.reserve_exact(rows)));
        table
    }

    /// The values of all columns in their order.
    ///
    /// # Errors
    /// Another number of columns, another kind, or columns of different lengths.
    pub fn new(schema: Arc<Schema>, values: Vec<Values>) -> Result<Self, DataError> {
        let wrong = |name: &str, found: String| DataError::WrongColumn { name: name.to_owned(), found };
        if values.len() != schema.columns().len() {
            return Err(wrong("*", format!("{} columns of {}", values.len(), schema.columns().len())));
        }
        let rows = values.first().map_or(0, Values::len);
        for (column, values) in schema.columns().iter().zip(&values) {
            if values.kind() != column.kind || values.len() != rows {
                return Err(wrong(
                    &column.name,
                    format!("{} values of {:?} for {rows} rows", values.len(), values.kind()),
                ));
            }
        }
        Ok(Self { schema, values })
    }

    /// Its columns.
    pub fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// How many rows.
    pub fn len(&self) -> usize {
        self.values.first().map_or(0, Values::len)
    }

    /// Whether it has no rows.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All columns with their values, in order.
    pub fn columns(&self) -> impl Iterator<Item = (&Column, &Values)> {
        self.schema.columns().iter().zip(&self.values)
    }

    /// The values of all columns, in order.
    pub(crate) fn values(&self) -> &[Values] {
        &self.values
    }

    /// The same, and nothing else of the table.
    pub fn into_values(self) -> Vec<Values> {
        self.values
    }

    /// The values of a column.
    ///
    /// # Errors
    /// No such column, or one of another type.
    pub fn get<T: Value>(&self, name: &str) -> Result<&[T], DataError> {
        let values = &self.values[self.schema.place(name)?];
        T::of(values).ok_or_else(|| {
            let found = format!("{:?}", values.kind());
            DataError::WrongColumn { name: name.to_owned(), found }
        })
    }

    /// Some rows.
    pub fn slice(&self, rows: Range<usize>) -> Self {
        let values = self.values.iter().map(|values| values.slice(rows.clone())).collect();
        Self { schema: self.schema.clone(), values }
    }

    /// Adds the rows of a table with the same columns.
    ///
    /// # Errors
    /// Other columns.
    pub fn append(&mut self, other: &Self) -> Result<(), DataError> {
        if self.schema != other.schema {
            return Err(DataError::WrongColumn {
                name: "*".into(),
                found: "a table with other columns".into(),
            });
        }
        for (all, more) in self.values.iter_mut().zip(&other.values) {
            all.append(more);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::schema::field;

    fn table(values: Vec<f32>) -> Table {
        Table::new(Arc::new(Schema::new(vec![field("a")])), vec![Values::F32(values)]).unwrap()
    }

    #[test]
    fn rows_are_cut_and_put_together() {
        let mut all = table(vec![1.0, 2.0]);
        all.append(&table(vec![3.0]).slice(0..1)).unwrap();
        assert_eq!(all.get::<f32>("a").unwrap(), [1.0, 2.0, 3.0]);
        assert_eq!(all.slice(1..3), table(vec![2.0, 3.0]));
    }

    #[test]
    fn what_does_not_fit_is_an_error_and_never_an_empty_answer() {
        let found = table(vec![1.0]);
        assert!(found.get::<f32>("b").unwrap_err().to_string().contains("no column `b`"));
        assert!(found.get::<u16>("a").unwrap_err().to_string().contains("`a`"));
        let schema = Arc::new(Schema::new(vec![field("a"), field("b")]));
        assert!(Table::new(schema.clone(), vec![Values::F32(vec![1.0])]).is_err());
        assert!(Table::new(schema.clone(), vec![Values::F32(vec![1.0]), Values::F32(vec![])]).is_err());
        assert!(Table::new(schema.clone(), vec![Values::F32(vec![1.0]), Values::U8(vec![1])]).is_err());
        assert!(table(vec![]).append(&Table::empty(schema)).is_err());
    }
}
