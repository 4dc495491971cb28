"""The order in which a program is printed: what the longest chain waits for comes first.

A processor sees about a hundred operations ahead. Written leg after leg, a mechanism shows it one chain of roots and
divisions at a time and it idles; written by height, it has the other legs to go on with.
"""

from __future__ import annotations

import heapq
from collections.abc import Iterable

from .graph import Node, order_of

#: Cycles until a result can be used, for what is not an addition or multiplication (Zen 4, Ice Lake: nearly alike).
_LATENCY = {"div": 13, "root": 21, "floor": 8, "loop": 200, "const": 0, "input": 0, "parameter": 0, "pick": 0}
_USUAL = 4


def scheduled(roots: Iterable[Node], done: Iterable[Node] = ()) -> list[Node]:
    """The same nodes as `order_of`, arguments first, for one operation a cycle: of those that can start, the highest.

    A node's height is the time from its start to the end of the program.
    """
    order = order_of(roots, done)
    users: dict[Node, list[Node]] = {node: [] for node in order}
    missing: dict[Node, int] = {}
    for node in order:
        inside = {a for a in node.args if a in users}
        missing[node] = len(inside)
        for a in inside:
            users[a].append(node)
    height: dict[Node, int] = {}
    for node in reversed(order):
        height[node] = _LATENCY.get(node.op, _USUAL) + max((height[u] for u in users[node]), default=0)
    rank = {node: (-height[node], k) for k, node in enumerate(order)}
    return _issued(order, users, missing, rank)


def _issued(
    order: list[Node], users: dict[Node, list[Node]], missing: dict[Node, int], rank: dict[Node, tuple[int, int]]
) -> list[Node]:
    """Start one node a cycle; `rank` decides among those whose arguments are there."""
    at = dict.fromkeys(order, 0)
    waiting = [(0, rank[node]) for node in order if not missing[node]]
    heapq.heapify(waiting)
    ready: list[tuple[int, int]] = []
    issued: list[Node] = []
    clock = 0
    while waiting or ready:
        if not ready:
            clock = max(clock, waiting[0][0])
        while waiting and waiting[0][0] <= clock:
            heapq.heappush(ready, heapq.heappop(waiting)[1])
        node = order[heapq.heappop(ready)[1]]
        issued.append(node)
        latency = _LATENCY.get(node.op, _USUAL)
        for user in users[node]:
            at[user] = max(at[user], clock + latency)
            missing[user] -= 1
            if not missing[user]:
                heapq.heappush(waiting, (at[user], rank[user]))
        clock += latency > 0
    return issued
