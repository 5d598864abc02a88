"""The report: a page that parses, needs nothing beside itself, and holds the numbers."""

from __future__ import annotations

import base64
import re
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pandas
import pytest

from fetch_pomdp import extras
from fetch_pomdp.errors import MissingExtraError, StudyError
from fetch_pomdp.study import plots
from fetch_pomdp.study.analysis.cells import cells
from fetch_pomdp.study.analysis.plan import Plan
from fetch_pomdp.study.analysis.trials import checked
from fetch_pomdp.study.report import write_report
from tests.files.disk import room_for
from tests.study.made import drawn, table

QUICK = Plan(draws=50, most_people=16)
VOID = {"meta", "img", "br", "link"}


class Page(HTMLParser):
    """Collects the tags of a page, and checks that they are closed in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.opened: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.feed(text)
        self.close()
        assert not self.opened

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.opened.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.opened.pop() == tag

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("report") / "study"
    write_report(drawn(4, 1), out, QUICK)
    return out


def test_the_page_parses_and_needs_nothing_beside_itself(folder: Path) -> None:
    text = (folder / "report.html").read_text(encoding="utf-8")
    page = Page(text)
    assert not page.all("script")
    assert not page.all("link")
    assert all((image["src"] or "").startswith("data:image/svg+xml;base64,") for image in page.all("img"))
    assert "http" not in re.sub(r'src="data:[^"]*"', "", text)
    assert not re.search(r"\bnan\b|\bNone\b|\binf\b", re.sub(r'src="data:[^"]*"', "", text))


def test_pictures_have_words_and_tables_have_headers(folder: Path) -> None:
    page = Page((folder / "report.html").read_text(encoding="utf-8"))
    assert len(page.all("img")) == 4
    assert all(len(image["alt"] or "") > 20 for image in page.all("img"))
    assert len(page.all("caption")) == len(page.all("table")) == 4
    assert {heading.get("scope") for heading in page.all("th")} == {"col", "row"}
    assert page.all("html")[0]["lang"] == "en"


def test_pictures_are_well_formed(folder: Path) -> None:
    page = Page((folder / "report.html").read_text(encoding="utf-8"))
    for image in page.all("img"):
        root = ElementTree.fromstring(base64.b64decode((image["src"] or "").partition(",")[2]))
        assert root.tag.endswith("svg")


def test_the_page_holds_the_numbers_of_the_table(folder: Path) -> None:
    text = (folder / "report.html").read_text(encoding="utf-8")
    trials = drawn(4, 1)
    for _, cell in trials.groupby(["layout", "paradigm"]):
        assert f"<td>{cell['time'].mean():.2f}</td>" in text
        assert f"<td>{100 * cell['correct'].mean():.1f}</td>" in text
    assert "432 trials of 8 persons (4 in ambiguous, 4 in unambiguous)" in text
    assert re.search(r"H1 (holds|is)", text)
    assert re.search(r"H2 (holds|is)", text)


def test_tables_are_the_same_as_csv_and_parquet(folder: Path) -> None:
    names = {"cells", "comparisons", "clauses", "people", "power"}
    assert {path.stem for path in folder.glob("*.csv")} == {path.stem for path in folder.glob("*.parquet")} == names
    for name in names - {"comparisons"}:
        csv, parquet = pandas.read_csv(folder / f"{name}.csv"), pandas.read_parquet(folder / f"{name}.parquet")
        pandas.testing.assert_frame_equal(csv, parquet, check_dtype=False)
    people = pandas.read_csv(folder / "people.csv")
    trials = drawn(4, 1)
    mean = trials[(trials["person"] == 2) & (trials["paradigm"] == "fetch")]["time"].mean()
    row = people[(people["person"] == 2) & (people["paradigm"] == "fetch")]
    assert row["time"].item() == pytest.approx(mean)


def test_the_same_table_gives_the_same_page(folder: Path, tmp_path: Path) -> None:
    again = write_report(drawn(4, 1).sample(frac=1.0, random_state=0), tmp_path, QUICK)
    assert again.read_bytes() == (folder / "report.html").read_bytes()


def one_paradigm() -> Any:
    trials = drawn(3, 2)
    return trials[trials["paradigm"] == "never"]


@pytest.mark.parametrize(
    "trials",
    [
        table([(0, "fetch", 1.0, True)]),
        table([(p, name, 5.0, True) for p in range(3) for name in ("never", "always", "fetch")]),
        one_paradigm(),
        drawn(3, 3).assign(correct=True),
        drawn(3, 3).assign(correct=False, picked=None),
    ],
    ids=["one trial", "all the same", "one paradigm", "all right", "never picked"],
)
def test_tables_that_say_little_still_make_a_page(trials: Any, tmp_path: Path) -> None:
    text = write_report(trials, tmp_path, QUICK).read_text(encoding="utf-8")
    Page(text)
    plain = re.sub(r'src="data:[^"]*"', "", text)
    assert not re.search(r"\bnan\b|\bNone\b|\binf\b|<b>", plain)
    assert "cannot be judged" in plain


def test_names_are_escaped(tmp_path: Path) -> None:
    trials = drawn(2, 4).replace({"layout": {"ambiguous": "<b>lab & home</b>"}})
    assert "&lt;b&gt;lab &amp; home&lt;/b&gt;" in write_report(trials, tmp_path, QUICK).read_text(encoding="utf-8")


def test_a_folder_that_cannot_be_is_one_clear_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(StudyError, match=r"file/deep: cannot be written: .*, expected a directory"):
        write_report(drawn(2, 0), tmp_path / "file" / "deep", QUICK)
    with pytest.raises(StudyError, match=r"cannot be written: .*null byte, expected a directory"):
        write_report(drawn(2, 0), "a\0b", QUICK)


def test_a_report_without_room_leaves_the_one_before(folder: Path) -> None:
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    with room_for(1000), pytest.raises(StudyError, match=r"cannot be written: .*, expected room for it"):
        write_report(drawn(4, 1), folder, QUICK)
    assert {path.name: path.read_bytes() for path in folder.iterdir()} == before


def test_a_missing_library_is_named_with_the_line_that_installs_it() -> None:
    with pytest.raises(MissingExtraError, match=r'pip install "fetch-pomdp\[study\]"'):
        extras.load("no_such_library", "study")


def test_the_ellipse_is_one_standard_deviation_of_the_gaussian() -> None:
    points = np.random.default_rng(0).multivariate_normal([3, 90], [[1, 2], [2, 9]], 50)
    away = plots.ellipse(points) - points.mean(axis=0)
    distance = np.einsum("ni,ij,nj->n", away, np.linalg.inv(np.cov(points.T)), away)
    np.testing.assert_allclose(distance, 1.0)


def test_bars_stand_at_the_means_with_their_intervals() -> None:
    found = cells(checked(drawn(4, 1)), Plan())
    figure = plots.bars(found)
    heights = sorted(bar.get_height() for bar in figure.axes[0].patches)
    assert heights == pytest.approx(sorted(cell.time for cell in found))
    assert figure.axes[0].get_ylabel() == "interaction time (s)"
    whiskers = [path for lines in figure.axes[0].collections for path in lines.get_paths()]
    ends = sorted(float(end) for path in whiskers for end in path.vertices[:, 1])
    expected = sorted(end for cell in found for end in (cell.time_low or 0.0, cell.time_high or 0.0))
    assert ends == pytest.approx(expected)


def test_a_curve_falls_where_trials_end_and_not_where_they_are_broken_off() -> None:
    trials = table([(0, "fetch", time, True) for time in (1.0, 2.0, 3.0, 4.0)])
    trials.loc[1, "picked"] = None  # at 2 s, unpicked: 1, then 3/4, then 3/4 * 1/2, then 0
    whole = checked(trials)
    (line,) = plots.survival(whole, cells(whole, Plan())).axes[0].lines
    assert list(line.get_xdata()) == [0, 1, 3, 4]
    assert list(line.get_ydata()) == pytest.approx([100, 75, 37.5, 0])


def test_questions_are_shares_of_trials() -> None:
    trials = table([(0, "fetch", 1.0, True)] * 5)
    trials["questions"] = [0, 1, 1, 4, 7]
    whole = checked(trials)
    axis = plots.questions(whole, cells(whole, Plan())).axes[0]
    assert [bar.get_height() for bar in axis.patches] == pytest.approx([20, 40, 0, 0, 40])


def test_the_report_shows_what_order_does(tmp_path: Path) -> None:
    """Six trials of each of two persons: the first third takes 9 s, the second 6, the last 3; one is wrong at first."""
    rows = []
    for person in range(2):
        times = [9.0, 9.0, 6.0, 6.0, 3.0, 3.0]
        names = ["never", "always", "fetch"] * 2
        rows += [(person, name, time, time < 9.0) for name, time in zip(names, times, strict=True)]
    trials = table(rows)
    trials["order"] = list(range(6)) * 2
    text = write_report(trials, tmp_path, QUICK).read_text()
    part = text[text.index("Order of the trials") :]
    found = re.findall(r"<td>(.*?)</td>", part[: part.index("</table>")])
    assert [found[start : start + 2] for start in (0, 3, 6)] == [["9.00", "0.0"], ["6.00", "100.0"], ["3.00", "100.0"]]
