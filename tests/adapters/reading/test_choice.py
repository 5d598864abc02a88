"""Readers by name."""

from __future__ import annotations

from pathlib import Path

import pytest

from fetch_pomdp.adapters.reading.choice import reader_named
from fetch_pomdp.core.agent import Agent
from fetch_pomdp.core.language.reading.reader import Context, TableReader
from fetch_pomdp.errors import InputError
from tests.core.language.reading.tables import LINE


def test_the_default_reads_places() -> None:
    agent = Agent("ambiguous", reader=reader_named())
    agent.observe("the bowl on my left")
    assert agent.scene.items[int(agent.belief.argmax())].id == "bowl-1"


def test_the_papers_reader_is_that_of_an_agent_without_one() -> None:
    assert reader_named("words") is None


def test_a_language_is_named_after_a_colon() -> None:
    german = reader_named("table:german")
    assert isinstance(german, TableReader)
    assert german.read(("zweite", "von", "links"), LINE, Context()).log_likelihood.argmax() in {1, 2}


@pytest.mark.parametrize("name", ["", "tabel", "table:spanish", "words:", "openai:", "table:"])
def test_another_name_is_answered_with_the_known_ones(name: str) -> None:
    with pytest.raises(InputError, match=r"reader: found .*expected words, table"):
        reader_named(name)


def test_weights_are_those_of_a_file_and_the_papers_reader_has_none(tmp_path: Path) -> None:
    path = tmp_path / "weights.toml"
    path.write_text("[weights]\nlost = 1.5\n")
    learnt = reader_named(weights=path)
    assert isinstance(learnt, TableReader)
    assert learnt.weights.values.lost == pytest.approx(1.5)
    with pytest.raises(InputError, match="no weights"):
        reader_named("words", weights=path)
