"""``python -m coord.verify PLAN``: exit code 0 for a certified plan, 4 for any other, 2 for no plan at all."""

from __future__ import annotations

import sys
from pathlib import Path

from coord.verify.check import verify

_CODES = {"certified": 0, "malformed": 2}


def main(arguments: list[str]) -> int:
    """Check one plan file, say what was found on standard output, and return the exit code."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -m coord.verify PLAN\n")
        return 2
    try:
        data = Path(arguments[0]).read_bytes()
    except OSError as error:
        sys.stderr.write(f"{arguments[0]}: cannot be read: {error.strerror}\n")
        return 2
    report = verify(data)
    sys.stdout.write(f"{report}\n")
    return _CODES.get(report.verdict, 4)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
