#!/usr/bin/env python3
"""What real recordings measure, as a table: the ranges that simulated worlds are drawn from.

    measure_ranges.py RALF RECORDING...

RALF is the program, each RECORDING a folder or file that it reads. For every quantity of `ralf inspect
--distributions` the table has the values below which 5, 50 and 95 % lie, of each recording (docs/realism.md tells what
the quantities are).
"""

import json
import subprocess
import sys
from pathlib import Path

QUANTILES = (0, 2, 4)  # 5, 50, 95 %


def measured(program, recording):
    command = [program, "inspect", recording, "--distributions", "--json"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{recording}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def number(value):
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.2g}" if abs(value) < 1 else f"{value:.1f}"


def cell(quantity):
    summary = quantity["summary"]
    if summary is None:
        return "-"
    if summary["values"] == 1:
        return number(summary["mean"])
    return " / ".join(number(summary["quantiles"][place]) for place in QUANTILES)


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    program, recordings = sys.argv[1], sys.argv[2:]
    found = [measured(program, recording) for recording in recordings]
    print("| quantity | " + " | ".join(Path(recording).name for recording in recordings) + " |")
    print("| --- |" + " --- |" * len(recordings))
    scans = " | ".join(f"{one['radar_scans']} / {one['lidar_scans']}" for one in found)
    print(f"| radar / LiDAR scans looked at | {scans} |")
    for row in zip(*(one["quantities"] for one in found)):
        unit = f", {row[0]['unit']}" if row[0]["unit"] else ""
        print(f"| {row[0]['name']}{unit} | " + " | ".join(cell(quantity) for quantity in row) + " |")


if __name__ == "__main__":
    main()
