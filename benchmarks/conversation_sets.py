"""What the people of `conversations.py` want and say: tables, sentences, voices; a half to tune on, and one held out.

The halves share no table, no sentence but "yes" and "no", no voice and no speed. The held-out half was written before
the ears were tuned and is measured last.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fetch_pomdp.core.live.person import live_scene, live_scene_from
from fetch_pomdp.core.scene import Scene
from voices import UNHEARD, VOICES

KITCHEN = Path(__file__).parent.parent / "examples" / "kitchen.toml"


@dataclass(frozen=True, slots=True)
class Table:
    """A scene, and what each item is called: so that it is the only one, and so that it need not be."""

    scene: Scene
    exact: tuple[str, ...]
    loose: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Sayings:
    """Sentences; {exact} and {loose} stand for what the item is called."""

    exact: tuple[str, ...]
    loose: tuple[str, ...]
    hesitant: tuple[str, ...]
    yes: tuple[str, ...]
    no: tuple[str, ...]
    corrections: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Half:
    """All that the conversations of a half are made of."""

    tables: tuple[Table, ...]
    sayings: Sayings
    voices: tuple[str, ...]
    talk: tuple[str, ...]  # of the others in the room
    seed: int


@dataclass(frozen=True, slots=True)
class Conversation:
    """A person who wants an item. How they answer does not depend on what the robot asks, but for its truth."""

    table: Table
    target: int
    voice: str
    request: str
    again: str  # said when the robot says that it listens
    yes: str
    no: str
    begins: float  # s
    thinks: float  # s until an answer
    seed: int


def _table(*items: str) -> Table:
    """Make a table of lines "id: words; exact; loose"."""
    parts = [[part.strip() for part in line.replace(":", ";", 1).split(";")] for line in items]
    data = [
        {"id": name, "position": [0.25 * (index - (len(items) - 1) / 2), 1.2, 0.75], "vocabulary": words.split()}
        for index, (name, words, _, _) in enumerate(parts)
    ]
    scene = live_scene_from({"head": [0.0, 0.0, 1.6], "items": data})
    return Table(scene, tuple(part[2] for part in parts), tuple(part[3] for part in parts))


def _row(*items: str) -> Table:
    """Make a table of a row of items from the person's left to the right, each by its words."""
    return _table(*(f"{index}: {words}; {words}; {words}" for index, words in enumerate(items)))


def _tuning() -> Half:
    kinds = ("bowl", "bowl", "marker", "marker", "spoon", "spoon")
    colours = {"bowl": "black bowl", "marker": "green marker", "spoon": "silver spoon"}
    tables = (
        Table(live_scene("ambiguous"), tuple(colours[kind] for kind in kinds), kinds),
        Table(live_scene(KITCHEN), ("red mug", "blue cup", "whisk"), ("mug", "mug", "whisk")),
        _table(
            "red-cup: cup red plastic; red cup; cup", "white-cup: cup white; white cup; cup",
            "scissors: scissors metal sharp; scissors; scissors", "notebook: notebook book paper; notebook; book",
            "yellow-box: box yellow; yellow box; box",
        ),
    )  # fmt: skip
    sayings = Sayings(
        exact=("hand me the {exact}", "give me the {exact} please", "i want the {exact}", "the {exact}"),
        loose=("hand me the {loose}", "can you give me a {loose}", "pass me that {loose} please", "the {loose}"),
        hesitant=("um hand me the {exact}", "uh could i have the {exact}", "well i need the uh {exact}"),
        yes=("yes", "yeah", "yes that one", "yep", "that's right", "sure"),
        no=("no", "nope", "not that one", "no the other one", "no not that one", "nah"),
        corrections=("no the {exact}", "no i want the {exact}"),
    )
    talk = (
        "what is the weather today", "the meeting starts at nine", "my brother lives in boston",
        "we should take the early train", "did you see the match last night", "it was raining all week",
        "i will call her tomorrow afternoon", "they moved to a bigger house",
    )  # fmt: skip
    return Half(tables, sayings, VOICES, talk, seed=1)


def _held_out() -> Half:
    tables = (
        _table(
            "hammer: hammer tool heavy; hammer; hammer", "small-wrench: wrench tool small; small wrench; wrench",
            "large-wrench: wrench tool large; large wrench; wrench", "tape: tape orange; orange tape; tape",
        ),
        _table(
            "green-apple: apple green fruit; green apple; apple", "red-apple: apple red fruit; red apple; apple",
            "banana: banana yellow fruit; banana; banana", "milk: milk carton white; milk carton; milk",
            "fork: fork silver; fork; fork", "knife: knife silver; knife; knife",
        ),
        _table(
            "blue-ball: ball blue; blue ball; ball", "pink-ball: ball pink; pink ball; ball",
            "bear: bear teddy brown; teddy bear; bear", "puzzle: puzzle box wooden; wooden puzzle; puzzle",
            "left-candle: candle; candle; candle", "right-candle: candle; candle; candle",
        ),
    )  # fmt: skip
    sayings = Sayings(
        exact=("bring me the {exact}", "could you pass me the {exact}", "i would like the {exact} please",
               "please give me the {exact}"),
        loose=("bring me the {loose}", "i need that {loose}", "could you hand me a {loose}", "may i have the {loose}"),
        hesitant=("um can i get the {exact}", "er the {exact} please", "could you uh pass me the {exact}"),
        yes=("yes", "yes please", "yup", "yes it is", "that's the one", "correct"),
        no=("no", "no it's not", "no sorry", "the other one", "not this one", "no thanks"),
        corrections=("no the {exact} please", "no i meant the {exact}"),
    )  # fmt: skip
    talk = (
        "have you read the new book about rome", "the kids are at school until three",
        "she said the bus was late again", "let us meet in front of the station", "my phone is almost empty",
        "that restaurant was far too loud", "i have to finish this report by friday", "he is learning the piano now",
    )  # fmt: skip
    return Half(tables, sayings, UNHEARD, talk, seed=2)


PLACES: Mapping[str, Sequence[tuple[Table, Sequence[str]]]] = {
    "tuning": (
        (_row("bowl black", "bowl black", "marker green", "marker green", "spoon silver", "spoon silver"), (
            "the marker next to the spoon", "the leftmost bowl", "the second one from the right",
            "hand me the spoon on the right", "i want the marker closest to the bowl",
        )),
        (_row("mug red", "mug blue", "whisk metal", "plate white", "mug green"), (
            "the mug next to the plate", "can you give me the mug to the right of the red one",
            "the first mug from the left", "not the blue mug", "the one between the blue mug and the plate",
        )),
    ),
    "held-out": (
        (_row("spoon metal", "bowl white", "spoon metal", "fork metal", "cup red"), (
            "the spoon to the left of the bowl", "the one next to the cup", "bring me the spoon near the fork",
        )),
        (_row("block green", "block red", "block green", "block blue", "block green"), (
            "the green one second from the left", "not the green one", "the block between the red one and the blue one",
            "the rightmost green block",
        )),
        (_row("scissors steel", "stapler black", "tape clear", "stapler grey", "pencil yellow"), (
            "the stapler to the right of the tape", "could you pass me the last one on the right",
            "the stapler beside the pencil",
        )),
    ),
}  # fmt: skip


# What is said near a robot and not to it: by a radio, and on the telephone.
OTHERS: Mapping[str, Mapping[str, Sequence[str]]] = {
    "tuning": {
        "radio": (
            "and now the news at eight o'clock", "the minister has said that taxes will not rise this year",
            "heavy rain is expected in the north tonight", "the home team won by three goals to one",
            "traffic is moving slowly on the bridge into town", "that was a song from their second record",
            "scientists have found water on another planet", "stay with us for more after the break",
        ),
        "telephone": (
            "hello it's me", "yes i will call you back in the morning", "no i have not seen her since monday",
            "okay see you at the station then", "right and what did he say", "give me a minute i am writing it down",
            "can you send me the address", "i left the keys on the table",
        ),
    },
    "held-out": {
        "radio": (
            "good evening and welcome to the programme", "the price of bread has gone up again",
            "police are looking for a man in a grey coat", "tomorrow will be dry with some sunshine in the west",
            "the band will play in london next weekend", "our next guest has written a book about bees",
            "the museum opens its doors to visitors on sunday", "voters go to the polls in two days",
        ),
        "telephone": (
            "hi mum how are you", "no the doctor is not in before noon", "yes that would be lovely thank you",
            "could you give me your number again", "i want to change my ticket please", "wait i can't hear you",
            "okay i will bring the wine", "she left it on the kitchen table",
        ),
    },
}  # fmt: skip


HALVES: Mapping[str, Half] = {"tuning": _tuning(), "held-out": _held_out()}


def conversations(half: Half, count: int) -> list[Conversation]:
    """Return conversations, the same for the same half and count: three of ten exact, four loose, three hesitant."""
    rng, made = np.random.default_rng(half.seed), []
    for index in range(count):
        table = half.tables[index % len(half.tables)]
        target = int(rng.integers(len(table.scene.items)))
        names = {"exact": table.exact[target], "loose": table.loose[target]}

        def say(texts: tuple[str, ...], names: Mapping[str, str] = names) -> str:
            return texts[rng.integers(len(texts))].format(**names)

        kind = index % 10
        sayings = half.sayings
        corrects = rng.random() < 0.3 and table.exact.count(names["exact"]) == 1
        made.append(
            Conversation(
                table, target, half.voices[index // len(half.tables) % len(half.voices)],
                request=say(sayings.exact if kind < 3 else sayings.loose if kind < 7 else sayings.hesitant),
                again=say(sayings.exact), yes=say(sayings.yes),
                no=say(sayings.corrections if corrects else sayings.no),
                begins=float(rng.uniform(0.5, 1.5)), thinks=float(rng.uniform(0.1, 0.7)), seed=index,
            )
        )  # fmt: skip
    return made
