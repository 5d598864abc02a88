"""A small bigram language model of what people say to a fetching robot, as ARPA text.

Choice: the paper does not say how it recognised speech. A bigram over requests, answers and the items' words is right
more often than a grammar or an open model of English. Common words that are none of these belong to it too, so that
other talk tends to come out as itself rather than as a request.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import pairwise

from fetch_pomdp.adapters.speech.descriptions import Followers
from fetch_pomdp.adapters.speech.descriptions import followers as describing
from fetch_pomdp.core.language.words import POSITIVE, tokenize

START, END = "<s>", "</s>"
UNSEEN = 0.15  # of a word's probability mass, what is left for words that no sentence below has after it
COMMON_SHARE = 0.3  # of the unigram probability, what the common words have together
LEAST_SHARE = 0.002  # of the unigram probability, what every word of our own has at least
REQUESTS = (
    "hand me", "give me", "pass me", "bring me", "get me", "i want", "i need", "i would like", "can i have",
    "may i have", "could i have", "can you hand me", "could you give me", "could you please pass me",
    "would you hand me", "please hand me", "please give me", "please pass me", "can you get me", "pick up",
)  # fmt: skip
DETERMINERS = {"the": 6.0, "that": 1.0, "this": 1.0, "a": 1.0}  # and how often, relative to each other
POINTERS = ("that one", "this one", "that", "this")
PLACES = ("on the left", "on the right", "in the middle", "in front", "in the back", "behind", "over there")
ANSWERS = (
    *POSITIVE, "yes please", "yes that one", "no not that one", "not that one", "no the other one",
    "the other one", "other one",
)  # fmt: skip
MORE_ANSWERS = (  # such as `language.english` understands
    "yep", "yes it is", "that's right", "that's it", "that's the one", "correct", "exactly", "okay", "right",
    "nope", "nah", "not this one", "no it's not", "no it isn't", "no thanks", "no thank you", "that's not it",
    "wrong one", "not that",
)  # fmt: skip
DESCRIBED = 1.0  # how often a description by the grammar is said, against the simple ones below
HESITATIONS = ("um", "uh", "er", "well")  # before a request, and before what it is about
COMMON = tokenize(  # and none that sounds like one of our own, as know and show
    "about after again all also always am an and another any are around as ask at away bad be because been before "
    "best better big book boy but buy by call came car chair child city clean close cold come day did dinner do does "
    "doing done door down drink each eat end even ever every fall family far father feel few find first five floor "
    "food for four friend from game girl go going good got great had half happy hard has he head hear help her here "
    "him his home hot hour house how if inside into is it its job just keep kind last late later leave let life light "
    "line little live long look lot love made make man many mean meet might mind money month more morning most mother "
    "move much music must my name near never new night nine now number of off office old once only open or our out "
    "outside own paper part people person phone place play point put question read really road room run said same say "
    "school see seven she shop should side sit six sleep small so some something soon start stay still stop "
    "story street such sun table take talk teacher tell ten than thank thanks them then these they thing think those "
    "three time today together tomorrow tonight town train try turn under until us use very wait walk wall was watch "
    "water way we weather week well went were what when where which while who why will window with woman word work "
    "world year yesterday your"
)

Links = Mapping[str, Mapping[str, float]]  # how often the second word follows the first


def language_model(vocabulary: Iterable[str], common: Sequence[str] = COMMON) -> str:
    """Return a bigram model over the items' words (`vocabulary`), requests, answers and common words, as ARPA text.

    After each word its followers have 1 - UNSEEN of the probability; all others share the rest by their own frequency.
    """
    links = _links(tuple(dict.fromkeys(vocabulary)))
    alone = _unigrams(links, common)
    bigrams, backoff = [], {}
    for word, followers in links.items():
        total = sum(followers.values()) / (1 - UNSEEN)
        bigrams += [f"{math.log10(count / total):.6f} {word} {follower}" for follower, count in followers.items()]
        backoff[word] = UNSEEN / (1 - sum(alone[follower] for follower in followers))
    unigrams = [f"{math.log10(p):.6f} {word} {math.log10(backoff.get(word, 1.0)):.6f}" for word, p in alone.items()]
    unigrams.append(f"-99 {START} {math.log10(backoff[START]):.6f}")
    counts = ["\\data\\", f"ngram 1={len(unigrams)}", f"ngram 2={len(bigrams)}"]
    return "\n".join([*counts, "", "\\1-grams:", *unigrams, "", "\\2-grams:", *bigrams, "", "\\end\\", ""])


def own_words(vocabulary: Iterable[str]) -> list[str]:
    """Return the words of requests, descriptions and answers: all of the language model but the common ones."""
    links = _links(tuple(dict.fromkeys(vocabulary)))
    return [word for word in dict.fromkeys(word for after in links.values() for word in after) if word != END]


def _unigrams(links: Links, common: Sequence[str]) -> dict[str, float]:
    """Return every word's own probability, of all but the start: nothing comes before it."""
    counts: defaultdict[str, float] = defaultdict(float)
    for followers in links.values():
        for follower, count in followers.items():
            counts[follower] += count
    least = LEAST_SHARE * sum(counts.values())
    total = sum(counts.values()) + least * len(counts)
    others = [word for word in common if word not in counts]
    share = COMMON_SHARE if others else 0.0
    own = {word: (1 - share) * (count + least) / total for word, count in counts.items()}
    return own | {word: share / len(others) for word in others}


def _links(vocabulary: Sequence[str]) -> Links:
    """Count what follows what in requests, descriptions and answers, each of them said about equally often."""
    links: defaultdict[str, defaultdict[str, float]] = defaultdict(lambda: defaultdict(float))

    def say(sentences: Iterable[str], times: float) -> None:
        every = list(sentences)
        for sentence in every:
            for word, follower in pairwise(sentence.split()):
                links[word][follower] += times / len(every)

    say((f"{START} {answer} {END}" for answer in ANSWERS), 3.6)
    say((f"{START} {answer} {END}" for answer in ("yes", "no")), 4.0)
    say((f"{START} {answer} {END}" for answer in MORE_ANSWERS), 1.2)
    say((f"no {request} the" for request in REQUESTS), 0.12)
    say((f"{START} {sound} {request}" for sound in HESITATIONS for request in REQUESTS), 0.1)
    say((f"{determiner} {sound}" for determiner in ("the", "a") for sound in ("um", "uh")), 0.06)
    say((f"{sound} {word}" for sound in ("um", "uh") for word in vocabulary), 0.12)
    say((f"{START} {sound} {determiner}" for sound in HESITATIONS for determiner in DETERMINERS), 0.1)
    say((f"{START} {pointer} {END}" for pointer in POINTERS), 0.8)
    say((f"{START} {request} {pointer} {END}" for request in REQUESTS for pointer in POINTERS), 0.3)
    for determiner, times in DETERMINERS.items():
        say((f"{START} {request} {determiner}" for request in REQUESTS), times / 3)
        say([f"{START} {determiner}", f"{determiner} one {END}"], 0.8)
        say((f"{determiner} {word}" for word in vocabulary), 1.0)
    say((f"{START} {answer} the" for answer in (*POSITIVE, "no", "nope")), 0.12)
    say((f"{START} {word}" for word in vocabulary), 0.3)
    say((f"{word} {END}" for word in vocabulary), 1.0)
    say((f"{word} {other}" for word in vocabulary for other in vocabulary if word != other), 0.5)
    say((f"{word} {tail} {END}" for word in vocabulary for tail in ("please", "one")), 0.2)
    say((f"{word} {place} {END}" for word in vocabulary for place in PLACES), 0.2)
    _describe(links, describing(vocabulary))
    return links


def _describe(links: defaultdict[str, defaultdict[str, float]], described: Followers) -> None:
    """Count what follows what in descriptions, said alone, after requests and after an answer."""
    leads = (*(request.split()[-1] for request in REQUESTS), START, "no", "yes")
    for word, begins, ends, after in zip(
        described.words, described.first, described.last, described.follows, strict=True
    ):
        if begins > 0:
            for lead in leads:
                links[lead][word] += DESCRIBED * begins / len(leads)
        for end, share in ((END, 0.8), ("please", 0.2)):
            if ends > 0:
                links[word][end] += DESCRIBED * share * ends
        for follower, count in zip(described.words, after, strict=True):
            if count > 0:
                links[word][follower] += DESCRIBED * count
