"""What labelling costs: core seconds and bytes of a recording, and of 1,000 hours like it (docs/cost.md).

target/python/bin/python scripts/cost.py RECORDING [evidence]

Plans, labels and puts together in a temporary folder, by one thread, and counts this process's own processor time,
which says nearly the same on a busy machine as on a quiet one.
"""

import resource
import sys
import tempfile
from pathlib import Path

import ralf


def main():
    """Prints a row per step, and what 1,000 hours take."""
    source, evidence = Path(sys.argv[1]), "evidence" in sys.argv[2:]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        plan, planning = cost(lambda: ralf.plan([source], out, evidence=evidence, jobs=1))
        _, labelling = cost(lambda: [ralf.label_one(task) for task in plan])
        on_the_way = size(out)
        done, assembling = cost(lambda: ralf.assemble(out, jobs=1))
        (run,) = done.runs.values()
        hours = recorded_s(source) / 3600
        read = sum(item["bytes"] for item in run.record["inputs"])
        radars = [radar["detections"] for item in run.record["sequences"] for radar in item["radars"]]
        scans, detections = sum(map(len, radars)), sum(map(sum, radars))
        steps = {"plan": planning, "label": labelling, "assemble": assembling}
        print(f"{scans} radar scans, {detections} detections, {hours * 3600:.1f} s, {read / 1e6:.1f} MB of inputs")
        for name, seconds in steps.items():
            core_hours = seconds / hours / 3600 * 1000
            print(f"{name:8} {1e3 * seconds / scans:7.2f} ms a scan {core_hours:8.0f} core hours for 1,000 hours")
        sizes = {"inputs, read twice": read, "on the way": on_the_way, "results": size(run.out)}
        for name, number in sizes.items():
            print(f"{name:18} {number / hours / 1e12 * 1000:7.2f} TB for 1,000 hours")


def recorded_s(source):
    """How long the recording's sequences are, together."""
    recording = ralf.open(source)
    sequences = (recording[name] for name in recording.sequences)
    spans = ([times for times in info.radars.values() if len(times)] for info in sequences)
    return sum((max(t[-1] for t in times) - min(t[0] for t in times)) / 1e9 for times in spans)


def cost(work):
    """What comes back, and the processor time that it took, s."""
    before = resource.getrusage(resource.RUSAGE_SELF)
    result = work()
    after = resource.getrusage(resource.RUSAGE_SELF)
    return result, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def size(folder):
    """Bytes of all files below a folder."""
    return sum(path.stat().st_size for path in Path(folder).rglob("*") if path.is_file())


if __name__ == "__main__":
    main()
