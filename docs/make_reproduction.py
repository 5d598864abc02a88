"""Measure the tables of docs/reproduction.md, between their markers: about two minutes each on two cores.

python docs/make_reproduction.py [compare] [stories]
"""

from __future__ import annotations

import sys
from pathlib import Path

from fetch_pomdp.study.configuration import load_study
from fetch_pomdp.study.crew import Crew
from fetch_pomdp.study.reproduce.compare import compare
from fetch_pomdp.study.reproduce.stories import tell
from fetch_pomdp.study.reproduce.targets import Targets
from fetch_pomdp.study.reproduce.words import markdown, outcome, stories_head

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "reproduction.md"
STUDIES, PEOPLE, SEED = 40, 24, 2017


def tables(names: list[str]) -> dict[str, str]:
    """Return the tables by name."""
    targets, study = Targets.load(ROOT / "studies" / "paper.toml"), load_study(ROOT / "studies" / "fitted.toml")
    crew, found = Crew(workers=1), {}
    if "compare" in names:
        found["compare"] = markdown(compare(targets, study, STUDIES, SEED, crew))
    if "stories" in names:
        found["stories"] = "\n".join([stories_head(targets), *map(outcome, tell(targets, study, PEOPLE, SEED, crew))])
    return found


def main() -> None:
    """Write the tables that were asked for, or all."""
    page = PAGE.read_text(encoding="utf-8")
    for name, text in tables(sys.argv[1:] or ["compare", "stories"]).items():
        print(text, flush=True)
        begin, end = f"<!-- {name} -->\n", f"<!-- end of {name} -->\n"
        before, rest = page.split(begin)
        page = f"{before}{begin}{text}\n{end}{rest.split(end)[1]}"
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
