"""How the program ends, whatever happens to it: a full disk, a reader who leaves, Ctrl-C, streams that are closed."""

from __future__ import annotations

import io
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from numba.core import event

from fetch_pomdp import __version__
from fetch_pomdp.cli import compiling, offline
from fetch_pomdp.cli.main import main
from tests.cli.conftest import ASKED, Run

ROOT = Path(__file__).parents[2]
SKELETON = ROOT / "examples" / "marker.jsonl"


@pytest.fixture
def log(tmp_path: Path) -> Path:
    path = tmp_path / "log.jsonl"
    path.write_text("".join(json.dumps(line) + "\n" for line in ASKED))
    return path


def printing(log: Path) -> dict[str, list[object]]:
    """Commands that print, each in its own way."""
    return {
        "help": ["--help"],
        "version": ["--version"],
        "filter": ["filter", log],
        "decide": ["decide", log, "--planner", "paper-never"],
        "simulate": ["simulate", "ambiguous", "--planner", "paper-never", "--episodes", 20],
        "fetch": ["fetch", "ambiguous", "--skeleton", SKELETON, "--planner", "paper-never"],
        "replay": ["log", "replay", log],
        "schema": ["log", "schema"],
        "robocup": ["robocup", "--planner", "paper-never", "--games", 2],
        "template": ["participants", "template"],
    }


def ended(monkeypatch: pytest.MonkeyPatch, *arguments: object) -> int:
    monkeypatch.setattr(sys, "argv", ["fetch-pomdp", *map(str, arguments)])
    with pytest.raises(SystemExit) as exited:
        main()
    return int(exited.value.code or 0)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="Linux has a device that is always full")
@pytest.mark.parametrize("buffered", [True, False])
@pytest.mark.parametrize("name", printing(Path()))
def test_a_full_disk_is_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], log: Path, name: str, *, buffered: bool
) -> None:
    with open("/dev/full", "wb", buffering=-1 if buffered else 0) as full:  # noqa: PTH123
        monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(full, write_through=not buffered))
        assert ended(monkeypatch, *printing(log)[name]) == 2
        monkeypatch.undo()
    assert capsys.readouterr().err == (
        "fetch-pomdp: standard output: No space left on device, expected a place for what is printed\n"
    )


@pytest.mark.parametrize("name", printing(Path()))
def test_a_reader_who_has_left_ends_it_silently(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], log: Path, name: str
) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "w") as pipe:
        monkeypatch.setattr(sys, "stdout", pipe)
        assert ended(monkeypatch, *printing(log)[name]) == 141
        monkeypatch.undo()
    assert capsys.readouterr().err == ""


def test_a_reader_who_leaves_ends_a_real_process_silently() -> None:
    code = f"import sys; sys.argv = ['', 'log', 'schema']; from {main.__module__} import main; main()"
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stderr is not None
    process.stdout.close()
    assert process.stderr.read() == b""
    assert process.wait() == 141


# Sends Ctrl-C when a module is first looked for, or when Numba begins to compile.
WHILE_IMPORTING = """
import os, signal, sys
class Finder:
    def find_spec(self, name, path=None, target=None):
        if name == {name!r}:
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Finder())
"""
WHILE_COMPILING = """
import os, signal
from numba.core import event
from fetch_pomdp.cli import compiling
compiling.TOLD_AFTER = 600.0
class Listener(event.Listener):
    def on_start(self, event): pass
    def on_end(self, event): os.kill(os.getpid(), signal.SIGINT)
event.register("numba:llvm_lock", Listener())
"""


@pytest.mark.parametrize(
    "begin",
    [
        *(WHILE_IMPORTING.format(name=name) for name in ("numpy", "numba", "typer", "fetch_pomdp.cli.study")),
        WHILE_COMPILING,
    ],
)
def test_ctrl_c_in_the_first_seconds_ends_it_silently(tmp_path: Path, begin: str) -> None:
    run = "sys.argv = ['fetch-pomdp', 'simulate', 'ambiguous', '--episodes', '10', '--planner', 'paper-never']; main()"
    code = f"{begin}\nimport sys\nfrom fetch_pomdp.cli.main import main\n{run}"
    new_cache = {**os.environ, "NUMBA_CACHE_DIR": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, env=new_cache)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")


def test_ctrl_c_later_ends_it_silently_too(run: Run, log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(offline, "prepare", interrupted)
    before = signal.signal(signal.SIGINT, signal.default_int_handler)  # a library of another test may have left its own
    try:
        assert run("decide", log) == (130, "", "")
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)


def test_an_error_of_the_system_names_the_file(run: Run, log: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def failing(*_: object) -> None:
        raise PermissionError(13, "Permission denied", "/some/where")

    monkeypatch.setattr(offline, "prepare", failing)
    told = "fetch-pomdp: /some/where: Permission denied, expected a file or folder that can be used\n"
    assert run("decide", log) == (2, "", told)


@pytest.mark.parametrize("name", ["stdin", "stdout", "stderr"])
def test_a_closed_stream_is_no_fault(run: Run, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    monkeypatch.setattr(sys, name, None)
    code, out, _ = run("fetch", "ambiguous", "--planner", "paper-never")
    assert code == 0
    assert ("Nothing was handed over." in out) is (name != "stdout")


def test_what_is_typed_or_printed_need_not_be_utf_8(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(b"the \xff marker\n"), encoding="utf-8"))
    assert run("fetch", "ambiguous", "--planner", "paper-never")[0] == 0
    written = io.BytesIO()
    monkeypatch.setattr(sys, "stdin", io.StringIO("marker\n"))
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(written, encoding="ascii", write_through=True))
    assert run("fetch", "ambiguous", "--planner", "paper-never")[0] == 0
    assert rb"\u2588" in written.getvalue()


def told(error: str, path: str) -> str:
    return f"fetch-pomdp: {error}\nfetch-pomdp: try {path} --help\n"


def test_a_wrong_command_line_is_told_with_the_way_to_help(run: Run) -> None:
    assert run("studdy") == (2, "", told("No such command 'studdy'. Did you mean 'study'?", "fetch-pomdp"))
    assert run("simulate") == (2, "", told("Missing argument 'SCENE'", "fetch-pomdp simulate"))
    code, out, err = run("log", "replay", "--fast")
    assert (code, out) == (2, "")
    assert err.endswith("\nfetch-pomdp: try fetch-pomdp log replay --help\n")


@pytest.mark.parametrize("option", ["--ears=sphinx", "--played=robot.wav"])
def test_ears_without_a_sound_are_refused(run: Run, option: str) -> None:
    name = option.partition("=")[0]
    expected = f"fetch-pomdp: {name}: found it without --audio, expected something to hear\n"
    assert run("fetch", "ambiguous", option) == (2, "", expected)


@pytest.mark.parametrize("where", [[], ["fetch"], ["study"], ["study", "fit"], ["log"], ["participants", "list"]])
def test_help_has_a_short_name_everywhere(run: Run, where: list[str]) -> None:
    code, out, err = run(*where, "-h")
    assert (code, err) == (0, "")
    assert "-h, --help" in out
    assert out == run(*where, "--help")[1]


def test_lists_of_commands_break_off_no_sentence(run: Run) -> None:
    for where in ([], ["study"], ["log"], ["participants"]):
        listed = run(*where, "--help")[1].partition("Commands:")[2]
        assert listed.count("\n") > 3
        assert "..." not in listed
        entries = re.split(r"\n  (?=\S)", listed.strip("\n"))
        assert all(entry.rstrip().endswith(".") for entry in entries if entry.strip())


def test_the_version_is_told(run: Run) -> None:
    assert run("--version") == (0, f"fetch-pomdp {__version__}\n", "")
    done = subprocess.run(
        [sys.executable, "-m", "fetch_pomdp", "--version"], capture_output=True, text=True, check=True
    )
    assert done.stdout == f"fetch-pomdp {__version__}\n"


def test_compiling_is_told_of_only_when_it_takes_long(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:

    def compile_for(seconds: float) -> str:

        with compiling.watched(), event.trigger_event("numba:compile"), event.trigger_event("numba:compile"):
            time.sleep(seconds)
        return capfd.readouterr().err

    monkeypatch.setattr(compiling, "TOLD_AFTER", 0.1)
    assert compile_for(0.0) == ""
    assert compile_for(0.5) == compiling.MESSAGE + "\n"
