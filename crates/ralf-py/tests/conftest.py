"""What the tests share: a simulated recording, real ones where they are at hand, and the command."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import ralf


def _command() -> list[str]:
    """The program that cargo has built, where RALF_CLI names it; else the one that the wheel carries."""
    return [os.environ.get("RALF_CLI") or str(Path(sys.executable).with_name("ralf"))]


@pytest.fixture(scope="session")
def command():
    return _command()


@pytest.fixture(scope="session")
def cli():
    def run(*arguments, status=0):
        done = subprocess.run([*_command(), *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode == status, done.stderr
        return done.stdout

    return run


@pytest.fixture(scope="session")
def drive(tmp_path_factory):
    """A simulated recording of one short sequence, with truth."""
    folder = tmp_path_factory.mktemp("simulated") / "drive"
    ralf_command = Path(sys.executable).with_name("ralf")
    subprocess.run(
        [ralf_command, "simulate", "--preset", "tiny", "--scans", "6", "--no-images", "-o", folder],
        check=True,
        capture_output=True,
    )
    return folder


@pytest.fixture(scope="session")
def run(drive, tmp_path_factory):
    return ralf.label(drive, tmp_path_factory.mktemp("labelled") / "out", evidence=True)


def real_recordings():
    """The real recordings that labelling is tried on, where RALF_TEST_DATA says where they lie."""
    root = os.environ.get("RALF_TEST_DATA")
    if root is None:
        return []
    folder = Path(root)
    found = [folder / name for name in ("nuscenes", "view-of-delft")]
    found += sorted(path for path in (folder / "ros").glob("*") if path.suffix in {".bag", ".mcap", ".db3"})
    return [path for path in found if path.exists()]


def tree(out):
    """All files below a folder; of run.json all but the timings, and not the plan."""
    import json

    found = {}
    for path in sorted(Path(out).rglob("*")):
        if path.is_dir() or path.name == "plan.json":
            continue
        content = path.read_bytes()
        if path.name == "run.json":
            record = json.loads(content)
            del record["timings"]
            content = json.dumps(record).encode()
        found[str(path.relative_to(out))] = content
    return found
