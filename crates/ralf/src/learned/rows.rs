//! Features of many detections, as a forest reads them.

/// A table of features, a row per detection; NaN where a feature was not observed.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    width: usize,
    values: Vec<f32>,
}

impl Rows {
    /// So many rows of so many features, none of which was observed.
    pub fn absent(rows: usize, width: usize) -> Self {
        Self { width, values: vec![f32::NAN; rows * width] }
    }

    /// Features in a row.
    pub fn width(&self) -> usize {
        self.width
    }

    /// How many rows.
    pub fn len(&self) -> usize {
        self.values.len().checked_div(self.width).unwrap_or(0)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// One detection's features.
    pub fn row(&self, row: usize) -> &[f32] {
        &self.values[row * self.width..][..self.width]
    }

    /// One detection's features, to write to.
    pub fn row_mut(&mut self, row: usize) -> &mut [f32] {
        &mut self.values[row * self.width..][..self.width]
    }

    /// Adds the rows of a table of the same width.
    pub fn append(&mut self, more: &Self) {
        debug_assert_eq!(self.width, more.width, "tables of one width");
        self.values.extend_from_slice(&more.values);
    }

    /// Some of the rows.
    pub fn pick(&self, rows: impl Iterator<Item = usize>) -> Self {
        let mut values = Vec::new();
        for row in rows {
            values.extend_from_slice(self.row(row));
        }
        Self { width: self.width, values }
    }

    /// Some of the columns.
    pub fn pick_columns(&self, columns: &[usize]) -> Self {
        let mut values = Vec::with_capacity(self.len() * columns.len());
        for row in 0..self.len() {
            values.extend(columns.iter().map(|column| self.row(row)[*column]));
        }
        Self { width: columns.len(), values }
    }

    /// Sets the features of a column; what is `None` is absent.
    pub fn set_column(&mut self, column: usize, values: &[Option<f64>]) {
        for (row, value) in values.iter().enumerate().take(self.len()) {
            // Without a branch, which is hard to foretell.
            self.row_mut(row)[column] = value.unwrap_or(f64::NAN) as f32;
        }
    }
}
