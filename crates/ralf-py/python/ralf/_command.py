"""The command `ralf`, as the wheel carries it."""

import signal
import sys

from ralf import _ralf


def main() -> int:
    """Run what was typed. Ctrl-C ends it at once, as it ends every program."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _ralf.command(["ralf", *sys.argv[1:]])
