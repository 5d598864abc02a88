"""The best a clairvoyant does on one scenario, penalised for what they foresee; compiled.

A scenario fixes the desired item, the base words and pointing of every step, and the noise of every step's answer. The
search goes step by step. A layer holds the nodes that action sequences lead to: a belief, i_r and the sum S of the
deltas on the way. Sequences that lead to the same answers lead to the same node, and the larger S counts: what follows
is the same for both. Why nodes may be closed, and how, is told in `bounding.bounds`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from fetch_pomdp.core.bounding.oracle import Oracle, ceiling
from fetch_pomdp.core.compiled import GOLDEN, Integers, RandomState, Vector, compiled, inlined, lean, mixed, uniform
from fetch_pomdp.core.planners.fitted.ahead import Lookahead, Pass, Root, one_pass
from fetch_pomdp.core.planners.fitted.table import ValueTable, kind_of, node_value, pair_class
from fetch_pomdp.core.planners.kernels import (
    ASKED,
    NOBODY,
    WAITED,
    Turn,
    answered,
    hear,
    largest,
    leading,
    normalise,
    pick_value,
    select_answer,
    smoothed_mass,
    turn_of,
)
from fetch_pomdp.core.problem import Tables
from fetch_pomdp.core.simulation import MOST_STEPS
from fetch_pomdp.core.turns import NO, YES

TIE = 1e-9  # points by which C may seem above a pick it equals
EQUAL = 1e-12  # difference of beliefs that only rounding makes


class Relaxation(NamedTuple):
    """What is fixed before any scenario is drawn."""

    ahead: Lookahead  # the control V^, and the outlooks that estimate E V^
    oracle: Oracle  # the supersolution C
    alike: Integers  # (n,), the first item with the same words and direction
    tau: float  # a node that can end at no more is closed
    most_nodes: int  # beyond which a pilot scenario is left, or 0 for none


class Scenario(NamedTuple):
    """All that is fixed for the clairvoyant, step by step."""

    desired: int
    evidence: Vector  # (MOST_STEPS, n), likelihood of a step's words and pointing, up to a factor
    speaks: Vector  # (MOST_STEPS,), uniform: selects whether an answer comes
    means: Vector  # (MOST_STEPS,), uniform: selects whether it is true
    seeds: RandomState  # (MOST_STEPS,), of the outlooks of a step's nodes, which share them


class Layer(NamedTuple):
    """The nodes that sequences of as many actions lead to."""

    beliefs: Vector  # (k, n)
    asked: Integers  # (k,), i_r or NOBODY
    keys: RandomState  # (k,), as of `Children`
    sums: Vector  # (k,), S


class Children(NamedTuple):
    """Nodes of the next layer, each with the node and the action that led to it."""

    parents: Integers
    asked: Integers
    answers: Integers
    keys: RandomState  # a number for the answers so far and i_r
    sums: Vector  # S


@compiled
def drawn_scenario(seed: int, tables: Tables) -> Scenario:
    """Draw a scenario: the desired item from the uniform belief, the rest from the model."""
    count = len(tables.smoothing)
    state = np.empty(1, dtype=np.uint64)
    state[0] = seed
    flat, evidence = np.full(count, 1.0 / count), np.empty((MOST_STEPS, count))
    speaks, means, seeds = np.empty(MOST_STEPS), np.empty(MOST_STEPS), np.empty(MOST_STEPS, dtype=np.uint64)
    smoothed = smoothed_mass(flat, tables)
    desired = int(uniform(state) * count)
    for step in range(MOST_STEPS):
        hear(
            flat, smoothed, desired, Turn(NOBODY, 0, WAITED), evidence[step], state, tables
        )  # from a flat belief: the likelihood
        speaks[step], means[step] = uniform(state), uniform(state)
        seeds[step] = np.uint64(uniform(state) * 2.0**53)
    return Scenario(desired, evidence, speaks, means, seeds)


@lean
def control(belief: Vector, asked: int, table: ValueTable, tables: Tables) -> float:
    """Return V^(b, i_r)."""
    top = leading(belief)
    share = belief[asked] / top.b2 if asked != NOBODY and top.b2 > 0.0 else 0.0
    cls = pair_class(top.first, top.second, table.breaks, tables)
    kind = kind_of(asked, top.first, top.second)
    return float(node_value(table, cls, top.b1, top.b2, kind, share, tables))


@compiled
def relaxed(seeds: RandomState, fixed: Relaxation, results: Vector, nodes: Integers) -> None:
    """Fill in, for the scenario of each seed, the clairvoyant's largest sum of deltas and how many nodes that took."""
    for index in range(len(seeds)):
        scenario = drawn_scenario(seeds[index], fixed.ahead.tables)
        results[index], nodes[index] = foreseen(scenario, fixed)


@compiled
def foreseen(scenario: Scenario, fixed: Relaxation) -> tuple[float, int]:
    """Return the largest sum of deltas over all sequences of actions, and how many nodes were expanded.

    No less than tau: see `bounding.bounds`.
    """
    count = scenario.evidence.shape[1]
    flat, start = np.full((1, count), 1.0 / count), np.zeros(1, dtype=np.uint64)
    layer = Layer(flat, np.full(1, NOBODY), start, np.zeros(1))
    best, expanded = fixed.tau, 0
    for step in range(MOST_STEPS + 1):
        now, found = opened(layer, step, fixed)
        best = max(best, found)
        expanded += len(now)
        if len(now) == 0 or (fixed.most_nodes > 0 and expanded > fixed.most_nodes):
            break
        before = Layer(layer.beliefs[now], layer.asked[now], layer.keys[now], layer.sums[now])
        children = acted(before, scenario, step, fixed)
        layer = seen(before.beliefs, children, scenario.evidence[step], fixed.ahead.tables)
    return best, expanded


@compiled
def opened(layer: Layer, step: int, fixed: Relaxation) -> tuple[Integers, float]:
    """Return the nodes of a layer to expand, and the best sum that a pick or a closed node ends at."""
    tables = fixed.ahead.tables
    nodes, count, best = np.empty(len(layer.beliefs), dtype=np.int64), 0, -np.inf
    for node in range(len(layer.beliefs)):
        belief, asked = layer.beliefs[node], layer.asked[node]
        pick = pick_value(largest(belief), tables)
        sofar = layer.sums[node] - control(belief, asked, fixed.ahead.table, tables)
        most = ceiling(belief, asked, fixed.oracle, tables)
        best = max(best, sofar + pick)
        if sofar + most <= fixed.tau:
            continue
        if step == MOST_STEPS or most <= pick + TIE:
            best = max(best, sofar + most)
            continue
        nodes[count] = node
        count += 1
    return nodes[:count], best


@compiled
def acted(layer: Layer, scenario: Scenario, step: int, fixed: Relaxation) -> Children:
    """Return the nodes after a wait and after every question in every node of a layer."""
    count, tables = scenario.evidence.shape[1], fixed.ahead.tables
    size = len(layer.beliefs) * (count + 1)
    whole = np.empty((3, size), dtype=np.int64)
    children = Children(whole[0], whole[1], whole[2], np.empty(size, dtype=np.uint64), np.empty(size))
    memory, state, made = np.empty((5, count + 1)), np.empty(1, dtype=np.uint64), 0
    places = np.empty(count, dtype=np.int64)
    for node in range(len(layer.beliefs)):
        belief, before, key = layer.beliefs[node], layer.asked[node], layer.keys[node]
        state[0] = scenario.seeds[step]
        asks = places[: worth_asking(belief, before, fixed.alike, places)]
        expected = memory[0, : len(asks) + 1]
        one_pass(
            Root(belief, before, 0),
            asks,
            fixed.ahead,
            Pass(expected, memory[1], memory[2], memory[3], memory[4, :count]),
            state,
        )
        sofar = layer.sums[node] - control(belief, before, fixed.ahead.table, tables)
        for action in range(len(expected)):
            asking = action < len(asks)
            turn = turn_of(before, 0, asks[action] if asking else NOBODY)
            answer = select_answer(scenario.desired, turn, scenario.speaks[step], scenario.means[step], tables)
            children.parents[made], children.asked[made], children.answers[made] = node, turn.about, answer
            children.keys[made] = key_after(key, before, turn.about, answer)
            children.sums[made] = sofar + (tables.point if asking else tables.wait) + expected[action]
            made += 1
    return Children(
        children.parents[:made], children.asked[:made], children.answers[:made], children.keys[:made],
        children.sums[:made],
    )  # fmt: skip


@compiled
def seen(before: Vector, children: Children, evidence: Vector, tables: Tables) -> Layer:
    """Return the layer of children after a step's words and pointing: of those that are one node the largest S."""
    kept = merged(children)
    beliefs = np.empty((len(kept), before.shape[1]))
    for index in range(len(kept)):
        child = kept[index]
        heard = before[children.parents[child]] * evidence
        normalise(heard)
        # The rate changes the answer's chance, not the belief.
        answered(heard, Turn(children.asked[child], 0, ASKED), children.answers[child], beliefs[index], tables)
    return Layer(beliefs, children.asked[kept], children.keys[kept], children.sums[kept])


@lean
def worth_asking(belief: Vector, asked: int, alike: Integers, asks: Integers) -> int:
    """Fill in the items that a best policy may need to ask about; return how many."""
    count = 0
    for item in range(len(belief)):
        if not repeated(item, belief, asked, alike):
            asks[count] = item
            count += 1
    return count


@inlined
def repeated(item: int, belief: Vector, asked: int, alike: Integers) -> bool:
    """Whether an earlier item is equal in all respects, so that asking about that one is as good for any policy."""
    if item == asked or alike[item] == item:
        return False
    for other in range(alike[item], item):
        if alike[other] == alike[item] and other != asked and abs(belief[other] - belief[item]) <= EQUAL:
            return True
    return False


@inlined
def scrambled(number: int) -> Any:
    """Return 64 bits that look random, of a number from -2: SplitMix64."""
    return mixed(np.uint64(number + 2) * np.uint64(GOLDEN))


@inlined
def key_after(key: Any, before: int, about: int, answer: int) -> Any:
    """Return a node's key, 64 bits: a sum over answers, so that their order does not matter, and i_r."""
    key += scrambled(2 * about + 1) - scrambled(2 * before + 1)
    if answer == YES:
        key += scrambled(2 * about)
    elif answer == NO:
        key -= scrambled(2 * about)
    return key


@compiled
def merged(children: Children) -> Integers:
    """Return the children with the largest S of those that are the same node."""
    order = np.argsort(children.keys)
    kept, count = np.empty(len(order), dtype=np.int64), 0
    for index in order:
        if count > 0 and children.keys[kept[count - 1]] == children.keys[index]:
            if children.sums[index] > children.sums[kept[count - 1]]:
                kept[count - 1] = index
            continue
        kept[count] = index
        count += 1
    return kept[:count]
