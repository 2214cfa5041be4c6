"""Arrays in memory are labelled as files are."""

import numpy as np
import pytest

import ralf


def street(scans=4):
    """A wall to the left of a vehicle that drives along it, seen by a LiDAR and a radar."""
    chance = np.random.default_rng(7)
    turned = np.eye(4)
    turned[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    turned[:3, 3] = [1.5, 0.8, 0.6]
    radar = ralf.Radar("left", mounting=turned, sigma_azimuth_deg=0.8)
    sequence = ralf.Sequence(
        radars=[radar],
        lidars=[ralf.Lidar("top", mounting=(0.0, 0.0, 1.8))],
        motion=ralf.Odometry([0, 1_000_000_000], [5.0, 5.0], [0.0, 0.0]),
    )
    for number in range(scans):
        t_ns = number * 100_000_000
        x = np.arange(-20, 60, 0.25) - 0.5 * number
        wall = np.array([[a, 10.0, b - 1.8] for a in x for b in np.arange(0.1, 3, 0.25)])
        sequence.add_lidar_scan("top", t_ns, wall)
        # Four on the wall, four far behind it; the radar looks to the left.
        seen = np.array([[ahead, side, 1.0] for side in (10.0, 40.0) for ahead in (0.0, 5.0, 10.0, 15.0)])
        seen = seen + chance.normal(0, 0.02, seen.shape)
        xyz = (seen - turned[:3, 3]) @ turned[:3, :3]
        sequence.add_radar_scan("left", t_ns, xyz=xyz, doppler=np.zeros(len(xyz)))
    return sequence


def test_what_lies_on_the_wall_is_plausible():
    labels = street().label({"ground.model": "flat"})
    assert len(labels) == 4 * 8
    for scan in labels.scans("left"):
        assert scan.label[:4].all()
        assert not scan.label[4:].any()
        assert np.allclose(scan.xyz[:4, 1], 10.0, atol=0.2)
    assert labels["w"].dtype == np.float32


def test_a_model_may_answer():
    labels = street(1).label(method="learned", jobs=1)
    assert "cause_probability" in labels.table.columns
    assert ((labels["w"] >= 0) & (labels["w"] <= 1)).all()


def test_labels_are_those_of_the_written_recording(tmp_path):
    import pyarrow as pa

    sequence = street()
    sequence.write(tmp_path / "drive")
    run = ralf.label(tmp_path / "drive", tmp_path / "out", settings={"ground.model": "flat"})
    labels = sequence.label({"ground.model": "flat"}, jobs=2)
    assert pa.table(run["00"]).equals(pa.table(labels))


def test_spherical_coordinates_and_poses_are_taken():
    sequence = ralf.Sequence(
        radars=[ralf.Radar("front", elevation=False)],
        motion=ralf.Poses([0, 100_000_000], [np.eye(4), np.eye(4)]),
    )
    for number in range(3):
        sequence.add_radar_scan("front", number * 50_000_000, range=[10.0], azimuth=[0.1])
    labels = sequence.label()
    assert np.allclose(labels["x"], 10 * np.cos(0.1))
    assert len(labels.scans("front").__next__()) == 1


def test_what_does_not_fit_is_refused():
    sequence = street(1)
    with pytest.raises(KeyError, match="expected a radar of left, found front"):
        sequence.add_radar_scan("front", 0, xyz=[[1, 2, 3]])
    with pytest.raises(ValueError, match="expected the fields"):
        sequence.add_radar_scan("left", 0, xyz=[[1, 2, 3]])
    sequence.add_radar_scan("left", -5, xyz=[[1, 2, 3]], doppler=[0.0])
    with pytest.raises(ralf.RalfError, match="expected a time of 0 ns or later, found -5 ns"):
        sequence.label()
    with pytest.raises(ValueError, match="expected a rotation"):
        ralf.Sequence(radars=[ralf.Radar("a", mounting=np.ones((4, 4)))]).label()
    with pytest.raises(ralf.RalfError, match="values"):
        ralf.Sequence(radars=[ralf.Radar("a", sigma_range_m=-1)]).label()


def test_rotations_become_quaternions_and_back():
    from ralf.memory import _quaternion

    chance = np.random.default_rng(1)
    for _ in range(100):
        q = chance.normal(size=4)
        q /= np.linalg.norm(q)
        x, y, z, w = q
        r = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        found = np.array(_quaternion(r))
        assert np.isclose(abs(found @ q), 1.0)


def test_it_is_quick_to_ask_often_and_memory_stays_flat():
    import gc
    import resource

    sequence = street(2)

    def call(times):
        for _ in range(times):
            sequence.label(jobs=1)
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = call(20)
    assert call(200) - before < 20_000
