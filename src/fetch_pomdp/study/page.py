"""Parts of an HTML page that needs nothing beside itself: no script, no network, no file."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from html import escape

STYLE = """
:root { color-scheme: light dark; }
body { font: 1rem/1.5 system-ui, sans-serif; max-width: 60rem; margin: 2rem auto; padding: 0 1rem; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2.5rem; }
table { border-collapse: collapse; margin: 1rem 0; font-variant-numeric: tabular-nums; font-size: .9rem; }
caption { text-align: left; padding-bottom: .4rem; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid #8886; text-align: right; vertical-align: top; }
th { font-weight: 600; } th[scope=row], th.text, td.text { text-align: left; }
.wide { overflow-x: auto; } figure { margin: 1.5rem 0; } img { max-width: 100%; height: auto; }
figcaption, .small { font-size: .9rem; }
"""


def page(title: str, body: Sequence[str]) -> str:
    """Return a whole page; body: HTML."""
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n<title>{escape(title)}</title>\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n<style>{STYLE}</style>\n</head>\n'
        f"<body>\n<main>\n<h1>{escape(title)}</h1>\n" + "\n".join(body) + "\n</main>\n</body>\n</html>\n"
    )


def heading(text: str) -> str:
    """Return a heading of a section."""
    return f"<h2>{escape(text)}</h2>"


def paragraph(text: str) -> str:
    """Return a paragraph of plain text."""
    return f"<p>{escape(text)}</p>"


def points(texts: Sequence[str]) -> str:
    """Return a list of plain texts."""
    return "<ul>\n" + "\n".join(f"<li>{escape(text)}</li>" for text in texts) + "\n</ul>"


def grid(caption: str, headers: Sequence[str], rows: Sequence[Sequence[str]], labels: int = 1) -> str:
    """Return a table of plain texts; the first `labels` columns say what a row is about."""
    head = "".join(f'<th scope="col"{_text(place < labels)}>{escape(name)}</th>' for place, name in enumerate(headers))
    body = "\n".join(
        "<tr>" + "".join(_cell(text, place < labels) for place, text in enumerate(row)) + "</tr>" for row in rows
    )
    return (
        f'<div class="wide" role="region" aria-label="{escape(caption)}" tabindex="0"><table>\n'
        f"<caption>{escape(caption)}</caption>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}\n</tbody>\n</table></div>"
    )


def _cell(text: str, label: object) -> str:
    return f'<th scope="row">{escape(text)}</th>' if label else f"<td>{escape(text)}</td>"


def _text(label: object) -> str:
    return ' class="text"' if label else ""


def picture(svg: str, alt: str, caption: str) -> str:
    """Return a picture inside the page; alt: what it shows, for who cannot see it."""
    data = base64.b64encode(svg.encode()).decode()
    image = f'<img src="data:image/svg+xml;base64,{data}" alt="{escape(alt)}">'
    return f"<figure>\n{image}\n<figcaption>{escape(caption)}</figcaption>\n</figure>"
