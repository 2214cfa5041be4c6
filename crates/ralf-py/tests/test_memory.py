"""Arrays in memory are labelled as files are."""

import dataclasses
import tomllib

import numpy as np
import pytest
from conftest import tree

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


LENSES = {"pinhole": ralf.Pinhole, "kannala-brandt": ralf.KannalaBrandt}


def placed(told):
    return [*told["translation"], *told["quaternion_xyzw"]]


def lens(told):
    return LENSES[told["model"]](*(told[key] for key in ("fx", "fy", "cx", "cy", "distortion")))


def in_memory(drive):
    """The only sequence of a recording in the own layout, as arrays."""
    recording = ralf.open(drive)
    (name,) = recording.sequences
    folder = drive / "sequences" / name
    told = tomllib.loads((folder / "sequence.toml").read_text())
    rows = [line.split(",") for line in (folder / "odometry.csv").read_text().splitlines()[1:]]
    radar = {"fov_azimuth_deg", "fov_elevation_deg", "sigma_range_m", "sigma_azimuth_deg", "sigma_elevation_deg"}
    lidar = {"sigma_range_m", "lowest_beam_deg", "max_range_m"}
    sequence = ralf.Sequence(
        radars=[
            ralf.Radar(s["name"], placed(s), reliability=s["reliability"], **{key: s[key] for key in radar})
            for s in told["radar"]
        ],
        lidars=[ralf.Lidar(s["name"], placed(s), **{key: s[key] for key in lidar}) for s in told["lidar"]],
        cameras=[
            ralf.Camera(s["name"], placed(s), s["width"], s["height"], lens(s), [ralf.View(**v) for v in s["view"]])
            for s in told["camera"]
        ],
        motion=ralf.Odometry([int(t_ns) for t_ns, *_ in rows], *np.array(rows, dtype=float).T[1:]),
        name=name,
        depth_output=told["depth"]["output"],
    )
    info = recording[name]
    for sensor, times in info.radars.items():
        for number in range(len(times)):
            scan = recording.radar_scan(name, sensor, number)
            sequence.add_radar_scan(sensor, scan.t_ns, **scan.fields)
    for sensor, times in info.lidars.items():
        for number in range(len(times)):
            revolution = recording.lidar_scan(name, sensor, number)
            sequence.add_lidar_scan(sensor, revolution.t_ns, revolution.points, revolution.intensity)
    for sensor, times in info.cameras.items():
        for number in range(len(times)):
            image = recording.image(name, sensor, number)
            assert image.t_ns == times[number]
            sequence.add_image(sensor, image.t_ns, image.rgb, image.depth)
    return sequence


def test_cameras_and_depth_in_memory_are_labelled_as_the_command_labels_files(cli, tmp_path):
    import pyarrow as pa
    import pyarrow.parquet as pq

    cli("simulate", "--preset", "tiny", "--scans", 4, "-o", tmp_path / "drive")
    cli("label", "--quiet", tmp_path / "drive", "-o", tmp_path / "out")
    sequence = in_memory(tmp_path / "drive")
    labels = pa.table(sequence.label())
    assert labels["w_cm"].null_count < len(labels)
    assert labels.equals(pq.read_table(tmp_path / "out/sequences/tiny/plausibility.parquet"))
    # Images and depth are written without loss, too.
    sequence.write(tmp_path / "again")
    cli("label", "--quiet", tmp_path / "again", "-o", tmp_path / "out2")
    assert labels.equals(pq.read_table(tmp_path / "out2/sequences/tiny/plausibility.parquet"))


def test_what_is_added_is_the_sequence_s_own(tmp_path):
    import gc
    import weakref

    eye = ralf.Camera("eye", (0.0, 0.0, 1.0), 64, 48, ralf.Pinhole(fx=40, fy=40, cx=31.5, cy=23.5))
    told = {"front": np.full((3, 3), 9, np.float32), "top": np.full((20, 3), 7, np.float32)}
    told["eye"] = np.full((4, 48, 64, 3), 5, np.uint8)
    told["depth"] = np.full((4, 48, 64), 3, np.float32)
    told["times"] = np.full((2, 20), 0.01, np.float32)

    def sequence(change):
        found = ralf.Sequence([ralf.Radar("front")], [ralf.Lidar("top")], cameras=[eye])
        given = {name: array.copy() for name, array in told.items()}
        found.add_radar_scan("front", 0, xyz=given["front"], doppler=given["front"][:, 0])
        found.add_lidar_scan("top", 0, given["top"], given["top"][:, 0], given["times"][0])
        found.add_image("eye", 0, given["eye"][1], given["depth"][1])
        if change:
            for array in given.values():
                array.fill(1)
        return found, [weakref.ref(array) for array in given.values()]

    (changed, alive), (kept, _) = sequence(True), sequence(False)
    gc.collect()
    assert [array() for array in alive] == [None] * len(told)
    changed.write(tmp_path / "changed")
    kept.write(tmp_path / "kept")
    assert tree(tmp_path / "changed") == tree(tmp_path / "kept")
    assert len(changed.label()) == 3


def test_cameras_that_do_not_fit_are_refused():
    lens = ralf.Pinhole(fx=40, fy=np.float32(40), cx=31.5, cy=23.5)
    eye = ralf.Camera("eye", (0.0, 0.0, 1.0), 64, 48, lens)
    image = np.zeros((48, 64, 3), np.uint8)

    def with_image(camera, *arrays):
        sequence = ralf.Sequence(radars=[ralf.Radar("front")], cameras=[camera])
        sequence.add_radar_scan("front", 0, xyz=[[9.0, 0.0, 0.0]])
        sequence.add_image("eye", 0, *arrays)
        return sequence.label()

    assert len(with_image(eye, image[::-1], np.ones((48, 64)))) == 1
    with pytest.raises(TypeError, match="expected an image of uint8, found float64"):
        with_image(eye, image / 255)
    expected = r"eye: expected an image of height x width x 3, \(48, 64, 3\), found "
    with pytest.raises(ValueError, match=expected + r"\(64, 48, 3\)"):
        with_image(eye, image.transpose(1, 0, 2))
    with pytest.raises(ValueError, match=expected + r"\(48, 64\)"):
        with_image(eye, image[..., 0])
    with pytest.raises(ValueError, match="eye: depth: expected 1 arrays, one for each view, found 2"):
        with_image(eye, image, np.ones((2, 48, 64)))
    with pytest.raises(ralf.RalfError, match=r"\[\[camera\]\] eye: fx, fy: expected values above 0, found 0"):
        with_image(dataclasses.replace(eye, lens=ralf.KannalaBrandt(0, 40, 31.5, 23.5)), image)
    with pytest.raises(ralf.RalfError, match="inverse_polynomial: expected coefficients, found none"):
        with_image(dataclasses.replace(eye, lens=ralf.Scaramuzza([], [], (1, 1))), image)


def test_depth_is_refused_where_it_is_not_as_large_as_its_view():
    lens = ralf.Pinhole(fx=40, fy=40, cx=31.5, cy=23.5)
    views = [ralf.View(yaw, 0.0, 60.0, 32, 24) for yaw in (-20.0, 20.0)]
    image, whole = np.zeros((48, 64, 3), np.uint8), np.ones((24, 32))

    def add(views, depth):
        camera = ralf.Camera("eye", (0.0, 0.0, 1.0), 64, 48, lens, views)
        ralf.Sequence(radars=[ralf.Radar("front")], cameras=[camera]).add_image("eye", 0, image, depth)

    add(views, [whole, whole])
    add([], np.ones((48, 64)))
    expected = r"eye: depth: view {}: expected depth of height x width, \({}, {}\), found "
    for depth in (whole.T, whole[:10, :10], np.ones(3)):
        for given in (views, [depth, whole], 0), (views, [whole, depth], 1):
            with pytest.raises(ValueError, match=expected.format(given[2], 24, 32)):
                add(*given[:2])
    with pytest.raises(ValueError, match=expected.format(0, 48, 64) + r"\(64, 48\)"):
        add([], np.ones((64, 48)))


def test_what_does_not_fit_is_refused():
    sequence = street(1)
    with pytest.raises(KeyError, match="expected a radar of left, found front"):
        sequence.add_radar_scan("front", 0, xyz=[[1, 2, 3]])
    with pytest.raises(ValueError, match="expected the fields"):
        sequence.add_radar_scan("left", 0, xyz=[[1, 2, 3]])
    sequence.add_radar_scan("left", -5, xyz=[[1, 2, 3]], doppler=[0.0])
    with pytest.raises(ralf.RalfError, match="expected a time of 0 ns or later, found -5 ns"):
        sequence.label()
    turned = ralf.Odometry([0, 2_000_000_000, 1_000_000_000], [5.0] * 3, [0.0] * 3)
    with pytest.raises(ralf.RalfError, match="odometry: 2: expected a time of 2000000000 ns or later, found 10"):
        ralf.Sequence([ralf.Radar("left")], motion=turned).label()
    with pytest.raises(ValueError, match="expected a rotation"):
        ralf.Sequence(radars=[ralf.Radar("a", mounting=np.ones((4, 4)))]).label()
    with pytest.raises(ralf.RalfError, match="values"):
        ralf.Sequence(radars=[ralf.Radar("a", sigma_range_m=-1)]).label()


def test_rotations_become_quaternions_and_back():
    from ralf.sensors import _quaternion

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


def test_settings_correct_what_lies_in_memory_as_they_correct_files(tmp_path):
    settings = {"corrections.left.add_yaw_deg": 40, "ground.model": "flat"}
    street().write(tmp_path / "drive")
    run = ralf.label(tmp_path / "drive", tmp_path / "out", settings=settings, check=False)
    labels = street().label(settings, check=False)
    assert np.array_equal(labels["w"], np.asarray(run["00"].column("w", 0)))
    assert not np.array_equal(labels["w"], street().label({"ground.model": "flat"}, check=False)["w"])
    with pytest.raises(ralf.RalfError, match="nosuch"):
        street().label({"corrections.nosuch.add_yaw_deg": 40})
    with pytest.raises(ralf.RalfError, match=r"nowhere\.tum"):
        street().label({"motion.trajectory": str(tmp_path / "nowhere.tum")})


def test_points_of_another_clock_are_refused_when_they_are_added():
    sequence = street(1)
    for times, found in ([50.0, 0.0], "50.0"), ([0.0, np.nan], "nan"):
        with pytest.raises(ValueError, match=f"top: times: expected seconds within 1.0 of the scan's, found {found}"):
            sequence.add_lidar_scan("top", 500_000_000, np.ones((2, 3)), times=times)


def test_a_radar_without_places_is_told_of():
    sequence = street(1)
    sequence.add_radar_scan("left", 100_000_000, xyz=np.full((300, 3), np.nan), doppler=np.zeros(300))
    blind = ralf.Sequence(radars=[ralf.Radar("left")], motion=ralf.Odometry([0, 10**9], [5.0, 5.0], [0.0, 0.0]))
    blind.add_radar_scan("left", 0, xyz=np.full((300, 3), np.nan), doppler=np.zeros(300))
    with pytest.warns(UserWarning, match="00 left: "):
        labels = blind.label(check=False)
    assert any("none of its 300 detections has a place" in warning for warning in labels.warnings), labels.warnings


def test_fields_may_come_in_any_order_and_empty_scans_have_no_row():
    def labelled(order):
        sequence = street(1)
        fields = {"xyz": [[5.0, 0.0, 0.0]], "doppler": [2.0]}
        sequence.add_radar_scan("left", 100_000_000, **{name: fields[name] for name in order})
        sequence.add_radar_scan("left", 200_000_000, xyz=[], doppler=[])
        return sequence.label({"ground.model": "flat"}, check=False)

    one, other = labelled(["xyz", "doppler"]), labelled(["doppler", "xyz"])
    assert np.array_equal(one["w"], other["w"])
    assert np.array_equal(one["doppler"], other["doppler"])
    assert [(scan.number, scan.t_ns) for scan in one.scans()] == [(0, 0), (1, 100_000_000)]
