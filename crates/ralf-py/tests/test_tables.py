"""Tables cross without a copy, and say what the files say."""

import gc
import resource

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

import ralf


@pytest.fixture(scope="module")
def table(run):
    return run[run.sequences[0]]


def test_a_table_is_what_the_file_holds(run, table):
    file = run.out / "sequences" / run.sequences[0] / "plausibility.parquet"
    assert pa.table(table).equals(pq.read_table(file))
    assert table.columns == pq.read_schema(file).names
    assert len(table) == pq.read_metadata(file).num_rows
    assert table.told("range") == ("m", "Distance from the radar, as measured.")


def test_arrow_and_numpy_look_at_the_same_memory(table):
    arrow = pa.table(table)
    for name in ("x", "w", "label", "flags", "point", "t_ns", "d_lm"):
        column = table.column(name, 0)
        (chunk,) = arrow.column(name).chunks
        view = np.asarray(column)
        assert chunk.buffers()[1].address == column.address == view.__array_interface__["data"][0], name
        assert not view.flags.writeable
        assert view.dtype == chunk.type.to_pandas_dtype()


def test_views_outlive_the_table(run):
    view = np.asarray(run[run.sequences[0]].column("w", 0))
    copy = view.copy()
    gc.collect()
    for _ in range(50):
        run[run.sequences[0]]
    assert np.array_equal(view, copy)


def test_scans_are_views_of_their_rows(run, table):
    rows = pa.table(table)
    seen = 0
    for scan in run.scans(run.sequences[0]):
        part = rows.slice(seen, len(scan))
        assert set(part["radar"].to_pylist()) == {scan.radar}
        assert set(part["scan"].to_pylist()) == {scan.number}
        assert scan.w.base is not None
        assert np.array_equal(scan.w, part["w"].to_numpy())
        assert np.array_equal(scan.xyz[:, 1], part["y"].to_numpy())
        assert scan.t_ns == part["t_ns"][0].as_py()
        # What Arrow calls absent is NaN here.
        absent = np.array([value is None for value in part["d_lm"].to_pylist()])
        assert np.array_equal(np.isnan(scan["d_lm"]), absent)
        seen += len(scan)
    assert seen == len(table)
    front = list(run.scans(run.sequences[0], radar=scan.radar))
    assert {scan.radar for scan in front} == {scan.radar}
    assert "lidar_residual_horizontal" in front[0].evidence or front[0].evidence


def test_what_is_not_there_is_told(run, table):
    with pytest.raises(KeyError, match="expected one of radar, scan, point"):
        table.column("w_lidar", 0)
    with pytest.raises(IndexError, match="batch below"):
        table.column("w", 7)
    with pytest.raises(TypeError, match="numbers"):
        table.column("radar", 0)
    with pytest.raises(ralf.RalfError, match="no sequence `99`"):
        run["99"]


def test_polars_and_pandas_read_it(table):
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(table)
    assert frame.height == len(table)
    assert frame["w"].to_list() == pa.table(table)["w"].to_pylist()
    pandas = pytest.importorskip("pandas")
    assert len(
        pandas.DataFrame.from_arrow(table) if hasattr(pandas.DataFrame, "from_arrow") else pa.table(table).to_pandas()
    ) == len(table)


def test_measurements_are_those_of_the_recording(drive, run):
    recording = ralf.open(drive)
    (name,) = recording.sequences
    info = recording[name]
    for scan in run.scans(name):
        measured = recording.radar_scan(name, scan.radar, scan.number)
        assert measured.t_ns == scan.t_ns == info.radars[scan.radar][scan.number]
        assert list(measured.fields) == info.fields[scan.radar]
        assert np.array_equal(measured["doppler"], scan["doppler"])
    lidar = next(iter(info.lidars))
    revolution = recording.lidar_scan(name, lidar, 0)
    assert revolution.points.shape == (len(revolution.intensity), 3)
    with pytest.raises(ralf.RalfError):
        recording.lidar_scan(name, lidar, 10_000)


def test_memory_stays_flat_over_ten_thousand_calls(drive, tmp_path):
    run = ralf.label(drive, tmp_path / "out")
    (name,) = run.sequences

    def call(tables):
        for _ in range(tables):
            table = run[name]
            for _ in range(50):
                np.asarray(table.column("w", 0)).sum()
                pa.table(table)
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    # Two hundred tables, or ten thousand copies of a column, would be more than is allowed for.
    assert 200 * pa.table(run[name]).nbytes > 20_000_000
    assert 10_000 * pa.table(run[name])["w"].nbytes > 20_000_000
    before = call(10)
    after = call(200)
    assert after - before < 10_000, f"{before} kB before, {after} kB after"
