"""What people mean by their answers, worked out by hand."""

from __future__ import annotations

import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fetch_pomdp.core.language.answers import PAPER, After, Lexicon, Reading, lexicon
from fetch_pomdp.core.language.phrases import Answers, spellings
from fetch_pomdp.core.language.words import NEGATIVE, POSITIVE, STOPS, Meaning, tokenize
from fetch_pomdp.errors import SceneError

OURS = lexicon(Answers(), ("bowl", "marker", "red", "green", "left"))
OWNS_RIGHT = lexicon(Answers(), ("bowl", "left", "right", "top"))

# After "this one?", by what is meant; "|" between utterances. "-": no answer at all.
AFTER_A_QUESTION = {
    "yes": """
        yes | Yes! | yeah | yep | yup | sure | Sure, please. | yes please | uh-huh | uh huh | mm-hmm | mhm | Mmhmm
        | yesss | correct | that's correct | right | that's right | okay | OK | okey-dokey | alright | all right
        | fine | good | perfect | great | exactly | exactly, that one | precisely | that's it | that is it
        | that's the one | that is the one | this one | that one | yes, that one | that one, please | um, yes
        | uh yes | well yes | oh yeah | er, that's it | absolutely | definitely | of course | indeed | you got it
        | you bet | go ahead | take it | give it to me | i'll take it | i think so | i guess so | that'll do
        | that will do | bingo | why not | sure thing | for sure | affirmative | true | the one i meant
        | that's what i want | yes, the red marker | correct, the red marker | exactly the marker
        | that's, um, the one | not the other one | yes, not the other one | yes yes | that's the right one
        | looks right | it is | it's that one | i want that one | aye | so that one then | not bad | Well, right.
        | ja | Ja! | jawohl | jep | ja bitte | ja genau | genau | stimmt | richtig | das ist richtig | passt
        | passt so | den da | die da | das da | ja, das da | genau den | das ist er | das ist es | natürlich
        | auf jeden Fall | na klar | ähm, ja | also ja | den meine ich | das will ich | korrekt | okay, genau | gut
        | NATÜRLICH | natuerlich | nicht den anderen
    """,
    "no": """
        no | No. | nope | nah | nooo | uh-uh | nuh uh | no thanks | no, thank you | no way | wrong | wrong one
        | the wrong one | that's wrong | incorrect | not that | not that one | no, not that one | not this one
        | not it | not quite | not really | not exactly | not at all | not right | not correct | that's not it
        | that is not it | that isn't it | that's not the one | it's not | it isn't | that isn't correct
        | that isn't quite right | not the right one | i don't think so | of course not | neither | neither one
        | none of them | the other one | no, the other one | no, the red marker | another one | try again | well no
        | um, no | oh no | no, that one | no, this one | no right | no no | i don't want that one
        | that's the wrong one | something else | other | not | not the red one | it's not the bowl
        | the other marker | no okay | not, um, that one | absolutely not | nein | Nein! | nee | nö | noe
        | nein danke | nicht das | nicht der | nicht die | nicht den | nicht das da | den nicht | das ist es nicht
        | stimmt nicht | das stimmt nicht | nicht richtig | das ist nicht richtig | passt nicht | falsch
        | das ist falsch | der falsche | keins von beiden | keiner | den anderen | nein, die andere | nein, den da
        | auf keinen Fall | ich glaube nicht | nicht ganz | also nein | ähm nein | doch nicht
    """,
    "unsure": """
        i don't know | I do not know. | dunno | not sure | I'm not sure | i am not sure | um, not sure
        | not quite sure | no idea | i have no idea | can't tell | i don't mind | doesn't matter | either one
        | maybe | perhaps | maybe that one | i don't know which one | both | keine Ahnung | ich weiß nicht
        | weiss nicht | WEISS ICH NICHT | nicht sicher | ich bin mir nicht sicher | egal | ist mir egal | vielleicht
    """,
    "repeat": """
        what | What? | sorry? | pardon | pardon me | huh? | come again | say that again | i didn't hear you
        | sorry, i didn't catch that | which one? | what do you mean | wie bitte | was? | hä? | noch mal bitte
        | nicht verstanden
    """,
    "cancel": """
        never mind | nevermind | forget it | Oh, forget it. | cancel | i changed my mind | that's all | nothing
        | schon gut | vergiss es | hat sich erledigt | lass gut sein | abbrechen
    """,
    "object": """
        stop | stop it | halt | wait | wait a minute | hold on | put it back | stopp | moment mal | leg es zurück
    """,
    "-": """
        the right one | the correct one | the right marker | hand me the right one | on the right | is that right
        | hand me that one | that one next to the marker | okay hand me the marker | what about the marker
        | the green marker | that's the one on the left | no problem | no worries | are you sure | left
        | the left one | | um | please | which marker | right next to the bowl | i want that marker
        | good morning robot it's me | correct marker | gib mir den Becher da | was ist das denn | kein Problem
    """,
}
# Mixtures: of answers that contradict each other the last ones count.
MIXTURES = {
    "yes": """
        no, that's right | no yes | no wait, yes | no no yes | not that one... oh yes, that's it | i don't know, yes
        | nein doch ja
    """,
    "no": """
        yes no | yeah no | yes, no, not that one | maybe no | sorry, no | no wait | stop no | ja nein
        | vielleicht nicht den
    """,
    "unsure": "no, i don't know | yes, hm, i'm not sure | nein, ich weiß nicht",
    "cancel": "no, never mind | yes, oh forget it | nein, schon gut",
}
# Where no question is open.
OUT_OF_THE_BLUE = {
    "yes": "yes | yeah | sure | yup | yep | uh-huh | ja | genau",
    "no": "no | nope | other | not | nein | not that one | the other marker | that's not right",
    "unsure": "i don't know | not sure | keine Ahnung",
    "repeat": "pardon | wie bitte | i didn't hear you",
    "cancel": "never mind | vergiss es",
    "object": "stop | wait | put it back | don't",
    "-": """
        right | okay | correct | left | what | that one | that's the one | exactly | wrong | go ahead | maybe
        | sorry | okay, hand me the marker | the right marker | richtig | das da | falsch | was
    """,
}
# After a pick that was stopped.
STOPPED = {
    "no": """
        stop | stop! | halt | wait | wrong | wrong one | wrong marker | put it back | not that | not that one | no
        | the wrong one | don't | whoa | no, stop | Halt! | stopp | falsch | leg es zurück | nicht das
    """,
    "yes": "no, that's right | stop... no yes",
    "-": "the marker | thank you",
}


def rows(table: dict[str, str]) -> list[tuple[str, str]]:
    return [(" ".join(said.split()), meaning) for meaning, lines in table.items() for said in lines.split("|")]


def meant(said: str, after: After, among: Lexicon = OURS) -> str:
    reading = among.read(tokenize(said), after)
    assert_evidence_is_what_is_meant(reading)
    return "-" if reading.meaning is None else reading.meaning.value


def assert_evidence_is_what_is_meant(reading: Reading) -> None:
    """What the paper's reader finds are answers of one class: that which is meant, or none."""
    found = {word in POSITIVE for word in reading.words if word in POSITIVE + NEGATIVE}
    expected = {Meaning.YES: {True}, Meaning.NO: {False}}
    assert found == (set() if reading.meaning is None else expected.get(reading.meaning, set()))


def test_the_table_is_long() -> None:
    assert len({*rows(AFTER_A_QUESTION), *rows(MIXTURES), *rows(OUT_OF_THE_BLUE), *rows(STOPPED)}) > 300


@pytest.mark.parametrize(("said", "meaning"), rows(AFTER_A_QUESTION) + rows(MIXTURES))
def test_after_a_question(said: str, meaning: str) -> None:
    assert meant(said, After.QUESTION) == meaning


@pytest.mark.parametrize(("said", "meaning"), rows(OUT_OF_THE_BLUE))
def test_where_no_question_is_open(said: str, meaning: str) -> None:
    assert meant(said, After.NOTHING) == meaning


@pytest.mark.parametrize(("said", "meaning"), rows(STOPPED))
def test_after_a_pick_that_was_stopped(said: str, meaning: str) -> None:
    assert meant(said, After.HANDED) == meaning


@pytest.mark.parametrize(
    ("said", "meaning"),
    [
        ("right", "yes"),
        ("that's right", "yes"),
        ("okay right", "yes"),
        ("right please", "yes"),
        ("the right one", "-"),
        ("right bowl", "-"),
        ("the right", "-"),
        ("no right", "no"),
        ("no, the right one", "no"),
        ("left", "-"),
    ],
)
def test_a_word_that_items_own_is_an_answer_where_nothing_else_is_said(said: str, meaning: str) -> None:
    assert meant(said, After.QUESTION, OWNS_RIGHT) == meaning


@pytest.mark.parametrize("word", POSITIVE + NEGATIVE)
@pytest.mark.parametrize("after", [After.NOTHING, After.QUESTION, After.HANDED])
def test_a_word_of_the_paper_s_lists_stays_as_it_is(word: str, after: After) -> None:
    assert OURS.read((word,), after).words == (word,)
    assert OURS.read(("the", "marker", word), after).words == ("the", "marker", word)


@pytest.mark.parametrize(
    ("said", "words"),
    [
        ("that's the one", "yes"),
        ("correct, the red marker", "yes the red marker"),
        ("not that one the red one", "not that one the red one"),
        ("um nein den roten", "um no den roten"),
        ("no, I'm not sure", "unsure"),
        ("no, that's right", "yes"),
        ("no problem", ""),
        ("sorry, the marker", "sorry the marker"),
        ("no no", "no no"),
    ],
)
def test_words_of_the_observation(said: str, words: str) -> None:
    assert OURS.read(tokenize(said), After.QUESTION).words == tuple(words.split())


def test_a_stand_in_that_items_own_is_left_out() -> None:
    among = lexicon(Answers(), ("stop", "unsure"))
    assert among.read(("not", "sure"), After.QUESTION) == Reading((), Meaning.UNSURE)
    assert among.read(("the", "stop", "sign"), After.QUESTION).words == ("the", "stop", "sign")
    assert among.objects(("stop",)), "a hand-over is stopped all the same"


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ("no", True), ("wrong marker", True), ("not that one", True), ("hold on", True), ("the other one", True),
        ("put it back", True), ("nein", True), ("halt", True), ("no, that's right", True), ("don't", True),
        ("thank you", False), ("the right one", False), ("yes", False), ("no problem", False), ("", False),
    ],
)  # fmt: skip
def test_what_stops_a_hand_over(said: str, expected: bool) -> None:
    assert OURS.objects(tokenize(said)) is expected


def test_which_words_answer() -> None:
    assert OURS.answering(tokenize("um that's the one the red marker")) == {1, 2, 3}
    assert OURS.answering(tokenize("not sure")) == {0, 1}
    assert OURS.answering(tokenize("hand me the marker wait")) == frozenset()


def test_the_paper_s_answers_are_read_word_by_word() -> None:
    words = ("no", "not", "that", "one", "yes")
    assert PAPER.read(words, After.QUESTION) == Reading(words, Meaning.YES)
    assert PAPER.read(("yep",), After.QUESTION) == Reading(("yep",))
    assert PAPER.read(("stop", "wrong", "marker"), After.HANDED).words == ("no", "no", "marker")
    assert PAPER.read(("stop",), After.QUESTION).words == ("stop",)
    assert PAPER.answering(words) == {0, 1, 4}
    assert [PAPER.objects((word,)) for word in (*sorted(STOPS), *NEGATIVE)] == [True] * 8
    assert not PAPER.objects(("yes", "marker"))


def test_a_scene_adds_phrases() -> None:
    among = lexicon(Answers(yes=("roger that", "Ça va"), object=("arrête",), unsure=("sure",)), ("bowl",))
    assert meant("roger that", After.QUESTION, among) == "yes"
    assert meant("ça va", After.QUESTION, among) == "yes"
    assert meant("roger that", After.NOTHING, among) == "-", "a yes that is ours counts after a question"
    assert meant("Arrête", After.NOTHING, among) == "object"
    assert meant("sure", After.QUESTION, among) == "unsure", "a scene's meaning goes before ours"
    assert meant("yes", After.QUESTION, among) == "yes"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"yes": "aye"}, "yes: found 'aye', expected a list of phrases"),
        ({"yes": ["aye", ""]}, "yes[1]: found '', expected a phrase"),
        ({"yes": ["?!"]}, "yes[0]: found '?!', expected a phrase of 1 to 8 words"),
        ({"no": ["a b c d e f g h i"]}, "no[0]: found 'a b c d e f g h i', expected a phrase of 1 to 8 words"),
        ({"no": [3]}, "no[0]: found 3, expected a phrase"),
        (
            {"yes": ["that's me"], "no": ["that is me"]},
            "no[0]: found 'that is me', which yes has",
        ),
        ({"maybe": []}, "maybe: unknown meaning, expected one of yes, no, unsure, repeat, cancel, object"),
    ],
)
def test_answers_that_are_none(data: dict[str, object], message: str) -> None:
    with pytest.raises(SceneError) as caught:
        Answers.from_mapping(data)
    assert str(caught.value).startswith(message)


def test_spellings() -> None:
    assert set(spellings("that's it")) == {("thats", "it"), ("that", "is", "it")}
    assert set(spellings("uh-huh")) == {("uh-huh",), ("uh", "huh"), ("uhhuh",)}
    assert set(spellings("weiß nicht")) == {("weiss", "nicht")}


SAYINGS = st.sampled_from([said for said, _ in rows(AFTER_A_QUESTION) + rows(MIXTURES) + rows(STOPPED)])
AFTERS = st.sampled_from(After)


@given(text=st.text(), after=AFTERS)
def test_any_text_gives_some_reading(text: str, after: After) -> None:
    reading = OURS.read(tokenize(text), after)
    assert_evidence_is_what_is_meant(reading)


@given(sayings=st.lists(SAYINGS, max_size=6), after=AFTERS)
def test_any_answers_give_some_reading_that_stays_as_it_is(sayings: list[str], after: After) -> None:
    reading = OURS.read(tokenize(" ".join(sayings)), after)
    assert_evidence_is_what_is_meant(reading)
    assert OURS.read(reading.words, After.NOTHING).meaning is reading.meaning


@given(
    sayings=st.lists(SAYINGS, max_size=4),
    after=AFTERS,
    marks=st.lists(st.sampled_from([" ", ", ", "... ", "! "]), min_size=4),
)
def test_case_and_punctuation_do_not_count(sayings: list[str], after: After, marks: list[str]) -> None:
    plainly = " ".join(sayings).replace(",", " ").replace(".", " ")
    marked = "".join(word + marks[index % len(marks)] for index, word in enumerate(plainly.upper().split()))
    expected = OURS.read(tokenize(plainly), after)
    found = OURS.read(tokenize(marked), after)
    assert found.meaning is expected.meaning
    assert [word.replace("ss", "ß") for word in found.words] == [word.replace("ss", "ß") for word in expected.words]


@pytest.mark.parametrize("said", ["um", "not that um right the", "uh huh not quite", "that that's the"])
def test_a_long_text_takes_a_time_that_grows_with_it(said: str) -> None:
    def seconds(words: int) -> float:
        long = (said.split() * words)[:words]
        begun = time.process_time()
        OURS.read(long, After.QUESTION)
        return time.process_time() - begun

    seconds(500)
    assert min(seconds(16_000) for _ in range(3)) < 40 * min(seconds(1_000) for _ in range(5)) + 0.05
