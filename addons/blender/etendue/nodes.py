"""Reads trees of nodes: through reroutes, muted nodes and groups, and what is constant in them. Needs nothing of Blender."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

LUMINANCE = (0.2126, 0.7152, 0.0722)
VERTICES = ("VERTEX_COLOR", "ATTRIBUTE")  # nodes of what vertices have


@dataclass(frozen=True)
class Seen:
    """Holds a node, the output of it that was followed, and the groups around it, the innermost last."""

    node: Any
    output: Any = None
    groups: tuple[Any, ...] = ()

    @property
    def type(self) -> str:
        return self.node.type

    @property
    def name(self) -> str:
        return self.node.name

    def socket(self, *names: str | int) -> Any:
        """Returns the first input with one of these names, which differ between Blender's versions, or with a number."""
        for name in names:
            found = self.node.inputs[name] if isinstance(name, int) else self.node.inputs.get(name)
            if found is not None:
                return found
        return None

    def source(self, *names: str | int) -> Seen | None:
        """Returns the node that is linked to an input."""
        return self.source_of(self.socket(*names))

    def source_of(self, socket: Any) -> Seen | None:
        return follow(socket, self.groups)[0]

    def sources(self) -> Iterator[tuple[str, Seen]]:
        """Yields all nodes that are linked to inputs, with the inputs' names."""
        for socket in self.node.inputs:
            found = self.source_of(socket)
            if found is not None:
                yield socket.name, found

    def is_linked(self, *names: str | int) -> bool:
        return link_to(self.socket(*names)) is not None

    def value(self, *names: str | int, default: Any = None) -> Any:
        """Returns the constant that an input has, three numbers for a colour; None where it has none, `default` where there
        is no such input."""
        socket = self.socket(*names)
        return default if socket is None else self.value_of(socket)

    def value_of(self, socket: Any) -> Any:
        """Returns the constant that an input of the node has."""
        found, end = follow(socket, self.groups)
        if found is not None:
            return fitted(found.constant(), socket)
        return None if end is None else fitted(plain(end.default_value), socket)

    def constant(self) -> Any:
        """Returns the constant that comes out of the node, None if none does."""
        if self.type in ("RGB", "VALUE"):
            return plain(self.node.outputs[0].default_value)
        if self.type == "BLACKBODY":
            kelvin = self.value(0)
            return None if kelvin is None else blackbody(kelvin)
        if self.type == "MATH" and self.node.operation in OPERATIONS:
            numbers = [self.value(0), self.value(1)]
            return None if None in numbers else OPERATIONS[self.node.operation](*numbers)
        return None


OPERATIONS = {"ADD": lambda a, b: a + b, "SUBTRACT": lambda a, b: a - b, "MULTIPLY": lambda a, b: a * b,
              "DIVIDE": lambda a, b: a / b if b else 0.0}


def plain(value: Any) -> Any:
    return list(value)[:3] if hasattr(value, "__len__") else value


def fitted(value: Any, socket: Any) -> Any:
    """Makes a colour of a number or a number of a colour, as the input wants it."""
    wide = hasattr(socket.default_value, "__len__")
    if isinstance(value, list) and not wide:
        return sum(share * channel for share, channel in zip(LUMINANCE, value))
    return [value] * 3 if wide and isinstance(value, (int, float)) else value


def link_to(socket: Any) -> Any:
    """Returns the link that counts, None if none does: muted ones and circles do not."""
    if socket is None or not socket.is_linked:
        return None
    return next((link for link in socket.links if getattr(link, "is_valid", True) and not getattr(link, "is_muted", False)), None)


def follow(socket: Any, groups: tuple[Any, ...]) -> tuple[Seen | None, Any]:
    """Returns the node that feeds an input; or None and the input that has the value, which is None if nothing has."""
    while (link := link_to(socket)) is not None:
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif getattr(node, "mute", False):
            socket = next((link.from_socket for link in node.internal_links if link.to_socket == output), None)
        elif node.type == "GROUP" and node.node_tree is not None:
            inner = active_output(node.node_tree, "GROUP_OUTPUT")
            socket, groups = counterpart(inner, output), (*groups, node)
        elif node.type == "GROUP_INPUT" and groups:
            socket, groups = counterpart(groups[-1], output), groups[:-1]
        else:
            return Seen(node, output, groups), None
    return None, socket


def counterpart(node: Any, output: Any) -> Any:
    """Returns the input of a group, or of its output node, that belongs to an output on the other side."""
    return next((socket for socket in node.inputs if socket.identifier == output.identifier), None) if node is not None else None


def active_output(tree: Any, kind: str) -> Any:
    """Returns the output node that Cycles takes: one of its own before one for all, the active one before others."""
    for target in ("CYCLES", "ALL"):
        outputs = [node for node in tree.nodes if node.type == kind and getattr(node, "target", "ALL") == target]
        if outputs:
            return next((node for node in outputs if node.is_active_output), outputs[0])
    return None


def behind(seen: Seen | None, *kinds: str) -> Seen | None:
    """Returns the nearest node of one of these kinds that a node's colour comes from."""
    waiting, known = [seen] if seen is not None else [], set()
    while waiting:
        found = waiting.pop(0)
        if found.type in kinds:
            return found
        if place(found) not in known:
            known.add(place(found))
            waiting += [source for name, source in found.sources() if name != "Vector"]
    return None


def place(seen: Seen) -> tuple[str, ...]:
    """Returns what tells a node from all others of a tree."""
    return (*(group.name for group in seen.groups), seen.name)


def places(tree: Any, with_groups: bool, groups: tuple[str, ...] = ()) -> Iterator[tuple[str, ...]]:
    """Yields the places of all nodes of a tree in their order, those of groups last."""
    yield from ((*groups, node.name) for node in tree.nodes)
    if with_groups:
        for node in tree.nodes:
            if node.type == "GROUP" and node.node_tree is not None:
                yield from places(node.node_tree, True, (*groups, node.name))


def blackbody(kelvin: float) -> list[float]:
    """Returns the colour of a black body in linear Rec.709, of a luminance of 1 as in Cycles."""
    xyz = [0.0, 0.0, 0.0]
    for nanometres in range(380, 781, 5):
        power = nanometres ** -5.0 / math.expm1(1.438777e7 / (nanometres * max(kelvin, 800.0)))
        for index, value in enumerate(observer(nanometres)):
            xyz[index] += power * value
    x, y, z = (value / xyz[1] for value in xyz)
    return [max(channel, 0.0) for channel in (3.2406 * x - 1.5372 * y - 0.4986 * z, -0.9689 * x + 1.8758 * y + 0.0415 * z,
                                              0.0557 * x - 0.2040 * y + 1.0570 * z)]


def observer(nanometres: float) -> tuple[float, float, float]:
    """Returns the CIE's matching functions of 1931 (Wyman, Sloan and Shirley, JCGT 2(2), 2013)."""
    def lobe(top: float, centre: float, left: float, right: float) -> float:
        return top * math.exp(-0.5 * ((nanometres - centre) * (left if nanometres < centre else right)) ** 2)

    return (lobe(0.362, 442.0, 0.0624, 0.0374) + lobe(1.056, 599.8, 0.0264, 0.0323) + lobe(-0.065, 501.1, 0.0490, 0.0382),
            lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
            lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725))
