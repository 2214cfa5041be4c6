"""Checks that the project's code is laid out as ARCHITECTURE.md and CONTRIBUTING.md say.

    python3 scripts/house              the checks of continuous integration
    python3 scripts/house --parents    also circles between a child and the own code of its parent's file

Exit status: 0 nothing found, 1 problems, each named.
"""

import argparse
import sys
from pathlib import Path

import circles
import pages
import sizes


def main():
    """Prints every problem to standard error."""
    parser = argparse.ArgumentParser(prog="scripts/house", description=__doc__.splitlines()[0])
    parser.add_argument("--parents", action="store_true", help="count a parent's own code as one of its children")
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parents[2])
    arguments = parser.parse_args()
    root = arguments.root.resolve()
    found = [
        *circles.problems(root, arguments.parents),
        *sizes.problems(root),
        *pages.problems(root),
    ]
    for problem in found:
        print(problem, file=sys.stderr)
    print(f"{len(found)} problems" if found else "no circles, nothing too long, no reference that leads nowhere")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
