"""The server's ears before they are open, and when they do not open."""

from __future__ import annotations

import pytest

from fetch_pomdp.adapters.web.ears import Ears
from fetch_pomdp.adapters.web.protocol import LARGEST_MESSAGE
from fetch_pomdp.core.live import Inbox
from fetch_pomdp.errors import MessageError


@pytest.mark.parametrize("size", [0, 1, 3, LARGEST_MESSAGE + 2])
def test_what_is_no_sound_is_refused_and_opens_nothing(size: int) -> None:
    ears = Ears(None, (), Inbox(), lambda: 0.0)  # type: ignore[arg-type]
    with pytest.raises(MessageError, match=f"found {size} bytes"):
        ears.hear(bytes(size))
