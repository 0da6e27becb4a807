"""Keep ``best_known.toml``: plan every problem and write down what is better than anything known so far.

``python problems/record_best.py`` takes all problems but the impossible ones; files given as arguments are the only
ones taken. An entry is replaced when the sum of arrivals is smaller, or when the
problem itself has changed; a bound belongs to the paths of its sum, so it is raised only where the sum stays.
"""

from __future__ import annotations

import sys
import tomllib
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from coord import Options, Problem, read_problem
from coord.plan import plan

HERE: Final = Path(__file__).resolve().parent
LEDGER: Final = HERE / "best_known.toml"

#: [s] Sums that differ by less are the same.
SAME: Final = 1e-6

HEAD: Final = """\
# The best plans known for the problems of this folder, written by record_best.py.
#
# sum_of_arrivals [s]: the smallest sum found so far. lower_bound [s]: certified; no plan on the same paths has a
# smaller sum. gap: what lies between them, as a share of the sum. digest: the beginning of the problem's digest.
"""


def main() -> int:
    """Plan, compare, write; 1 when a problem that should have a plan has none."""
    known = tomllib.loads(LEDGER.read_text(encoding="utf-8")) if LEDGER.exists() else {}
    names = [Path(file).resolve().relative_to(HERE).as_posix() for file in sys.argv[1:]] or sorted(possible())
    failed = False
    for name in names:
        problem = read_problem(HERE / name)
        found = attempt(problem)
        if found is None:
            failed = True
        elif (kept := better(known.get(name), found)) is not None:
            known[name] = kept
        sys.stdout.write(f"{name}: {_told(found, known.get(name))}\n")
    exists = {name: known[name] for name in sorted(known) if (HERE / name).exists()}
    LEDGER.write_text(HEAD + "".join(map(_entry, exists, exists.values())), encoding="utf-8", newline="\n")
    return 1 if failed else 0


def possible() -> list[str]:
    """All problem files that have a plan, relative to this folder."""
    files = (path.relative_to(HERE) for path in HERE.rglob("*.toml") if path != LEDGER)
    return [file.as_posix() for file in files if file.parts[0] != "impossible"]


def attempt(problem: Problem) -> dict[str, Any] | None:
    """What coord finds with its defaults and the problem's own options; None without a certified plan."""
    options = Options(**{"profile": "fastest", **problem.options})  # type: ignore[arg-type]
    result = plan(problem, options)
    if result.plan is None or not result.certified:
        return None
    return {
        "sum_of_arrivals": result.plan.sum_of_arrivals,
        "lower_bound": result.plan.lower_bound,
        "how": f"coord {version('coord')}: order {options.order}, shape {options.shape}, profile {options.profile}",
        "bound_by": result.plan.lower_bound_by,
        "digest": problem.digest[:12],
    }


def better(old: dict[str, Any] | None, new: dict[str, Any]) -> dict[str, Any] | None:
    """The entry to keep instead of the old one; None where the old one stays."""
    if old is None or old["digest"] != new["digest"] or new["sum_of_arrivals"] < old["sum_of_arrivals"] - SAME:
        return new
    same = abs(new["sum_of_arrivals"] - old["sum_of_arrivals"]) <= SAME
    if same and new["lower_bound"] > old["lower_bound"] + SAME:
        return old | {"lower_bound": new["lower_bound"], "bound_by": new["bound_by"]}
    return None


def _told(found: dict[str, Any] | None, kept: dict[str, Any] | None) -> str:
    now = "no certified plan" if found is None else f"{found['sum_of_arrivals']:.2f} s"
    return now if kept is None else f"{now}, best known {kept['sum_of_arrivals']:.2f} s"


def _entry(name: str, values: dict[str, Any]) -> str:
    total, bound = values["sum_of_arrivals"], values["lower_bound"]
    return (
        f'\n["{name}"]\nsum_of_arrivals = {total:.6f}\nlower_bound = {bound:.6f}\ngap = {(total - bound) / total:.4f}\n'
        f'how = "{values["how"]}"\nbound_by = "{values["bound_by"]}"\ndigest = "{values["digest"]}"\n'
    )


if __name__ == "__main__":
    sys.exit(main())
