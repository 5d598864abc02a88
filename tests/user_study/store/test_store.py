"""What the store keeps of a participant, and gives back."""

from __future__ import annotations

import hashlib
import re
import threading
from datetime import UTC, datetime

import pytest

from fetch_pomdp.core.action import Pick, Point, Wait
from fetch_pomdp.core.events import Acted
from fetch_pomdp.core.ports import Outcome
from fetch_pomdp.errors import StoreError
from fetch_pomdp.user_study.store.participants import LETTERS, code_of
from fetch_pomdp.user_study.store.store import Store
from tests.user_study.store.made import AGREED, PICKED, WAITED, enrolled, header, joined


def test_numbers_are_the_lowest_free_ones(store: Store) -> None:
    people = [joined(store) for _ in range(3)]
    assert [one.person for one in people] == [0, 1, 2]
    store.forget(people[1].code)
    assert joined(store).person == 1
    assert joined(store).person == 3
    with pytest.raises(StoreError, match="people: all 4 places of 'pilot' are taken"):
        joined(store)
    assert joined(store, "another").person == 0


def test_a_study_that_has_changed_is_another(store: Store) -> None:
    joined(store)
    with pytest.raises(StoreError, match=r"study: 'pilot' was begun with other contents \(d1, not d2\)"):
        enrolled(store, digest="d2")


def test_only_the_secret_leads_back(store: Store, url: str) -> None:
    someone, secret = enrolled(store)
    store.close()
    again = Store.open(url)
    assert again.returning("pilot", secret) == someone
    for wrong in ("", someone.code, secret[:-1], secret + "a", "\ud800"):
        assert again.returning("pilot", wrong) is None
    again.close()


def test_a_secret_of_one_study_leads_into_no_other(store: Store) -> None:
    (someone, secret), (other, another) = enrolled(store), enrolled(store, "another")
    assert store.returning("pilot", secret) == someone
    assert store.returning("another", another) == other
    assert store.returning("another", secret) is store.returning("pilot", another) is None


def test_who_is_taken_in_has_agreed_in_the_same_commit(store: Store, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Store, "_change", None)  # whatever would come after it
    someone, _ = enrolled(store)
    assert (someone.stage, someone.language, dict(someone.consent)) == ("instructions", "en", AGREED.given)
    (one,) = store.progress()
    assert one.consented == one.joined
    assert one.consent_text == hashlib.sha256(AGREED.text.encode()).hexdigest()


def test_codes_are_short_and_read_as_they_are_typed(store: Store) -> None:
    code = joined(store).code
    assert re.fullmatch(rf"[{LETTERS}]{{3}}-[{LETTERS}]{{3}}", code)
    assert code_of(code.lower().replace("-", " ")) == code
    assert store.forget(f" {code.lower()} ").code == code


def test_what_somebody_has_done_comes_back(store: Store) -> None:
    someone, secret = enrolled(store)
    assert (someone.stage, someone.answers) == ("instructions", {})
    store.advance(someone.id, "questions")
    store.answer(someone.id, "understood", "names, „löffel“, \x00 and '; DROP TABLE answers")
    store.answer(someone.id, "liked", 3)
    store.answer(someone.id, "liked", ["speed", "ease"])
    found = store.returning("pilot", secret)
    assert found is not None
    assert found.answers == {
        "understood": "names, „löffel“, \x00 and '; DROP TABLE answers", "liked": ["speed", "ease"],
    }  # fmt: skip
    assert (found.stage, found.completion) == ("questions", None)
    store.advance(someone.id, "done")
    done = store.returning("pilot", secret)
    assert done is not None
    assert done.completion is not None
    assert done.completion != done.code
    store.advance(someone.id, "done")
    assert store.returning("pilot", secret) == done, "the code at the end does not change"


@pytest.mark.parametrize("value", [float("nan"), object(), "\ud800", {1, 2}])
def test_an_answer_is_json(store: Store, value: object) -> None:
    someone, secret = enrolled(store)
    with pytest.raises(StoreError, match="ease: cannot be kept as JSON"):
        store.answer(someone.id, "ease", value)
    assert store.returning("pilot", secret) == someone


def test_stages_are_known_and_people_are_there(store: Store) -> None:
    with pytest.raises(StoreError, match="stage: found 'lunch', expected one of instructions, practice"):
        store.advance(joined(store).id, "lunch")
    with pytest.raises(StoreError, match="participant: the participant was deleted"):
        store.advance(999, "trials")
    with pytest.raises(StoreError, match="contradicts what is there"):
        store.trial(999, "trial", 0, header(0, 0))


def test_a_trial_is_gone_on_with_where_it_was(store: Store) -> None:
    someone = joined(store)
    first = store.trial(someone.id, "trial", 0, header(0, 0))
    assert (first.header, first.events, first.finished, first.given_up) == (header(0, 0), (), False, False)
    assert first.clock is None
    first.note_clock(7.25)
    first.write(WAITED)
    stopped = Acted(Pick(0), Outcome.STOPPED, time=2.0)
    first.write(stopped)
    first.close()
    again = store.trial(someone.id, "trial", 0, header(3, 3, "marker-1"))
    assert again.header == header(0, 0), "a trial keeps the header that it began with"
    assert (again.events, again.clock) == ((WAITED, stopped), 7.25)
    assert not again.finished
    again.write(PICKED)
    assert again.finished, "a pick that was done is the end"
    again.finish(given_up=True)
    assert not again.given_up, "what is over is not given up"
    over = store.trial(someone.id, "trial", 0, header(0, 0))
    assert (over.events, over.finished, over.given_up) == ((WAITED, stopped, PICKED), True, False)
    assert store.trial(someone.id, "practice", 0, header(0, 0)).events == (), "practice is counted by itself"


def test_progress_counts_trials_without_practice(store: Store) -> None:
    early, late = joined(store), joined(store)
    store.advance(early.id, "trials")
    for order in range(2):
        store.trial(early.id, "practice", order, header(0, order)).write(PICKED)
    over = store.trial(early.id, "trial", 0, header(0, 0))
    over.note_clock(0.0)
    over.write(PICKED)
    store.trial(early.id, "trial", 0, header(0, 0))  # over: nothing to go on with
    store.trial(early.id, "trial", 1, header(0, 1)).finish(given_up=True)
    left = store.trial(early.id, "trial", 2, header(0, 2))
    left.note_clock(0.0)  # its clock runs: to leave now is an interruption, though nothing has happened
    for _ in range(2):
        left = store.trial(early.id, "trial", 2, header(0, 2))
    store.trial(early.id, "trial", 3, header(0, 3))
    store.trial(early.id, "trial", 3, header(0, 3))  # its clock did not run yet: no interruption
    one, other = store.progress("pilot")
    assert (one.person, one.code, one.stage, one.language) == (0, early.code, "trials", "en")
    assert (one.trials_done, one.of, one.interruptions, one.given_up) == (2, 6, 2, 1)
    assert (other.person, other.code, other.trials_done, other.of) == (1, late.code, 0, 7)
    assert one.joined <= one.last <= datetime.now(UTC).strftime("%Y-%m-%dT%H:%M:%SZ")
    assert one.finished is one.completion is None
    assert store.progress() == (one, other)


def test_progress_of_several_studies(store: Store) -> None:
    assert store.progress() == ()
    joined(store, "b"), joined(store, "a")
    assert [one.study for one in store.progress()] == ["a", "b"]
    assert [one.study for one in store.progress("b")] == ["b"]
    assert store.progress("pilot") == ()


def test_two_who_write_one_trial_are_told(store: Store) -> None:
    someone = joined(store)
    one, other = (store.trial(someone.id, "trial", 0, header(0, 0)) for _ in range(2))
    one.write(WAITED)
    with pytest.raises(StoreError, match="contradicts what is there"):
        other.write(PICKED)
    assert other.events == ()
    assert store.trial(someone.id, "trial", 0, header(0, 0)).events == (WAITED,)


def test_a_journal_takes_events_from_many_threads(store: Store) -> None:
    trial = store.trial(joined(store).id, "trial", 0, header(0, 0))
    events = [Acted(Wait(), time=float(second)) for second in range(40)]
    writers = [threading.Thread(target=trial.write, args=(event,)) for event in events]
    for writer in writers:
        writer.start()
    for writer in writers:
        writer.join()
    found = store.trial(1, "trial", 0, header(0, 0)).events
    assert found == trial.events
    assert sorted(found, key=lambda event: event.time or 0.0) == events


def test_a_question_is_kept_with_its_item(store: Store) -> None:
    trial = store.trial(joined(store).id, "trial", 0, header(0, 0))
    trial.write(Acted(Point(4), Outcome.FAILED, time=3.25, passes=7))
    assert store.trial(1, "trial", 0, header(0, 0)).events == (Acted(Point(4), Outcome.FAILED, time=3.25, passes=7),)
