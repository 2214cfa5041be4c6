//! A model's net, read.

use super::super::net::{Net, Scale, Shape};
use super::read::{Line, ReadError, Reader};

impl Reader<'_> {
    /// The net, if there is one.
    pub(super) fn net(&mut self) -> Result<Option<Net>, ReadError> {
        let Some(line) = self.next_if("net")? else { return Ok(None) };
        let shape = shape(line).ok_or_else(|| {
            line.refuse("net and four numbers: features that it reads, width, layers, detections around")
        })?;
        let scales: Vec<Scale> =
            (0..shape.inputs).map(|_| self.with_key("scale")?.scale()).collect::<Result<_, _>>()?;
        let mut net = Net::zeros(shape, scales);
        for weights in net.weights_mut() {
            let line = self.with_key("weights")?;
            let numbers = line.numbers().filter(|numbers| numbers.len() == weights.len());
            let numbers = numbers
                .ok_or_else(|| line.refuse(format!("weights and {} finite numbers", weights.len())))?;
            weights.copy_from_slice(&numbers);
        }
        Ok(Some(net))
    }
}

fn shape(line: Line) -> Option<Shape> {
    let numbers: Vec<usize> = line.rest.split(' ').map(|word| word.parse().ok()).collect::<Option<_>>()?;
    let &[inputs, width, layers, nearest] = numbers.as_slice() else { return None };
    let shape = Shape { inputs, width, layers, nearest };
    shape.is_fine().then_some(shape)
}

impl Line<'_> {
    fn scale(&self) -> Result<Scale, ReadError> {
        let refuse = || self.refuse("scale and pairs of finite numbers");
        let numbers = self.numbers().filter(|numbers| numbers.len() % 2 == 0).ok_or_else(refuse)?;
        let points = numbers.chunks(2).map(|pair| (pair[0], pair[1])).collect();
        Scale::new(points).map_err(|error| self.refuse(error))
    }

    /// All that follows the key, where it is finite numbers.
    fn numbers(&self) -> Option<Vec<f32>> {
        let number = |word: &str| word.parse().ok().filter(|number: &f32| number.is_finite());
        self.rest.split_whitespace().map(number).collect()
    }
}
