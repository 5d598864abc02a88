"""A small server of the chat-completions interface: `python -m tests.adapters.reading.served_model`.

A process of its own, which prints its port. Its model is honest and simple: the logarithm of an item's chance is STEEP
times the number of its words that the person said. Models of other names misbehave as these say.
"""

from __future__ import annotations

import json
import math
import random
import re
import sys
import time
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

STEEP = 2.0
KEY = "sk-only-this-one"
ITEM = re.compile(r"^(\w+): (.+?) \(\"", re.MULTILINE)
SAID = re.compile(r"^The person says: (\".*\")\. Which", re.MULTILINE)


def chances(content: str) -> dict[str, float]:
    """The chance of each label by the words that the person said; "?" has that of an item without any of them."""
    said = set(re.findall(r"\w+", json.loads(SAID.search(content)[1]).lower()))  # type: ignore[index]
    weights = {label: math.exp(STEEP * len(said & set(words.split()))) for label, words in ITEM.findall(content)}
    weights["?"] = 1.0
    total = sum(weights.values())
    return {label: weight / total for label, weight in weights.items()}


def completion(question: dict[str, Any]) -> dict[str, Any]:
    found = chances(question["messages"][-1]["content"])
    rng = random.Random(json.dumps(question))
    choices = []
    for index in range(question.get("n", 1)):
        likeliest = max(found, key=lambda label: found[label])
        label = rng.choices([*found], [*found.values()])[0] if question["temperature"] else likeliest
        choice: dict[str, Any] = {"index": index, "finish_reason": "stop", "logprobs": None}
        choice["message"] = {"role": "assistant", "content": f" {label}."}
        if question.get("logprobs"):
            ranked = sorted(found, key=lambda each: -found[each])[: question["top_logprobs"]]
            listed = [{"token": f" {each}", "logprob": math.log(found[each]), "bytes": None} for each in ranked]
            first = {"token": "\n", "logprob": -0.1, "bytes": [10], "top_logprobs": []}
            choice["logprobs"] = {"content": [first, {**listed[0], "top_logprobs": listed}]}
        choices.append(choice)
    return {"id": "1", "object": "chat.completion", "created": 0, "model": question["model"], "choices": choices}


def logprobs_of(content: Any) -> dict[str, Any]:
    return {"choices": [{"message": {"role": "assistant", "content": "A"}, "logprobs": {"content": content}}]}


# What models of these names answer, whatever they are asked.
ANSWERS: dict[str, Any] = {
    "a-list": [1, 2],
    "nothing-chosen": {"choices": []},
    "no-choices": {"error": {"message": "no such model"}},
    "null": None,
    "text-logprobs": logprobs_of("A"),
    "text-token": logprobs_of([{"token": "A", "logprob": "likely", "top_logprobs": [{"token": "A", "logprob": "x"}]}]),
    "not-a-number": logprobs_of([{"token": "A", "logprob": 0, "top_logprobs": [{"token": "A", "logprob": math.nan}]}]),
    "no-label": logprobs_of([{"token": "Sure", "logprob": 0.0, "top_logprobs": [{"token": "Sure", "logprob": 0.0}]}]),
    "no-logprobs": {"choices": [{"message": {"role": "assistant", "content": "A"}, "logprobs": None}]},
    "chatty": {"choices": [{"message": {"role": "assistant", "content": "Sure! It is"}}]},
}  # fmt: skip


class Handler(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def log_message(self, *_: object) -> None:
        """Say nothing."""

    def do_POST(self) -> None:
        question = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        model = question["model"]
        if self.path != "/v1/chat/completions":
            self.sent(404, b"{}")
        elif model in ANSWERS:
            self.sent(200, json.dumps(ANSWERS[model]).encode())
        elif model in MISBEHAVING:
            MISBEHAVING[model](self)
        else:
            self.sent(200, json.dumps(completion(question)).encode())

    def sent(self, status: int, body: bytes, **headers: str) -> None:
        self.send_response(status)
        for name, value in {"Content-Type": "application/json", "Content-Length": str(len(body)), **headers}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def slow(self) -> None:
        time.sleep(5.0)
        self.sent(200, b"{}")

    def dripping(self) -> None:
        self.send_response(200)
        self.send_header("Content-Length", "1000000")
        self.end_headers()
        for _ in range(100):
            self.wfile.write(b" ")
            self.wfile.flush()
            time.sleep(0.05)

    def cut(self) -> None:
        self.send_response(200)
        self.send_header("Content-Length", "1000000")
        self.end_headers()
        self.wfile.write(b'{"choices"')
        self.close_connection = True

    def silent(self) -> None:
        self.close_connection = True

    def locked(self) -> None:
        if self.headers["Authorization"] == f"Bearer {KEY}":
            self.sent(200, json.dumps(logprobs_of([{"token": "A", "logprob": 0.0}])).encode())
        else:
            found = self.headers["Authorization"]
            self.sent(401, json.dumps({"error": {"message": f"Incorrect API key provided: {found}"}}).encode())


MISBEHAVING: dict[str, Callable[[Handler], None]] = {
    "slow": Handler.slow,
    "dripping": Handler.dripping,
    "cut": Handler.cut,
    "silent": Handler.silent,
    "locked": Handler.locked,
    "failing": lambda handler: handler.sent(500, b"internal error"),
    "elsewhere": lambda handler: handler.sent(307, b"", Location="/v1/other"),
    "a-page": lambda handler: handler.sent(200, b"<html>Welcome</html>"),
    "deep": lambda handler: handler.sent(200, b"[" * 100_000),
    "long": lambda handler: handler.sent(200, b'"' + b"a" * 2_000_000 + b'"'),
}


def main() -> None:
    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    server.daemon_threads = True
    sys.stdout.write(f"{server.server_port}\n")
    sys.stdout.flush()
    server.serve_forever()


if __name__ == "__main__":
    main()
