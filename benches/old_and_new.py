#!/usr/bin/env python3
"""Measures two builds of RALF side by side: medians of alternating rounds, for BENCHMARK.md.

    benches/old_and_new.py OLD NEW --recording drive [--recording nuscenes=PATH ...] [--rounds 7]

OLD and NEW are checkouts; both are built first, by their release profile. Each round runs everything of OLD and of NEW in
turn, so that what else the machine does meets both. Printed are the stages of a scan and cameras (`cargo bench`, wall
time of one thread), and whole processes: `label` of each recording by one job and by two, and `simulate` (the time
that it took, its processor time, and the most memory that it held). `--only` takes what has this in its name.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

BENCHES = ("scan", "camera")
UNITS = {"ns": 1e-6, "µs": 1e-3, "ms": 1.0, "s": 1e3}


class Build:
    """A checkout, built: its program, and its benches by name."""

    def __init__(self, checkout):
        self.checkout = Path(checkout).resolve()
        cargo = ["cargo", "build", "--release", "--package", "ralf-cli", "--bin", "ralf"]
        (self.program,) = self.executables(cargo).values()
        names = [argument for bench in BENCHES for argument in ("--bench", bench)]
        self.benches = self.executables(["cargo", "bench", "--workspace", "--no-run", *names])
        self.usage = {}
        self.checks = self.knows("label", "--no-check")

    def knows(self, verb, option):
        """Whether a command has an option."""
        if verb not in self.usage:
            asked = subprocess.run([self.program, verb, "--help"], capture_output=True, text=True, check=True)
            self.usage[verb] = asked.stdout
        return option in self.usage[verb]

    def executables(self, cargo):
        """What a command of cargo built, by target."""
        told = subprocess.run(
            [*cargo, "--message-format", "json"], cwd=self.checkout, stdout=subprocess.PIPE, check=True
        ).stdout
        messages = (json.loads(line) for line in told.splitlines())
        return {message["target"]["name"]: message["executable"] for message in messages if message.get("executable")}


def bench(executable):
    """ms by name: the medians that a bench prints."""
    printed = subprocess.run([executable, "--bench"], capture_output=True, text=True, check=True).stdout
    found = {}
    for line in printed.splitlines():
        cells = [cell.strip() for cell in line.split("│")]
        name = re.match(r"[\s├╰─]*(\S+)", cells[0])
        if name and len(cells) >= 3 and (median := re.fullmatch(r"([\d.]+) (\S+)", cells[2])):
            found[name[1]] = float(median[1]) * UNITS[median[2]]
    return found


def process(command):
    """Seconds that a process took, those of the processor, and MB that it held at most."""
    began = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    complaint = child.stderr.read().decode(errors="replace")
    _, status, used = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode:
        sys.exit(f"{' '.join(map(str, command))}: exit status {child.returncode}\n{complaint}")
    return {
        "s": time.monotonic() - began,
        "CPU s": used.ru_utime + used.ru_stime,
        "kernel s": used.ru_stime,
        "MB": used.ru_maxrss / 1024,
    }


def processes(recordings):
    """Commands by name; `{out}` is a new folder. Those with options that a program doesn't know are left out but for `--no-check`."""
    for name, path in recordings.items():
        for jobs in (1, 2):
            label = ["label", path, "-o", "{out}", "--jobs", str(jobs)]
            yield f"label {name}, --jobs {jobs}", [*label, "--no-check"]
            yield f"label {name}, --jobs {jobs}, checked", label
    paper = ["simulate", "-o", "{out}", "--preset", "paper", "--sequence", "00"]
    yield "simulate --scans 220", [*paper, "--scans", "220"]
    yield "simulate --scans 2200 --no-images", [*paper, "--scans", "2200", "--no-images"]


def measured(build, name, command, kept):
    """One round of one process; nothing where a build can't do it. What it writes stays in a folder: a file system that has
    just removed thousands of files takes longer to make new ones, which told as time in the kernel."""
    if not build.checks:
        command = [a for a in command if a != "--no-check"]
    options = [a for a in command if a.startswith("--")]
    if (name.endswith("checked") and not build.checks) or not all(build.knows(command[0], a) for a in options):
        return {}
    folder = tempfile.mkdtemp(dir=kept)
    arguments = [str(Path(folder) / "out") if a == "{out}" else a for a in command]
    return {f"{name}: {unit}": value for unit, value in process([build.program, *arguments]).items()}


def one_round(build, recordings, only, kept):
    """All that is measured, by name."""
    found = {}
    for target in BENCHES:
        if only in f"bench {target}":
            found |= {f"bench {target}: {name}, ms": ms for name, ms in bench(build.benches[target]).items()}
    for name, command in processes(recordings):
        if only in name:
            found |= measured(build, name, command, kept)
    return found


def main():
    """Builds both, alternates, prints a table in Markdown."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--recording", action="append", default=[], metavar="[NAME=]FOLDER")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--only", default="")
    arguments = parser.parse_args()
    recordings = {}
    for told in arguments.recording:
        name, _, path = told.rpartition("=")
        recordings[name or Path(path).name] = path
    old, new = Build(arguments.old), Build(arguments.new)
    values = {"old": defaultdict(list), "new": defaultdict(list)}
    with tempfile.TemporaryDirectory() as kept:
        for k in range(arguments.rounds):
            for which, build in (("old", old), ("new", new)) if k % 2 == 0 else (("new", new), ("old", old)):
                for name, value in one_round(build, recordings, arguments.only, kept).items():
                    values[which][name].append(value)
            print(f"round {k + 1} of {arguments.rounds}", file=sys.stderr)
    print("| | old | new | old / new |\n| --- | --- | --- | --- |")
    for name in values["new"]:
        before, now = (statistics.median(values[which].get(name) or [float("nan")]) for which in ("old", "new"))
        ratio = f"{before / now:.2f}" if now > 0 else "-"
        print(f"| {name} | {before:.3f} | {now:.3f} | {ratio} |".replace("nan", "-"))


if __name__ == "__main__":
    main()
