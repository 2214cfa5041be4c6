//! Memory that NumPy looks into, and columns that NumPy hands over.

use arrow_buffer::Buffer;
use pyo3::buffer::{Element, PyBuffer};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// Numbers in memory that NumPy looks into without a copy: `numpy.asarray(column)`. They can't be changed.
#[pyclass(frozen, module = "ralf._ralf")]
pub(crate) struct Column {
    buffer: Buffer,
    /// As NumPy writes types: `<f4`.
    typestr: &'static str,
    shape: Vec<usize>,
}

impl Column {
    /// Rows of `width` numbers; of a width of 1 plain numbers.
    pub(crate) fn new(buffer: Buffer, typestr: &'static str, rows: usize, width: usize) -> Self {
        let shape = if width == 1 { vec![rows] } else { vec![rows, width] };
        Self { buffer, typestr, shape }
    }
}

#[pymethods]
impl Column {
    /// Where the numbers lie, as NumPy asks for it.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("data", (self.address(), true))?;
        interface.set_item("shape", pyo3::types::PyTuple::new(py, &self.shape)?)?;
        interface.set_item("typestr", self.typestr)?;
        interface.set_item("version", 3)?;
        Ok(interface)
    }

    /// Where the first number lies.
    #[getter]
    fn address(&self) -> usize {
        self.buffer.as_ptr().addr()
    }

    fn __len__(&self) -> usize {
        self.shape.first().copied().unwrap_or_default()
    }
}

/// The numbers of a contiguous array of this type, row by row.
pub(crate) fn numbers<T: Element>(array: &Bound<'_, PyAny>) -> PyResult<Vec<T>> {
    PyBuffer::<T>::get(array)?.to_vec(array.py())
}

/// The same as rows of `N`.
pub(crate) fn rows<T: Element, const N: usize>(array: &Bound<'_, PyAny>) -> PyResult<Vec<[T; N]>> {
    let numbers = numbers::<T>(array)?;
    let (rows, rest) = numbers.as_chunks::<N>();
    if rest.is_empty() {
        return Ok(rows.to_vec());
    }
    Err(PyValueError::new_err(format!("expected rows of {N}, found {} numbers", numbers.len())))
}
