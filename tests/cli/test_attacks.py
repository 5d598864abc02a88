"""Bad command lines: each ends with code 2 and at most three lines on standard error, and none with a traceback.

Files are named in braces: `{nan.toml}` is one of `FILES`, made afresh for each test.
"""

# ruff: noqa: E501 (tables)
from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import Run

ITEM = '[[items]]\nid = "cup"\nposition = [0, 2, 0.75]\nvocabulary = ["cup"]\n'
HEAD = "head = [0, 0, 1.6]\n"
SCENE = '{"scene": "ambiguous"}\n'
COLUMNS = "person,layout,paradigm,desired,order,time,correct,picked,questions,waits"
HUGE = "9" * 400

FILES: dict[str, str | bytes] = {
    # scenes, models and studies
    "good.toml": HEAD + ITEM,
    "empty.toml": "",
    "latin.toml": b'head = "caf\xe9"\n',
    "broken.toml": "head = [0, 0\n",
    "binary.toml": bytes(range(256)) * 8,
    "text.toml": f'head = "here"\n{ITEM}',
    "list.toml": "items = 3\nhead = [0, 0, 1.6]\n",
    "nan.toml": f"head = [nan, inf, 1.6]\n{ITEM}",
    "huge.toml": f"head = [{HUGE}, 0, 1.6]\n{ITEM}",
    "digits.toml": f"head = [{'9' * 5000}, 0, 1.6]\n{ITEM}",
    "deep.toml": f"head = {'[' * 5000}{']' * 5000}\n",
    "truth.toml": f"head = [true, false, 1.6]\n{ITEM}",
    "twice.toml": HEAD + ITEM + ITEM,
    "unknown.toml": f"colour = 1\n{HEAD}{ITEM}",
    "control.toml": f'{HEAD}{ITEM}[model]\ngesture_likelihood = "\\u0000"\n',
    "quick.toml": 'people = 1\n[paradigms]\nnever = "paper-never"\nalways = "paper-always"\n',
    "sigma.toml": "[model]\nsigma = -1\n",
    "reward.toml": "[rewards]\nwait = 1\n",
    "model-number.toml": "model = 3\n",
    "people-text.toml": 'people = "many"\n',
    "people-huge.toml": f"people = {HUGE}\n",
    "people-none.toml": "people = 0\n",
    "trials-true.toml": "trials = true\n",
    "seed-negative.toml": "seed = -1\n",
    "layouts-number.toml": "layouts = 3\n",
    "layouts-nowhere.toml": 'layouts = ["nowhere.toml"]\n',
    "layouts-nul.toml": 'layouts = ["a\\u0000b"]\n',
    "layouts-none.toml": "layouts = []\n",
    "paradigms-number.toml": "paradigms = 3\n",
    "paradigms-none.toml": "[paradigms]\n",
    "planner-unknown.toml": '[paradigms]\nbest = "best"\n',
    "planner-depth.toml": '[paradigms]\nfar = {planner = "sparse", depth = 10000}\n',
    "population-nowhere.toml": 'population = "nowhere.toml"\n',
    "clock-nan.toml": "[clock]\nwait = nan\n",
    # recordings
    "good.jsonl": SCENE + '{"observation": {"utterance": "marker"}}\n',
    "empty.jsonl": "",
    "latin.jsonl": b'{"scene": "caf\xe9"}\n',
    "binary.jsonl": bytes(range(256)) * 8,
    "broken.jsonl": '{"scene": \n',
    "array.jsonl": "[1, 2]\n",
    "number.jsonl": '{"scene": 3}\n',
    "nan.jsonl": SCENE + '{"observation": {"head": [NaN, 0, 1], "wrist": [0, 1, 1]}}\n',
    "huge.jsonl": SCENE + f'{{"action": "wait", "t": {HUGE}}}\n',
    "digits.jsonl": SCENE + f'{{"action": "wait", "t": {"9" * 5000}}}\n',
    "deep.jsonl": SCENE + "[" * 100_000 + "\n",
    "half.jsonl": SCENE + '{"observation": {"utterance": 3, "words": [{"text": "\\ud800", "start": 1, "end": 2}]}}\n',
    "twice.jsonl": '{"scene": "ambiguous", "scene": "ambiguous"}\n',
    "item.jsonl": SCENE + '{"action": "pick", "item": "cup"}\n',
    "over.jsonl": SCENE + '{"action": "pick", "item": "bowl-1"}\n{"action": "wait"}\n',
    "frames.jsonl": '{"t": -1, "head": [0, 0, 1], "wrist": [0, 1, 1]}\n',
    # tables of trials
    "good.csv": f"{COLUMNS}\n0,near,sure,a,0,1.0,True,a,0,0\n",
    "empty.csv": "",
    "header.csv": f"{COLUMNS}\n",
    "binary.csv": bytes(range(256)) * 8,
    "columns.csv": "person,layout\n1,near\n",
    "more.csv": f"{COLUMNS}\n0,near,sure,a,0,1.0,True,a,0,0,1,2,3\n",
    "long.csv": f"{COLUMNS}\n0,near,{'x' * 200_000},a,0,1.0,True,a,0,0\n",
    "nul.csv": f"{COLUMNS}\n0,near,\0,a,0,1.0,True,a,0,0\n",
    "nan.csv": f"{COLUMNS}\n0,near,sure,a,0,nan,True,a,0,0\n",
    "negative.csv": f"{COLUMNS}\n-1,near,sure,a,0,1.0,True,a,0,0\n",
    "huge.csv": f"{COLUMNS}\n{HUGE},near,sure,a,0,1.0,True,a,0,0\n",
    "text.parquet": "no parquet",
    "empty.parquet": "",
    "trials.jsonl": '{"person": 1}\n',
    # others
    "words.wav": "no sound",
    "empty.wav": "",
    "riff.wav": b"RIFF\xff\xff\xff\xffWAVEfmt \x10\0\0\0" + bytes(16),
    "text.db": "no database",
}
SCENES = [
    "{missing.toml}", "{folder}", "{empty.toml}", "{latin.toml}", "{broken.toml}", "{binary.toml}", "{text.toml}",
    "{list.toml}", "{nan.toml}", "{huge.toml}", "{digits.toml}", "{deep.toml}", "{truth.toml}", "{twice.toml}",
    "{unknown.toml}", "{control.toml}", "{good.jsonl}", "ambigous", "", "a\0b", "a\0b.toml", "\udcff.toml", "x" * 5000,
    "{good.toml}/below.toml", "/dev/null", "/dev/zero", "\n.toml",
]  # fmt: skip
RECORDINGS = [
    "{missing.jsonl}", "{folder}", "{empty.jsonl}", "{latin.jsonl}", "{binary.jsonl}", "{broken.jsonl}", "{array.jsonl}",
    "{number.jsonl}", "{nan.jsonl}", "{huge.jsonl}", "{digits.jsonl}", "{deep.jsonl}", "{half.jsonl}", "{twice.jsonl}",
    "{item.jsonl}", "{over.jsonl}", "{good.toml}", "a\0b", "\udcff", "x" * 5000, "/dev/null", "/dev/zero",
]  # fmt: skip
STUDIES = [
    "{missing.toml}", "{folder}", "{latin.toml}", "{broken.toml}", "{digits.toml}", "{deep.toml}", "{unknown.toml}",
    "{people-text.toml}", "{people-huge.toml}", "{people-none.toml}", "{trials-true.toml}", "{seed-negative.toml}",
    "{layouts-number.toml}", "{layouts-nowhere.toml}", "{layouts-nul.toml}", "{layouts-none.toml}",
    "{paradigms-number.toml}", "{paradigms-none.toml}", "{planner-unknown.toml}", "{planner-depth.toml}",
    "{population-nowhere.toml}", "{clock-nan.toml}", "a\0b", "/dev/zero",
]  # fmt: skip
TABLES = [
    "{missing}", "{folder}", "{missing.csv}", "{folder.csv}", "{good.toml}", "{empty.csv}", "{header.csv}", "{binary.csv}",
    "{columns.csv}", "{more.csv}", "{long.csv}", "{nul.csv}", "{nan.csv}", "{negative.csv}", "{huge.csv}", "{text.parquet}",
    "{empty.parquet}", "{folder.parquet}", "{trials.jsonl}", "{missing.jsonl}", "a\0b", "a\0b.csv", "/dev/zero", "",
]  # fmt: skip
MODELS = [
    "{missing.toml}",
    "{folder}",
    "{sigma.toml}",
    "{reward.toml}",
    "{model-number.toml}",
    "{good.toml}",
    "a\0b",
    "/dev/zero",
]
SIMULATE, FETCH, STUDY = (
    ["simulate", "ambiguous", "--episodes", "3"],
    ["fetch", "ambiguous"],
    ["study", "--config", "{quick.toml}"],
)
NUMBERS = ["-1", "nan", "1e3", "0x10", "", HUGE, "one"]

LINES: list[list[str]] = [
    ["nonsense"], ["--nonsense"], ["simulate"], ["simulate", "ambiguous", "more"], ["study", "nonsense"], ["log"], ["a\0b"],
    ["\udcff"], ["filter"], ["log", "check"], ["export", "ambiguous"], ["participants", "forget"], ["-x"], ["--version=3"],
    *(["simulate", scene, "--episodes", "3"] for scene in SCENES),
    *(["fetch", scene] for scene in SCENES[::3]),
    *(["export", scene, "{new.pomdp}"] for scene in SCENES[1::3]),
    *(["gap", scene] for scene in SCENES[2::3]),
    *(["serve", scene] for scene in SCENES[::3]),
    *(["filter", path] for path in RECORDINGS),
    *(["decide", path] for path in RECORDINGS[::3]),
    *(["log", "check", path] for path in RECORDINGS[1::3]),
    *(["log", "replay", path] for path in RECORDINGS[2::3]),
    *(["log", "trials", path] for path in RECORDINGS[::3]),
    *(["calibrate", path] for path in RECORDINGS[1::3]),
    ["log", "trials", "{good.jsonl}"], ["calibrate", "{good.jsonl}"],
    *([*SIMULATE, "--model", path] for path in MODELS),
    *(["filter", "{good.jsonl}", "--model", path] for path in MODELS[::2]),
    *([*STUDY, "--model", path, "--out", "{new}"] for path in MODELS[1::2]),
    *(["study", "--config", path, "--out", "{new}"] for path in STUDIES),
    *(["study", "curves", "--config", path, "--out", "{new}"] for path in STUDIES[::6]),
    *(["study", "prices", "--config", path, "--out", "{new}"] for path in STUDIES[1::6]),
    *(["study", "compare", "--config", path] for path in STUDIES[2::6]),
    *(["study", "fit", "--targets", path] for path in STUDIES[3::6]),
    *(["study", "report", path, "--out", "{new}"] for path in TABLES),
    *(["study", "report", "{good.csv}", "--system", "sure", "--out", out] for out in ("{good.toml}", "a\0b", "/proc/none")),
    *([*STUDY, "--out", out] for out in ("{good.toml}", "{good.toml}/below", "a\0b", "/proc/none", "x" * 5000)),
    [*STUDY, "--out", "{new}", "--backend", "spark"], [*STUDY, "--out", "{new}", "--address", "nowhere"],
    *(["study", "--people", number, "--out", "{new}"] for number in ["0", *NUMBERS]),
    *([*STUDY, "--workers", number, "--out", "{new}"] for number in NUMBERS[:3]),
    *(["simulate", "ambiguous", "--planner", "paper-never", "--episodes", number] for number in ["0", *NUMBERS]),
    *([*SIMULATE, "--seed", number] for number in [*NUMBERS, str(2**63)]),
    *([*SIMULATE, "--planner", "sparse", "--depth", number] for number in ["0", *NUMBERS]),
    *([*SIMULATE, "--planner", "sparse", "--width", number] for number in ["0", *NUMBERS]),
    [*SIMULATE, "--planner", "sparce"], [*SIMULATE, "--planner", ""], [*SIMULATE, "--planner", "paper-always", "--depth", "3"],
    *([*FETCH, "--planner", "sparse", "--budget", number] for number in ("-1", "0", "nan", "inf", "one")),
    *([*FETCH, "--rate", number, "--audio", "-"] for number in ("0", "7999", "192001", "one")),
    *([*FETCH, "--audio", path] for path in (
        "{missing.wav}", "{folder}", "{words.wav}", "{empty.wav}", "{riff.wav}", "/dev/zero", "x" * 5000)),
    *([*FETCH, "--skeleton", path] for path in (
        "{missing.jsonl}", "{folder}", "{frames.jsonl}", "{binary.jsonl}", "{good.jsonl}", "a\0b", "/dev/zero")),
    [*FETCH, "--audio", "-", "--skeleton", "-"], [*FETCH, "--target", "cup"], [*FETCH, "--person", "-1"],
    *([*FETCH, "--planner", "paper-never", "--log", path] for path in ("{good.jsonl}", "{folder}", "{missing}/log", "a\0b", "/proc/none", "", "x" * 5000)),
    *(["export", "ambiguous", path] for path in (
        "{new.txt}", "{new}", "{folder}", "{missing}/new.pomdp", "a\0b.pomdp", "/proc/none.pomdp", "")),
    *(["export", "ambiguous", "{new.pomdp}", "--discount", number] for number in ("0", "-1", "2", "nan", "inf", "one")),
    *(["export", "ambiguous", "{new.pomdp}", "--rings", number] for number in ["0", *NUMBERS]),
    *(["gap", "ambiguous", "--planner", "paper-never", "--scenarios", number] for number in ["1", *NUMBERS]),
    ["gap", "ambiguous", "--planner", "best"], ["gap", "ambiguous", "--episodes", "1"],
    *(["robocup", "--games", number] for number in ["1", *NUMBERS]),
    *(["robocup", "--unknown", number] for number in ("-1", "2", "nan", "inf", "one")),
    *(["robocup", "--bias", number] for number in ("-1", "1e9", "nan", "inf", "one")),
    ["robocup", "--planner", "best"],
    *(["serve", "--port", number] for number in ("0", "70000", "-1", "one", HUGE)),
    *(["serve", "--host", host, "--token", "long enough for a token"] for host in ("nowhere.invalid", "x" * 300)),
    ["serve", "--token", "short"], ["serve", "--host", "0.0.0.0"],
    *(["serve", "--data", path] for path in ("{good.toml}", "{good.toml}/below", "/proc/none", "a\0b")),
    *(["serve", "--study", path] for path in ("{missing.toml}", "{folder}", "{broken.toml}", "a\0b", "/dev/zero")),
    *(["participants", "list", "--database", url] for url in (
        "", "nonsense", "sqlite://", "sqlite:///{missing.db}", "sqlite:///{folder}", "sqlite:///{text.db}", "mysql://x/y")),
    *(["calibrate", "{good.jsonl}", "--episodes", number] for number in NUMBERS),
]  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("attacks")
    for name, content in FILES.items():
        (place / name).write_bytes(content.encode() if isinstance(content, str) else content)
    for name in ("folder", "folder.csv", "folder.parquet"):
        (place / name).mkdir()
    return place


def named(words: list[str], folder: Path) -> list[str]:
    return [word.replace("{", f"{folder}/").replace("}", "") for word in words]


@pytest.mark.parametrize("words", LINES, ids=lambda words: " ".join(words).encode("ascii", "replace").decode()[:90])
def test_a_bad_command_line_is_code_2_and_a_line_or_two(
    run: Run, folder: Path, words: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    before = sorted(path.name for path in folder.iterdir())
    monkeypatch.setattr(sys, "stdin", open(os.devnull, encoding="utf-8"))  # noqa: PTH123, SIM115
    code, out, err = run(*named(words, folder))
    assert code == 2, (out, err)
    if words != ["log"] and words[:2] != ["log", "check"]:  # which tell all commands, and all that is wrong
        assert 1 <= len(err.splitlines()) <= 3, err
    assert "Traceback" not in out + err
    assert sorted(path.name for path in folder.iterdir()) == before
