//! What tells the class of a detection.

use super::schema::CLASS_FROM;
use super::table::Table;
use crate::error::DataError;
use ralf::label::{ARTIFACT, PLAUSIBLE};
use std::sync::Arc;

/// What tells the class that the machine gave a detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum ClassSource {
    /// The labels of the LiDAR's points around it.
    Lidar,
    /// The segmentation of a camera's image.
    Camera,
}

impl ClassSource {
    /// All of them, in the order of their say.
    pub const ALL: [Self; 2] = [Self::Lidar, Self::Camera];

    /// Its name, as the column `class_from` has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Lidar => "lidar",
            Self::Camera => "camera",
        }
    }

    /// The one of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|source| source.name() == name)
    }
}

impl Table {
    /// What tells the class in each detection's label; `None` where the label has no class. Without a column
    /// `class_from` no camera was asked, and classes are the LiDARs'.
    ///
    /// # Errors
    /// A table that isn't of a labelled scan, or a word in `class_from` that nothing is called by.
    pub fn class_sources(&self) -> Result<Vec<Option<ClassSource>>, DataError> {
        let column = CLASS_FROM.name;
        let told = self.schema().place(&column).is_ok().then(|| self.get::<Arc<str>>(&column)).transpose()?;
        let source = |row: usize| match told {
            None => Ok(ClassSource::Lidar),
            Some(told) => ClassSource::named(&told[row]).ok_or_else(|| {
                let found = format!("`{}` of a detection with a class", told[row]);
                DataError::WrongColumn { name: column.to_string(), found }
            }),
        };
        let labels = self.labels()?.into_iter().enumerate();
        labels.map(|(row, label)| has_class(label.id).then(|| source(row)).transpose()).collect()
    }
}

fn has_class(label: u16) -> bool {
    ![ARTIFACT, PLAUSIBLE].contains(&label)
}

#[cfg(test)]
mod tests {
    use super::super::schema::Schema;
    use super::super::table::Values;
    use super::*;
    use ralf::sensors::Rig;

    /// Detections with these labels, classes and words.
    fn table(rows: &[(u8, Option<u16>, &str)], with_words: bool) -> Table {
        let words: &[_] = if with_words { &[CLASS_FROM] } else { &[] };
        let schema = Schema::of(&Rig::default(), words).unwrap();
        let names = ["label", "semantic", "class_from"];
        let schema = schema.only(if with_words { &names } else { &names[..2] }).unwrap();
        let mut values = vec![
            Values::U8(rows.iter().map(|row| row.0).collect()),
            Values::Class(rows.iter().map(|row| row.1).collect()),
        ];
        if with_words {
            values.push(Values::Text(rows.iter().map(|row| row.2.into()).collect()));
        }
        Table::new(schema, values).unwrap()
    }

    /// A car by each sensor, a plausible one without class, one on the road, and an artifact on a car.
    const ROWS: [(u8, Option<u16>, &str); 5] = [
        (1, Some(10), "lidar"),
        (1, Some(10), "camera"),
        (1, None, ""),
        (1, Some(40), "lidar"),
        (0, Some(10), "lidar"),
    ];

    #[test]
    fn only_a_label_that_is_a_class_has_a_source() {
        let [lidar, camera] = ClassSource::ALL.map(Some);
        assert_eq!(table(&ROWS, true).class_sources().unwrap(), [lidar, camera, None, None, None]);
        assert_eq!(table(&ROWS, false).class_sources().unwrap(), [lidar, lidar, None, None, None]);
    }

    #[test]
    fn a_word_that_nothing_is_called_by_is_refused() {
        for word in ["", "radar"] {
            let error = table(&[(1, Some(10), word)], true).class_sources().unwrap_err().to_string();
            assert!(error.contains("`class_from`") && error.contains(&format!("`{word}`")), "{error}");
        }
    }
}
