"""The page in Debian's Chromium, whose fake microphone plays sentences: when a bar on the screen moves."""

from __future__ import annotations

import asyncio
import base64
import shutil
import wave
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sayings import Saying
from voices import RATE

FLAGS = ("--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
MICROPHONE = ("--use-fake-device-for-media-stream", "--use-fake-ui-for-media-stream")
LEAD = 2.0  # s of noise before a sentence
MISSED = 3.0  # s
LEAST = 0.005  # change of a belief that a bar shows
STEP = 80  # samples between which the sound that was sent is compared with that which was played

# Notes each chunk of sound that leaves the page, and each change of the bars' heights, with their times (ms).
WATCH = """
window.sent = []; window.bars = [];
const send = WebSocket.prototype.send;
WebSocket.prototype.send = function (data) {
  const bytes = data instanceof ArrayBuffer ? new Uint8Array(data) : null;
  if (bytes) window.sent.push([performance.now(), btoa(String.fromCharCode(...bytes))]);
  return send.call(this, data);
};
document.addEventListener("DOMContentLoaded", () => {
  const heights = () => Object.fromEntries([...document.querySelectorAll("#items li")].map((entry) =>
    [entry.querySelector("button").dataset.item, parseFloat(entry.style.getPropertyValue("--belief"))]));
  new MutationObserver(() => { window.bars.push([performance.now(), heights()]); })
    .observe(document.querySelector("#items"), { subtree: true, attributes: true, attributeFilter: ["style"] });
});
"""


@dataclass(frozen=True, slots=True)
class Delays:
    """Delays of the words that moved a bar (s), and how many words were never heard."""

    delays: list[float]
    missed: int


async def watch(host: str, sayings: Sequence[Saying], scratch: Path) -> Delays:
    """Return the delays (s) from the end of each sentence's last word, an item's kind, to the DOM change of its bars.

    Each is said on a page of its own. missed: sentences after which the bars did not rise within MISSED s.
    """
    from playwright.async_api import async_playwright

    found = []
    async with async_playwright() as playwright:
        for saying in sayings:
            sound = _in_noise(saying)
            path = scratch / "sentence.wav"
            with wave.open(str(path), "wb") as file:
                file.setparams((1, 2, RATE, 0, "NONE", ""))
                file.writeframes(sound.tobytes())
            flags = [*FLAGS, *MICROPHONE, f"--use-file-for-fake-audio-capture={path}%noloop"]
            async with await playwright.chromium.launch(
                executable_path=shutil.which("chromium"), args=flags
            ) as browser:
                sent, bars = await _listen(await browser.new_page(locale="en"), host, len(sound) / RATE)
            found.append(_delay(saying, sound, sent, bars))
    delays = [delay for delay in found if delay is not None]
    return Delays(delays, len(found) - len(delays))


async def _listen(page: Any, host: str, seconds: float) -> tuple[list[Any], list[Any]]:
    """Open the page and its microphone; return the sound that left it and the changes of its bars, with times (ms)."""
    from playwright.async_api import expect

    await page.add_init_script(WATCH)
    await page.goto(f"http://{host}/")
    await expect(page.locator("#state")).to_have_text("The robot is listening.", timeout=120_000)
    await page.click("#options")
    await page.check("[name=ears][value=server]")
    await page.uncheck("#hold")
    await page.click("#options")
    await page.click("#microphone")
    await asyncio.sleep(seconds)
    sent, bars = await page.evaluate("[window.sent, window.bars]")
    return sent, bars


def _in_noise(saying: Saying) -> NDArray[np.int16]:
    noise = np.random.default_rng(0).normal(0, saying.noise, round((LEAD + MISSED) * RATE)).astype(np.int16)
    return np.concatenate([noise[: round(LEAD * RATE)], saying.samples, noise[round(LEAD * RATE) :]])


def _delay(saying: Saying, sound: NDArray[np.int16], sent: list[Any], bars: list[Any]) -> float | None:
    """Return how long (s) after the end of the last word the bars of what it names rose; None if they did not."""
    chunks = [np.frombuffer(base64.b64decode(data), "<i2") for _, data in sent]
    left = np.cumsum([len(chunk) for chunk in chunks])
    shift = _shift(sound, np.concatenate(chunks))

    def when(moment: float) -> float:
        sample = round((LEAD + moment) * RATE) + shift
        index = int(np.searchsorted(left, sample))
        return float(sent[index][0] / 1000 - (left[index] - sample) / RATE)

    began, ended = when(saying.ends[-2]), when(saying.ends[-1])
    before = next(heights for time, heights in reversed(bars) if time / 1000 < began)
    rises = (time / 1000 for time, heights in bars if time / 1000 > began and _rose(before, heights, saying.words[-1]))
    moment = next(rises, None)
    return None if moment is None or moment > ended + MISSED else moment - ended


def _rose(before: dict[str, float], after: dict[str, float], kind: str) -> bool:
    return all(after[item] > before[item] + LEAST for item in after if item.startswith(kind))


def _shift(played: NDArray[np.int16], sent: NDArray[np.int16]) -> int:
    """Return how many samples later a sound is in what was sent than in what was played, by their loudness."""
    one, other = (_loudness(samples) for samples in (played, sent))
    size = len(one) + len(other)
    match = np.fft.irfft(np.fft.rfft(other, size) * np.conj(np.fft.rfft(one, size)), size)
    best = int(np.argmax(match))
    return STEP * (best if best < len(other) else best - size)


def _loudness(samples: NDArray[np.int16]) -> NDArray[np.float64]:
    whole = samples[: len(samples) // STEP * STEP].astype(float).reshape(-1, STEP)
    level = np.log(np.sqrt(np.mean(whole**2, axis=1)) + 1)
    return np.asarray(level - level.mean())
