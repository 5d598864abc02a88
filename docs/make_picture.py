"""Make docs/fetch.svg, the picture of the README: the interaction of `make demo`, as the terminal shows it.

python docs/make_picture.py
"""

from __future__ import annotations

import io
from pathlib import Path

from rich.console import Console
from rich.terminal_theme import DIMMED_MONOKAI

from fetch_pomdp import Agent, interact
from fetch_pomdp.adapters.robot.console import ConsoleRobot
from fetch_pomdp.adapters.speech.audio import open_wav
from fetch_pomdp.adapters.speech.sphinx import SphinxRecognizer
from fetch_pomdp.adapters.vision.recorded import RecordedSkeleton
from fetch_pomdp.cli.show import show_event
from fetch_pomdp.core.live.person import live_scene

ROOT = Path(__file__).parent.parent
# A page without addresses in it: the fonts are those of whoever looks at it.
PAGE = """<svg class="rich-terminal" viewBox="0 0 {width} {height}" xmlns="http://www.w3.org/2000/svg">
<style>
.{unique_id}-matrix {{ font-family: ui-monospace, "DejaVu Sans Mono", Menlo, Consolas, monospace;
  font-size: {char_height}px; line-height: {line_height}px; font-variant-east-asian: full-width; }}
.{unique_id}-title {{ font-size: 18px; font-weight: bold; font-family: sans-serif; }}
{styles}
</style>
<defs>
<clipPath id="{unique_id}-clip-terminal">
<rect x="0" y="0" width="{terminal_width}" height="{terminal_height}" /></clipPath>
{lines}
</defs>
{chrome}
<g transform="translate({terminal_x}, {terminal_y})" clip-path="url(#{unique_id}-clip-terminal)">
{backgrounds}
<g class="{unique_id}-matrix" xml:space="preserve">{matrix}</g>
</g>
</svg>
"""


def main() -> None:
    """Play the recording of the demo and draw what a terminal shows."""
    agent = Agent(live_scene("ambiguous"))
    ears = SphinxRecognizer(open_wav(ROOT / "examples" / "marker.wav"), agent.scene.words)
    eyes = RecordedSkeleton.open(ROOT / "examples" / "marker.jsonl")
    console = Console(record=True, width=92, file=io.StringIO(), force_terminal=True, highlight=False)
    said: list[str] = []
    for event in interact(agent, ConsoleRobot(said.append), ears, eyes):
        show_event(event, agent, console)
        while said:
            console.print(f"[green]         robot: {said.pop(0)}[/green]")
    title = "fetch-pomdp fetch ambiguous --audio marker.wav --skeleton marker.jsonl"
    console.save_svg(str(ROOT / "docs" / "fetch.svg"), title=title, theme=DIMMED_MONOKAI, code_format=PAGE)


if __name__ == "__main__":
    main()
