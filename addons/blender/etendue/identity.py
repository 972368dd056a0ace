"""Which object and which material of Blender each node and each material of the file is, whatever they are called. Takes
objects that look like Blender's, and needs nothing of Blender itself."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain, count
from typing import Any

Document = dict[str, Any]
KEY = "etendue_number"  # a custom property, which the exporter writes as an extra


@contextmanager
def numbered(blocks: Sequence[Any]) -> Iterator[None]:
    """Gives each data-block a custom property with its number while this lasts."""
    try:
        for number, block in enumerate(blocks):
            block[KEY] = number
        yield
    finally:
        for block in blocks:
            if KEY in block.keys():
                del block[KEY]


def take_blocks(entries: Sequence[Document], blocks: Sequence[Any], by_name: bool = False) -> list[Any]:
    """Returns the data-block of each entry by its number and takes the numbers out. An entry without one has None, or, if
    asked for, the data-block that alone has its name: evaluated copies may be older than the numbers."""
    found = []
    for entry in entries:
        extras = entry.get("extras", {})
        number = extras.pop(KEY, None)
        called = [block for block in blocks if block.name == entry.get("name")] if by_name and number is None else []
        found.append(blocks[number] if number is not None else called[0] if len(called) == 1 else None)
        if "extras" in entry and not extras:
            del entry["extras"]
    return found


def unique_names(blocks: Sequence[Any]) -> dict[Any, str]:
    """Returns a name for each data-block: its own, or, where one that is not linked has it, that with its library."""
    names: dict[Any, str] = {}
    taken: set[str] = set()
    for block in sorted(dict.fromkeys(blocks), key=lambda block: block.library is not None):
        candidates = chain((block.name, block.name_full), (f"{block.name_full} {number}" for number in count(2)))
        names[block] = next(name for name in candidates if name not in taken)
        taken.add(names[block])
    return names


@dataclass
class Tree:
    """The nodes of the file: their objects, None for bones and the like; their parents; and the node that instances each,
    None for nodes that are their objects themselves."""

    objects: list[Any]
    parents: dict[int, int]
    instancers: list[int | None]

    def top_instancer(self, number: int) -> int | None:
        """Returns the outermost node in whose instance a node stands, None for none."""
        above = self.instancers[number]
        while above is not None and self.instancers[above] is not None:
            above = self.instancers[above]
        return above

    def pairs(self, numbers: Collection[int]) -> set[tuple[Any, Any]]:
        """Returns the pairs of the outermost instancer and the object of those of these nodes that are instances."""
        tops = {number: self.top_instancer(number) for number in numbers}
        return {(self.objects[top], self.objects[number]) for number, top in tops.items() if top is not None}

    def in_order(self) -> list[int]:
        """Returns the numbers of all nodes, parents before their children."""
        return sorted(range(len(self.objects)), key=lambda number: len(self.above(number)))

    def above(self, number: int) -> list[int]:
        """Returns the numbers of the nodes above one, the nearest first."""
        result = []
        while number in self.parents:
            number = self.parents[number]
            result.append(number)
        return result

    def own(self) -> dict[int, Any]:
        """Returns the objects of nodes that are no instances, by the number of the node."""
        return {number: item for number, item in enumerate(self.objects)
                if item is not None and self.instancers[number] is None}


def makes_instances_of_children(item: Any) -> bool:
    """Returns whether what hangs below the object is instanced on its vertices, faces or particles."""
    return item.is_instancer and item.instance_type != "COLLECTION"


def uses_nodes(item: Any) -> bool:
    """Returns whether geometry nodes make the object."""
    return any(modifier.type == "NODES" for modifier in item.modifiers)


def tree_of(nodes: Sequence[Document], objects: list[Any]) -> Tree:
    """Finds out which nodes are instances: those whose objects are no children of the object above."""
    tree = Tree(objects, {child: number for number, node in enumerate(nodes) for child in node.get("children", ())},
                [None] * len(nodes))
    for number in tree.in_order():
        above = tree.above(number)
        if not above:
            continue
        known = next((at for at in above if objects[at] is not None), None)
        own, parent = objects[number], objects[known] if known is not None else None
        if own is None or parent is None or (own.parent == parent and not makes_instances_of_children(parent)):
            tree.instancers[number] = tree.instancers[above[0]]
        else:
            tree.instancers[number] = known
    return tree


def rendered_nodes(tree: Tree, single: Collection[Any], instanced: Collection[tuple[Any, Any]]) -> set[int]:
    """Returns the nodes that are rendered: those of the objects `single`, and instances by their pairs of instancer and
    object. A node without an object goes with the one above."""
    shown: set[int] = set()
    for number in tree.in_order():
        item, top = tree.objects[number], tree.top_instancer(number)
        if item is None:
            rendered = tree.parents.get(number) in shown
        elif top is None:
            rendered = item in single
        else:
            rendered = (tree.objects[top], item) in instanced
        if rendered:
            shown.add(number)
    return shown
