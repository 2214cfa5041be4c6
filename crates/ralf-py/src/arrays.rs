//! Memory that NumPy looks into, and columns that NumPy hands over.

use arrow_buffer::Buffer;
use pyo3::buffer::{Element, PyBuffer};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use ralf::sensors::{CameraImage, DepthImage};

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

    /// The pixels of an image, row by row: red, green, blue each.
    pub(crate) fn of_image(image: CameraImage) -> Self {
        let shape = vec![image.height, image.width, 3];
        Self { buffer: Buffer::from_vec(image.rgb.into_flattened()), typestr: "|u1", shape }
    }

    /// The values of a depth image, row by row.
    pub(crate) fn of_depth(depth: DepthImage) -> Self {
        let shape = vec![depth.height, depth.width];
        Self { buffer: Buffer::from_vec(depth.values), typestr: "<f4", shape }
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

/// An image of bytes: height x width x 3.
pub(crate) fn image(array: &Bound<'_, PyAny>) -> PyResult<CameraImage> {
    let [height, width, 3] = PyBuffer::<u8>::get(array)?.shape()[..] else {
        return Err(PyValueError::new_err("expected an image of height x width x 3, found another shape"));
    };
    Ok(CameraImage { width, height, rgb: rows(array)? })
}

/// A depth image: height x width.
pub(crate) fn depth(array: &Bound<'_, PyAny>) -> PyResult<DepthImage> {
    let [height, width] = PyBuffer::<f32>::get(array)?.shape()[..] else {
        return Err(PyValueError::new_err("expected depth of height x width, found another shape"));
    };
    Ok(DepthImage { width, height, values: numbers(array)? })
}
