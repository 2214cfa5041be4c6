#!/usr/bin/env python3
"""Writes testdata/hdf5: one small table, stored in the ways that HDF5 has for it, by the library that made the data sets.

    pip install h5py==3.16.0
    python3 testdata/make_hdf5.py

crates/ralf-data/src/disk/hdf5/tests.rs knows what is in there.
"""

from pathlib import Path

import h5py
import numpy as np

OUT = Path(__file__).parent / "hdf5"
ROWS = 40
TEXT = h5py.string_dtype()
COLUMNS = {
    "whole": "<i4",
    "large": "<u8",
    "single": "<f4",
    "double": "<f8",
    "truth": "?",
    "fixed": "S8",
    "varying": TEXT,
}


def table(varying, big_endian=False):
    """Rows whose values tell their number."""
    kinds = {name: kind for name, kind in COLUMNS.items() if varying or name != "varying"}
    rows = np.zeros(ROWS, list(kinds.items()))
    number = np.arange(ROWS)
    rows["whole"] = number - 3
    rows["large"] = number.astype("u8") << 50
    rows["single"] = number / 4
    rows["double"] = -number / 8
    rows["truth"] = number % 3 == 0
    rows["fixed"] = [b"left" if n % 2 else b"right" for n in number]
    if varying:
        rows["varying"] = [f"M\u00e4rz {n // 4}" if n % 5 else "" for n in number]
    return rows.astype(rows.dtype.newbyteorder(">")) if big_endian else rows


def main():
    OUT.mkdir(exist_ok=True)

    def write(name, rows, libver=None, **layout):
        with h5py.File(OUT / f"{name}.h5", "w", libver=libver) as file:
            file.create_dataset("rows", data=rows, **layout)

    packed = {"chunks": (16,), "compression": "gzip", "shuffle": True}
    write("contiguous", table(varying=True))
    write("packed", table(varying=True), **packed)
    write("growing", table(varying=False), maxshape=(None,), fletcher32=True, **packed)
    write("big_endian", table(varying=False, big_endian=True))
    write("latest", table(varying=True), libver="latest", **packed)
    write("lzf", table(varying=False), chunks=(16,), compression="lzf", shuffle=True)
    write("none", table(varying=False)[:0])
    with h5py.File(OUT / "no_table.h5", "w") as file:
        file["numbers"] = np.arange(3.0)
        file["square"] = np.zeros((2, 2), [("whole", "<i4")])
        file["odd"] = np.zeros(2, [("list", "<f4", (3,)), ("inside", [("a", "<i2")])])


if __name__ == "__main__":
    main()
