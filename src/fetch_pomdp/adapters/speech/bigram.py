"""A small bigram language model of what people say to a fetching robot, as ARPA text.

Choice: the paper does not say how speech was recognised beyond the words of the items. A bigram over requests, answers and
the items' words is right more often than a grammar or an open model; common words that are none of these are in it too, so
that "what time is it" is heard as itself and not bent into a request.
"""

from __future__ import annotations

import math
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from itertools import pairwise

from fetch_pomdp.core.words import NEGATIVE, POSITIVE, tokenize

START, END = "<s>", "</s>"
REQUESTS = (
    "hand me", "give me", "pass me", "bring me", "get me", "i want", "i need", "i would like", "can i have", "may i have",
    "could i have", "can you hand me", "could you give me", "could you please pass me", "would you hand me",
    "please hand me", "please give me", "please pass me", "can you get me", "pick up",
)  # fmt: skip
DETERMINERS = ("the", "that", "this", "a")
PLACES = ("on the left", "on the right", "in the middle", "in front", "in the back", "behind", "over there", "next to")
ANSWERS = (*(POSITIVE), "yes that one", "yes please", "no", "nope", "no not that one", "not that one", "no the other one",
           "the other one", "other one")  # fmt: skip
POINTERS = ("that one", "this one", "that", "this")
COMMON = tuple(
    """about after again all also always am an and another any are around as ask at away back bad be because been before best
    better big book boy but buy by call came car chair child city clean close cold come day did dinner do does doing done
    door down drink each eat end even ever every eye fall family far father feel few find first five floor food for four
    friend from game girl go going good got great had half happy hard has have he head hear help her here him his home hot
    hour house how if inside into is it its job just keep kind know last late later leave let life light like line little
    live long look lot love made make man many me mean meet might mind money month more morning most mother move much music
    must my name near never new next night nine now number of off office old once one only open or our out outside own paper
    part people person phone place play point put question read really road room run said same say school see seven she shop
    should show side sit six sleep small so some something soon start stay still stop story street such sun table take talk
    teacher tell ten than thank thanks their them then these they thing think those three time to today together tomorrow
    tonight too town train try turn two under until us use very wait walk wall was watch water way we weather week well went
    were what when where which while who why will window with woman word work world write year yesterday you your""".split()
)


def language_model(vocabulary: Iterable[str], common: Sequence[str] = COMMON) -> str:
    """Return a bigram model over the items' words, requests, answers and common words, as ARPA text.

    A history's words keep a share of its probability; the rest is spread over all other words as their own frequency is.
    """
    links = _links(tuple(dict.fromkeys(vocabulary)))
    unigrams = _unigrams(links, common)
    lines, backoffs = [], {}
    for history, following in links.items():
        total = sum(following.values()) * (1 + UNSEEN)
        left = UNSEEN / (1 + UNSEEN)
        backoffs[history] = left / (1 - sum(unigrams[word] for word in following))
        lines += [f"{math.log10(count / total):.6f} {history} {word}" for word, count in following.items()]
    singles = [f"{_log(p):.6f} {w} {_log(backoffs.get(w, 1.0)):.6f}" for w, p in unigrams.items()]
    header = f"\\data\\\nngram 1={len(singles)}\nngram 2={len(lines)}\n"
    return "\n".join([header, "\\1-grams:", *singles, "", "\\2-grams:", *lines, "", "\\end\\", ""])


UNSEEN = 0.15
COMMON_SHARE = 0.1


def _log(p):
    return math.log10(p) if p else -99.0


def _unigrams(links, common):
    counts: Counter[str] = Counter()
    for following in links.values():
        counts.update(following)
    own = sum(counts.values())
    extra = [w for w in common if w not in counts]
    for w in counts:
        counts[w] += 0.002 * own
    own = sum(counts.values())
    p = {w: c / own * ((1 - COMMON_SHARE) if extra else 1) for w, c in counts.items()}
    p |= {w: COMMON_SHARE / len(extra) for w in extra}
    p[START] = 0.0
    return p


def _links(vocabulary):
    links: defaultdict[str, Counter[str]] = defaultdict(Counter)

    def add(sentence: str, weight: float) -> None:
        words = sentence.split()
        for h, w in pairwise(words):
            links[h][w] += weight

    n = len(vocabulary)
    for d in DETERMINERS:
        for r in REQUESTS:
            add(f"{START} {r} {d}", 1 / len(REQUESTS) / (1 if d == "the" else 3))
        add(f"{START} {d}", 0.5)
        add(f"{d} one {END}", 0.3)
        for w in vocabulary:
            add(f"{d} {w}", 1 / n)
    for r in REQUESTS:
        for p in POINTERS:
            add(f"{START} {r} {p} {END}", 0.3 / len(REQUESTS) / len(POINTERS))
    for w in vocabulary:
        for v in vocabulary:
            if v != w:
                add(f"{w} {v}", 0.5 / n / max(1, n - 1))
        add(f"{START} {w}", 0.3 / n)
        add(f"{w} {END}", 1 / n)
        add(f"{w} please {END}", 0.1 / n)
        add(f"{w} one {END}", 0.1 / n)
        for p in PLACES:
            add(f"{w} {p} {END}", 0.2 / n / len(PLACES))
        add(f"next to the {w} {END}", 0.2 / n / len(PLACES))
    for a in ANSWERS:
        add(f"{START} {a} {END}", 0.3)
    for a in POSITIVE + ("no", "nope"):
        add(f"{START} {a} the", 0.02)
    for p in POINTERS:
        add(f"{START} {p} {END}", 0.2)
    return links
