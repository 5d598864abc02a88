"""Recognizer over PocketSphinx: a Sound, cut into utterances, each decoded with a bigram model of the scene's words."""

from __future__ import annotations

import logging
import math
import re
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from fetch_pomdp.adapters.speech.audio import Samples, Sound
from fetch_pomdp.adapters.speech.bigram import COMMON, language_model, own_words
from fetch_pomdp.adapters.speech.denoise import denoise
from fetch_pomdp.adapters.speech.pronunciation import pronounce
from fetch_pomdp.adapters.speech.recorded import SoundRecognizer
from fetch_pomdp.adapters.speech.utterances import SpeechSegment
from fetch_pomdp.core.alternatives import Alternative
from fetch_pomdp.core.language.reading.grammar import grammar
from fetch_pomdp.core.language.reading.tokens import nearest, uninflected
from fetch_pomdp.core.ports import Word
from fetch_pomdp.extras import load

logger = logging.getLogger(__name__)

Decoder: TypeAlias = Any  # pocketsphinx has no types
Segment: TypeAlias = Any
Texts: TypeAlias = tuple[str, ...]

FRAMES = 100.0  # decoder frames a second
NOISE = -30.0  # dB under the utterance's mean power: the decoder was trained on rooms, and hears badly without one
SEED = 0
OTHER_TALK = 0.45  # share of common words above which an utterance is not meant for the robot, and only they are given
# The language model's score a frame below which nobody meant the robot: what is made of other talk is no sentence of
# the model. By the tuning half of benchmarks/conversation_sets.py, in quiet: none of 60 requests and answers is below
# it, and 21 of 32 sentences to others; with -1.15 it is 2 and 28, and in noise too many requests.
LEAST_EXPECTED = -1.3
MOST_PATHS = 500  # of the decoder's lattice; many are of the same words
MOST_READINGS = 10
LEAST_WEIGHT = 0.001
SCORE = 1024.0  # the decoder's scores are logarithms over 2^10
LEAST_SCORE = 1e-300  # in place of one that is too small for a number
FLATNESS = 12.0  # what these are divided by: sounds of neighbouring frames are not independent of each other
FILLER = ("<", "[")  # how silence and noises are spelt in the decoder's dictionary


class SphinxTranscriber:
    """Finds the words of an utterance. Implements Transcriber. Raises MissingExtraError without pocketsphinx."""

    def __init__(self, vocabulary: Sequence[str]) -> None:
        self._decoder = _decoder(vocabulary)
        self._foreign = frozenset(COMMON).difference(own_words(vocabulary))
        self._idle = _idle(self._foreign, vocabulary)

    def words(self, utterance: SpeechSegment) -> list[Word]:
        """Return the words with their times on the clock of the utterance, whatever was heard before."""
        self._decoder.reinit_feat()
        return self.next_words(utterance)

    def next_words(self, utterance: SpeechSegment) -> list[Word]:
        """Return the words of the next utterance of one stream: what the decoder knows of its noise by now helps."""
        decoder = self._decoder
        decoder.start_utt()
        decoder.process_raw(_prepared(utterance.samples).tobytes(), full_utt=True)
        decoder.end_utt()
        segments = [segment for segment in decoder.seg() or () if not segment.word.startswith(FILLER)]
        heard = tuple(_text(segment.word) for segment in segments)
        expected = _expected(segments) >= LEAST_EXPECTED
        meant = self._meant(heard)
        readings = self._readings(_scored(decoder), meant) if expected else ()
        kept = (
            segments if expected and meant == heard else [each for each in segments if _text(each.word) in self._idle]
        )
        return [_word(segment, utterance.start, readings) for segment in kept]

    def _meant(self, words: Texts) -> Texts:
        """Return the words, or of talk about other things those that say nothing to the robot."""
        foreign = sum(word in self._foreign for word in words)
        return tuple(word for word in words if word in self._idle) if foreign > OTHER_TALK * len(words) else words

    def _readings(self, scored: Mapping[Texts, float], best: Texts) -> tuple[Alternative, ...]:
        """Return the readings of an utterance, the best first; none if it is the only one."""
        logs = {best: -math.inf}
        for words, log in scored.items():
            meant = self._meant(words)
            logs[meant] = np.logaddexp(logs.get(meant, -math.inf), log / FLATNESS)
        most = max(logs.values())
        if most == -math.inf:
            return ()
        logs[best] = max(logs[best], most)  # the decoder says so, though it searches another way
        likely = sorted(logs.items(), key=lambda one: (one[0] != best, -one[1]))[:MOST_READINGS]
        weights = np.exp([log - most for _, log in likely])
        weights /= weights.sum()
        found = zip(likely, weights.tolist(), strict=True)
        return tuple(Alternative(words, weight) for (words, _), weight in found if weight > LEAST_WEIGHT)


class SphinxRecognizer(SoundRecognizer):
    """Ears over a Sound. Implements Recognizer. Raises MissingExtraError without pocketsphinx or onnxruntime."""

    def __init__(self, sound: Sound, vocabulary: Sequence[str]) -> None:
        super().__init__(sound, SphinxTranscriber(vocabulary).next_words)


def _idle(words: Iterable[str], vocabulary: Sequence[str]) -> frozenset[str]:
    """Return the words that say nothing to a reader: it knows neither them nor any that they may be misspellings of."""
    language = grammar("english")
    known = language.known | frozenset(vocabulary)
    alike = known.union(language.synonyms, language.colours)
    return frozenset(
        word
        for word in words
        if alike.isdisjoint((word, *uninflected(word, language))) and nearest(word, known) is None
    )


def _expected(segments: Sequence[Segment]) -> float:
    """Return the language model's score of words, a frame; 0 for none."""
    frames = segments[-1].end_frame - segments[0].start_frame + 1 if segments else 1
    return sum(SCORE * math.log(max(segment.lscore, LEAST_SCORE)) for segment in segments) / frames


def _word(segment: Segment, start: float, readings: tuple[Alternative, ...]) -> Word:
    begin, end = (start + frame / FRAMES for frame in (segment.start_frame, segment.end_frame + 1))
    return Word(_text(segment.word), begin, end, min(1.0, segment.prob), readings if len(readings) > 1 else ())


def _text(entry: str) -> str:
    """Return a word of the dictionary: "the(2)" is another way to say "the"."""
    return re.sub(r"\(\d+\)$", "", entry)


def _scored(decoder: Decoder) -> dict[Texts, float]:
    """Return the paths of the last utterance, and the log of the acoustic and language model's score of each."""
    found: dict[Texts, float] = {}
    for path in islice(decoder.nbest() or (), MOST_PATHS):
        if path is not None and path.score > 0:
            words = tuple(_text(word) for word in path.hypstr.split() if not word.startswith(FILLER))
            found[words] = max(found.get(words, -math.inf), SCORE * math.log(path.score))
    return found


def _decoder(vocabulary: Sequence[str]) -> Decoder:
    pocketsphinx = load("pocketsphinx", "speech")
    dictionary = _dictionary(Path(pocketsphinx.get_model_path("en-us/cmudict-en-us.dict")))
    known = [word for word in vocabulary if _learn(word, dictionary)]
    if unknown := sorted(set(vocabulary) - set(known)):
        logger.warning("no pronunciation for %s: these words will not be heard", ", ".join(unknown))
    items = {phones for word in known for phones in dictionary[word]}
    common = [word for word in COMMON if items.isdisjoint(dictionary[word])]  # "meet" is no word beside an item "meat"
    own = [word for word in own_words(known) if _learn(word, dictionary)]
    sounds = [
        f"{word}({number}) {phones}" if number > 1 else f"{word} {phones}"
        for word in dict.fromkeys([*own, *common])
        for number, phones in enumerate(dictionary[word], 1)
    ]
    with tempfile.TemporaryDirectory() as folder:
        language, words = Path(folder) / "scene.arpa", Path(folder) / "scene.dict"
        language.write_text(language_model(known, common), encoding="ascii")
        words.write_text("\n".join([*sounds, ""]), encoding="ascii")  # all of cmudict would take 0.7 s to load, not 0.1
        return pocketsphinx.Decoder(lm=str(language), dict=str(words), loglevel="FATAL")


def _dictionary(path: Path) -> dict[str, list[str]]:
    """Read how words sound, in one or more ways each."""
    dictionary: dict[str, list[str]] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        word, _, phones = line.partition(" ")
        dictionary.setdefault(word.partition("(")[0], []).append(phones)
    return dictionary


def _learn(word: str, dictionary: dict[str, list[str]]) -> bool:
    """Make sure that the dictionary has a word; False if it is spelt with other letters than a to z."""
    if word in dictionary:
        return True
    phones = pronounce(word, lambda part: dictionary.get(part, [None])[0])
    if phones:
        dictionary[word] = [phones]
        logger.info("%s is taken to sound like %s", word, phones)
    return phones is not None


def _prepared(samples: Samples) -> Samples:
    """Take noise out and put a little back, the same every time: in digital silence the decoder hears nonsense."""
    cleaned = denoise(samples.astype(float))
    loudness = np.sqrt(np.mean(np.square(cleaned)))
    noise = np.random.default_rng(SEED).standard_normal(len(samples))
    mixed = cleaned + noise * max(1.0, loudness * 10 ** (NOISE / 20))
    return np.asarray(np.clip(np.round(mixed), -32768, 32767), np.int16)
