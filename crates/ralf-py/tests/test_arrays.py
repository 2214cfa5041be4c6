"""Arrays that are not what they are taken for are refused by name, not bent until they fit."""

import numpy as np
import pytest

import ralf


def sequence():
    return ralf.Sequence(radars=[ralf.Radar("front")], lidars=[ralf.Lidar("top")])


@pytest.mark.parametrize("shape", [(1200, 4), (3, 1200), (3,), (1200, 2), (2, 3, 3), ()])
def test_points_of_another_shape_are_refused(shape):
    found = sequence()
    cloud = np.zeros(shape)
    with pytest.raises(ValueError) as raised:
        found.add_lidar_scan("top", 0, cloud)
    assert str(raised.value) == f"top: points: expected n x 3, found {shape}"
    with pytest.raises(ValueError) as raised:
        found.add_radar_scan("front", 0, xyz=cloud)
    assert str(raised.value) == f"front: xyz: expected n x 3, found {shape}"
    # What was refused has left nothing behind.
    found.add_lidar_scan("top", 0, np.ones((2, 3)))
    found.add_radar_scan("front", 0, range=[9.0], azimuth=[0.0], elevation=[0.0])
    assert len(found.label()) == 1


def test_an_empty_list_is_a_scan_without_points():
    found = sequence()
    found.add_lidar_scan("top", 0, [])
    found.add_radar_scan("front", 0, xyz=[], doppler=[])
    assert len(found.label()) == 0


def test_numbers_of_another_shape_or_count_are_refused():
    found = sequence()
    points = np.ones((4, 3))
    with pytest.raises(ValueError, match="front: doppler: expected 4 numbers, found 3"):
        found.add_radar_scan("front", 0, xyz=points, doppler=np.zeros(3))
    with pytest.raises(ValueError, match="front: azimuth: expected 4 numbers, found 2"):
        found.add_radar_scan("front", 0, range=np.ones(4), azimuth=np.zeros(2), elevation=np.zeros(4))
    with pytest.raises(ValueError, match=r"front: doppler: expected 4 numbers, found \(2, 2\)"):
        found.add_radar_scan("front", 0, xyz=points, doppler=np.zeros((2, 2)))
    with pytest.raises(ValueError, match=r"front: range: expected n numbers, found \(\)"):
        found.add_radar_scan("front", 0, range=9.0, azimuth=0.0, elevation=0.0)
    with pytest.raises(ValueError, match="front: expected xyz or x, y and z, found xyz and x"):
        found.add_radar_scan("front", 0, xyz=points, x=np.zeros(4))
    with pytest.raises(ValueError, match="top: intensity: expected 4 numbers, found 8"):
        found.add_lidar_scan("top", 0, points, np.zeros(8))
    with pytest.raises(ValueError, match="top: times: expected 4 numbers, found 1"):
        found.add_lidar_scan("top", 0, points, times=[0.0])
    with pytest.raises(TypeError, match="top: points: expected numbers, found complex128"):
        found.add_lidar_scan("top", 0, points * 1j)


def test_what_a_mask_hides_is_not_taken_for_measured():
    found = sequence()
    points = np.ma.array(np.ones((2, 3)), mask=[[False] * 3, [True] * 3])
    far = np.ma.array([1.0, 2.0], mask=[False, True])
    refused = "expected an array without masked values, found {} of them"
    for place, hidden, add in (
        ("top: points", 3, lambda: found.add_lidar_scan("top", 0, points)),
        ("top: points", 3, lambda: found.add_lidar_scan("top", 0, list(points))),
        ("top: intensity", 1, lambda: found.add_lidar_scan("top", 0, np.ones((2, 3)), far)),
        ("front: xyz", 3, lambda: found.add_radar_scan("front", 0, xyz=points)),
        ("front: doppler", 1, lambda: found.add_radar_scan("front", 0, xyz=np.ones((2, 3)), doppler=far)),
        ("odometry: t_ns", 1, lambda: motion(ralf.Odometry(far.astype(int), [1.0, 1.0], [0.0, 0.0]))),
        ("odometry: velocity", 1, lambda: motion(ralf.Odometry([0, 1], far, [0.0, 0.0]))),
        ("poses", 1, lambda: motion(ralf.Poses([0], [np.ma.masked_equal(np.eye(4) + np.diag([1, 0, 0, 0]), 2)]))),
    ):
        with pytest.raises(ValueError) as raised:
            add()
        assert str(raised.value) == f"{place}: {refused.format(hidden)}"
    # A mask that hides nothing is none.
    found.add_radar_scan("front", 0, xyz=np.ma.array(np.ones((2, 3))), doppler=np.ma.array([1.0, 2.0], mask=False))
    assert len(found.label()) == 2


def motion(told):
    return ralf.Sequence(radars=[ralf.Radar("front")], motion=told)


@pytest.mark.parametrize(
    "t_ns", [1695.75, 1695.0, np.float64(1e9), "1695", None, 2**63, np.uint64(2**63), np.datetime64("NaT")]
)
def test_times_that_are_no_whole_nanoseconds_are_refused(t_ns):
    found = ralf.Sequence(
        radars=[ralf.Radar("front")],
        lidars=[ralf.Lidar("top")],
        cameras=[ralf.Camera("eye", (0.0, 0.0, 1.0), 4, 4, ralf.Pinhole(4, 4, 2, 2))],
    )
    with pytest.raises(TypeError, match=r"front: t_ns: expected whole nanoseconds, found \S"):
        found.add_radar_scan("front", t_ns, xyz=[[1, 2, 3]])
    with pytest.raises(TypeError, match="top: t_ns: expected whole nanoseconds"):
        found.add_lidar_scan("top", t_ns, [[1, 2, 3]])
    with pytest.raises(TypeError, match="eye: t_ns: expected whole nanoseconds"):
        found.add_image("eye", t_ns, np.zeros((4, 4, 3), np.uint8))
    with pytest.raises(TypeError, match="odometry: t_ns: expected whole nanoseconds"):
        ralf.Sequence([ralf.Radar("front")], motion=ralf.Odometry([0, t_ns], [1.0, 1.0], [0.0, 0.0]))
    with pytest.raises(TypeError, match="poses: t_ns: expected whole nanoseconds"):
        ralf.Sequence([ralf.Radar("front")], motion=ralf.Poses([0, t_ns], [np.eye(4), np.eye(4)]))


@pytest.mark.parametrize(
    "t_ns", [1_500, np.int32(1_500), np.uint64(1_500), np.array(1_500), np.datetime64(1_500, "ns")]
)
def test_whole_numbers_and_datetimes_are_times(t_ns):
    found = ralf.Sequence([ralf.Radar("front")], motion=ralf.Odometry([t_ns, t_ns], [1.0, 1.0], [0.0, 0.0]))
    found.add_radar_scan("front", t_ns, xyz=[[9, 0, 0]])
    assert found.label()["t_ns"].tolist() == [1_500]


def test_datetimes_of_another_unit_are_times_as_far_as_they_fit():
    from ralf._arrays import times_ns

    assert times_ns(np.array(["2024-05-01T00:00:00.000001"], "datetime64[us]"), "").tolist() == [1714521600000001000]
    for wrong in (np.array([1], "datetime64[ps]"), np.array(["3000-01-01"], "datetime64[s]")):
        with pytest.raises(TypeError, match=r"expected whole nanoseconds, found numbers of type datetime64\[p?s\]"):
            times_ns(wrong, "motion")


def test_motion_that_is_no_number_is_named():
    times, fine = [0, 1, 2], [1.0, 1.0, 1.0]
    nan, inf = [1.0, 1.0, float("nan")], [1.0, float("inf"), 1.0]

    def refused(motion):
        with pytest.raises(ValueError) as raised:
            ralf.Sequence([ralf.Radar("front")], motion=motion)
        return str(raised.value)

    assert refused(ralf.Odometry(times, nan, fine)) == "odometry: velocity: row 2: expected a finite number, found nan"
    assert refused(ralf.Odometry(times, fine, inf)) == "odometry: yaw_rate: row 1: expected a finite number, found inf"
    expected = "odometry: velocity: expected 3 numbers, one for each time, found"
    assert refused(ralf.Odometry(times, fine[:2], fine)) == f"{expected} 2"
    assert refused(ralf.Odometry(times, 1.0, fine)) == f"{expected} ()"
    poses = np.array([np.eye(4)] * 3)
    assert refused(ralf.Poses(times, poses[:2])) == "poses: expected 3, one for each time, found 2"
    assert refused(ralf.Poses([times], poses[:1])) == "poses: t_ns: expected n times, found (1, 3)"
    poses[1, 0, 3] = np.nan
    assert refused(ralf.Poses(times, poses)) == "poses: row 1: expected finite numbers, found nan among them"


def test_a_mounting_that_is_none_is_named():
    def refused(mounting, **values):
        with pytest.raises(ValueError) as raised:
            ralf.Sequence(radars=[ralf.Radar("front", mounting, **values)]).label()
        return str(raised.value)

    moved = np.eye(4)
    moved[:3, 3] = [1.5, 0.0, 0.5]
    transposed = "front: mounting: expected 0 0 0 1 in the last row of the matrix, found [1.5, 0.0, 0.5, 1.0]"
    assert refused(moved.T) == transposed
    assert "front: mounting: expected finite numbers, found nan" in refused((0.0, np.nan, 0.0))
    assert "front: mounting: expected a rotation" in refused(np.ones((4, 4)))
    assert "front: mounting: expected a 4 x 4 matrix" in refused(np.eye(3))
    assert refused((0, 0, 0), sigma_range_m=np.inf) == "front: sigma_range_m: expected a finite number, found inf"
    nothing = [(0.0, float("nan"))]
    assert refused((0, 0, 0), reliability=nothing) == "front: reliability: expected a finite number, found nan"


def test_whether_a_radar_measures_elevation_is_a_truth_or_a_word_of_files():
    for elevation in (True, False, np.bool_(False), "measured", "none"):
        sequence = ralf.Sequence([ralf.Radar("front", elevation=elevation)], name="a")
        sequence.add_radar_scan("front", 0, xyz=[[9.0, 0.0, 0.0]])
        measured = not np.isnan(sequence.label()["elevation"][0])
        assert measured == (elevation in (True, "measured"))
    for elevation, error in (("None", ValueError), ("", ValueError), (None, TypeError), (0, TypeError)):
        with pytest.raises(error, match="front: elevation: expected True or False"):
            ralf.Radar("front", elevation=elevation)


def test_what_is_no_finite_number_is_absent_to_numpy_and_arrow_alike():
    found = sequence()
    found.add_radar_scan("front", 0, xyz=np.eye(3), doppler=[np.inf, 1.0, -np.inf])
    assert np.array_equal(found.label()["doppler"], [np.nan, 1.0, np.nan], equal_nan=True)
