"""Arrays that people hand over: what isn't what it is taken for is refused, and never bent until it fits."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def array(values: ArrayLike, place: str, dtype: Any = None) -> NDArray[Any]:
    """An array, not of what a mask hides: NumPy would take what lies below the mask for measured."""
    parts = values if isinstance(values, list | tuple) else [values]
    masks = [np.ma.getmaskarray(part) for part in parts if isinstance(part, np.ma.MaskedArray)]
    if hidden := sum(int(mask.sum()) for mask in masks):
        raise ValueError(f"{place}: expected an array without masked values, found {hidden} of them")
    return np.asarray(values, dtype)


def own(values: ArrayLike, place: str) -> NDArray[np.float32]:
    """A copy in one piece, whatever it is a view of."""
    # NumPy would take a complex number's real part for it, and a word for the number that it spells.
    given = array(values, place)
    if given.dtype.kind not in "biufO":
        raise TypeError(f"{place}: expected numbers, found {given.dtype}")
    return np.array(given, dtype=np.float32, order="C")


def points(values: ArrayLike, place: str) -> NDArray[np.float32]:
    """Rows of x, y, z. An empty list has no width."""
    found = own(values, place)
    if found.shape == (0,):
        return found.reshape(0, 3)
    if found.ndim != 2 or found.shape[1] != 3:
        raise ValueError(f"{place}: expected n x 3, found {found.shape}")
    return found


def column(values: ArrayLike, place: str, rows: int | None = None) -> NDArray[np.float32]:
    """A number for each of so many rows."""
    found = own(values, place)
    if found.ndim != 1 or rows not in {None, len(found)}:
        shape = str(len(found)) if found.ndim == 1 else str(found.shape)
        raise ValueError(f"{place}: expected {'n' if rows is None else rows} numbers, found {shape}")
    return found


def time_ns(value: Any, place: str) -> int:
    """One time."""
    found = times_ns(value, place)
    if found.ndim != 0:
        raise ValueError(f"{place}: expected one time, found {found.shape}")
    return int(found)


def times_ns(values: ArrayLike, place: str) -> NDArray[np.int64]:
    """Times in ns, of whole numbers or of `datetime64`.

    Decimals are refused even where they are whole: they are seconds, or nanoseconds since 1970 that have lost their
    last digits.
    """
    given = array(values, place)
    if given.size == 0:
        return given.astype(np.int64)
    refused = TypeError(f"{place}: expected whole nanoseconds, found {_shown(given)}")
    if given.dtype.kind == "M":
        nanoseconds = given.astype("datetime64[ns]")
        # No time (NaT), finer than a nanosecond, or out of what 64 bits hold: no time is like NaT, not even itself.
        if not np.all(nanoseconds.astype(given.dtype) == given):
            raise refused
        return nanoseconds.astype(np.int64)
    if given.dtype.kind not in "iu" or np.any(given > np.iinfo(np.int64).max):
        raise refused
    return given.astype(np.int64)


def finite(values: ArrayLike, rows: int, place: str) -> NDArray[np.float64]:
    """A finite number for each of so many rows, in double precision."""
    found = array(values, place, np.float64)
    if found.shape != (rows,):
        shape = str(len(found)) if found.ndim == 1 else str(found.shape)
        raise ValueError(f"{place}: expected {rows} numbers, one for each time, found {shape}")
    wrong = np.flatnonzero(~np.isfinite(found))
    if len(wrong):
        raise ValueError(f"{place}: row {wrong[0]}: expected a finite number, found {found[wrong[0]]}")
    return found


def _shown(given: NDArray[Any]) -> str:
    """One number as it is, of several their type."""
    return repr(given.item()) if given.ndim == 0 else f"numbers of type {given.dtype}"
