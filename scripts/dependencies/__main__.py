"""Checks licences, names and sources of all dependencies against deny.toml.

    python3 scripts/dependencies       the check of continuous integration

Wants license-expression (testdata/requirements.txt). Asks what `cargo deny check bans licenses sources` asks, of the
same file. That program takes two minutes to compile, of the half hour that all checks have; by hand it also looks for
advisories.

Exit status: 0 nothing found, 1 problems, each named.
"""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

import allowed


def main():
    """Prints every problem to standard error."""
    root = Path(__file__).resolve().parents[2]
    command = ["cargo", "metadata", "--format-version", "1", "--locked", "--all-features"]
    metadata = json.loads(subprocess.run(command, cwd=root, check=True, stdout=subprocess.PIPE).stdout)
    rules = tomllib.loads((root / "deny.toml").read_text(encoding="utf-8"))
    found = list(allowed.problems(metadata["packages"], rules))
    for problem in found:
        print(problem, file=sys.stderr)
    print(f"{len(found)} problems" if found else f"{len(metadata['packages'])} packages, all as deny.toml wants them")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
