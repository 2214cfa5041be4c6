"""Ray, by hand: a head and two nodes of one core on this machine, which lose a worker and a node while they label.

python crates/ralf-py/tests/ray_cluster.py FOLDER [SCANS]

Simulates recordings of SCANS scans a radar (24 if not given) in FOLDER, damages one, and labels all of them in one
process, with one node, with two, and with two of which one is killed together with a worker of the other. Compares
every byte with what one process writes, and prints throughput: by the clock, which says little where others use the
machine, and the time that processors worked on it. Wants `pip install ralf-radar[ray]`, Linux, and some minutes.
"""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import ray
from conftest import tree
from ray.cluster_utils import Cluster

import ralf

# Radar scans of a task: few and long ones to measure, more of them where some get lost.
MEASURED, LOST = 48, 16


def main() -> None:
    """Do all of it."""
    folder = Path(sys.argv[1])
    drives = recordings(folder, scans=int(sys.argv[2]) if len(sys.argv) > 2 else 24)
    began, worked = time.perf_counter(), time.process_time()
    runs = [ralf.label(drive, folder / "whole" / drive.name, evidence=True, jobs=1) for drive in drives[:-1]]
    detections = sum(len(run[sequence]) for run in runs for sequence in run)
    tell("one process", detections, time.perf_counter() - began, time.process_time() - worked)
    rates = [with_nodes(folder, drives, nodes, detections) for nodes in (1, 2)]
    print(f"two nodes against one: {rates[1] / rates[0]:.2f} times the throughput")
    under_fire(folder, drives)


def tell(who: str, detections: int, seconds: float, worked: float) -> float:
    """Print a throughput, and return it: detections a second."""
    cores = f"{worked:.1f} s of processors, {worked / seconds:.2f} at a time"
    print(f"{who}: {detections / seconds:.0f} detections/s ({detections} in {seconds:.1f} s; {cores})", flush=True)
    return detections / seconds


def recordings(folder: Path, scans: int) -> list[Path]:
    """Two simulated recordings, and one that is damaged."""
    shutil.rmtree(folder, ignore_errors=True)
    drives = [folder / "drives" / name for name in ("north", "south", "damaged")]
    command = Path(sys.executable).with_name("ralf")
    for seed, drive in enumerate(drives[:2]):
        arguments = ["--preset", "tiny", "--scans", str(scans), "--no-images", "--seed", str(seed), "-o", drive]
        subprocess.run([command, "simulate", *arguments], check=True, capture_output=True)
    shutil.copytree(drives[0], drives[2])
    first = min(drives[2].glob("sequences/*"))
    (first / "sequence.toml").write_text("[[")
    return drives


def with_nodes(folder: Path, drives: list[Path], nodes: int, detections: int) -> float:
    """How many detections a second so many nodes label, their workers' start among it."""
    cluster = start(nodes)
    began = time.perf_counter()
    done = ralf.ray.label(drives, folder / f"out{nodes}", scans=MEASURED, evidence=True, progress=False)
    seconds = time.perf_counter() - began
    rate = tell(f"{nodes} node{'s' * (nodes > 1)} of one core", detections, seconds, workers_time())
    compare(folder, done)
    stop(cluster)
    return rate


def workers_time() -> float:
    """How long processors have worked for this machine's workers of Ray that still live, s."""
    ticks = 0
    for process in Path("/proc").glob("[0-9]*"):
        try:
            if (process / "cmdline").read_bytes().startswith(b"ray::"):
                # After the name, which may hold anything: utime and stime.
                ticks += sum(map(int, (process / "stat").read_text().rpartition(")")[2].split()[11:13]))
        except OSError:
            continue
    return ticks / os.sysconf("SC_CLK_TCK")


def under_fire(folder: Path, drives: list[Path]) -> None:
    """Kill a worker and a node while each is known to be labelling."""
    cluster = start(2)
    killed: list[str] = []
    attack = threading.Thread(target=lambda: killed.extend(kill(cluster)))
    attack.start()
    done = ralf.ray.label(drives, folder / "fire", scans=LOST, evidence=True, progress=False)
    attack.join()
    print("killed while they labelled: " + ", ".join(killed))
    assert len(killed) == 2, killed
    compare(folder, done)
    stop(cluster)


def start(nodes: int) -> Cluster:
    """A head without cores, and nodes of one."""
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0})
    for _ in range(nodes):
        cluster.add_node(num_cpus=1)
    cluster.wait_for_nodes()
    ray.init(address=cluster.address, log_to_driver=False)
    return cluster


def stop(cluster: Cluster) -> None:
    """Take it down."""
    ray.shutdown()
    cluster.shutdown()


def compare(folder: Path, done: ralf.Assembled) -> None:
    """All labels are there, each as one process writes it, and the damaged recording is named."""
    assert list(done.failed) == ["damaged"], done.failed
    assert "sequence.toml" in done.failed["damaged"]
    assert sorted(done.runs) == ["north", "south"]
    files = 0
    for name, run in done.runs.items():
        found, expected = tree(run.out), tree(folder / "whole" / name)
        found.pop(".ralf-lock", None)
        assert found == expected, name
        files += len(found)
    print(f"  {files} files are those of one process; {done.failed['damaged']}")


def kill(cluster: Cluster) -> list[str]:
    """SIGKILL a worker that labels, then a node whose worker labels."""
    first = labelling(set())[0]
    os.kill(first, signal.SIGKILL)
    node, worker = next(
        (node, worker)
        for _ in range(600)
        for worker in labelling({first})
        for node in cluster.worker_nodes
        if parent(worker) == raylet(node)
    )
    pid = raylet(node)
    cluster.remove_node(node, allow_graceful=False)
    return [f"worker {first}", f"node {pid} with worker {worker}"]


def labelling(others: set[int]) -> list[int]:
    """Processes that label a task right now; waits until there is one."""
    for _ in range(3000):
        found = []
        for process in Path("/proc").glob("[0-9]*"):
            try:
                title = (process / "cmdline").read_bytes()
            except OSError:
                continue
            if title.startswith(b"ray::_label_one"):
                found.append(int(process.name))
        found = [pid for pid in found if pid not in others]
        if found:
            return found
        time.sleep(0.02)
    raise TimeoutError("nobody labels")


def parent(pid: int) -> int | None:
    """The process that started it."""
    try:
        status = Path(f"/proc/{pid}/status").read_text()
    except OSError:
        return None
    return int(status.split("PPid:")[1].split()[0])


def raylet(node: object) -> int:
    """The process that is the node."""
    return node.all_processes["raylet"][0].process.pid


if __name__ == "__main__":
    import ralf.ray

    main()
