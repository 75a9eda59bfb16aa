"""Natives of the tab Sets: data trees. Inputs have tree access, so that each is one run with whole trees."""

from __future__ import annotations

from typing import Any

from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.trees import FLATTEN, GRAFT, Path, Tree, modified, text_of

_TREE = "Tree (T): any tree optional"
_MERGES = """86866576-6cc0-485a-9cd2-6f7d493f57f7 481f0339-1299-43ba-b15c-c07891a8f822
b5be5d1f-717f-493c-b958-816957f271fd f4b0f7b4-5a10-46c4-8191-58d7d66ffdff ac9b4faf-c9d5-4f6a-a5e9-58c0c2cac116
a70aa477-0109-4e75-ba73-78725dca0274 22f66ff6-d281-453c-bd8c-36ed24026783 0b6c5dac-6c93-4158-b8d1-ca3187d45f25"""


@native(f"3cadddef-1e2b-4c09-9390-0e8f78f7609f {_MERGES}", "Merge", "Merge",
        "Data 1 (D1): any tree optional ...", "Result (R): tree")  # fmt: skip
def merge(*streams: Tree) -> Tree:
    """All streams in one tree: branches of the same path are joined in the order of the inputs."""
    found = Tree()
    for stream in streams:
        found.take(stream)
    return found


@native("c9785b8e-2f30-4f90-8ee3-cca710f82402", "Entwine", "Entwine",
        "Branch {0;0} ({0;0}): any tree optional ...", "Result (R): tree", sees=True)  # fmt: skip
def entwine(*streams: Tree, node: Any) -> Tree:
    """Each stream flattened to a branch of its own, {0;0}, {0;1} ...; without Flatten Inputs the stream's number comes
    before its paths."""
    found = Tree()
    for number, stream in enumerate(streams):
        if node.container.value("FlattenInputs", default=True):
            found[0, number] = stream.values_in_order()
        else:
            for path, values in stream.branches():
                found[(number, *path)] = list(values)
    return found


@native("87e1d9ef-088b-4d30-9dda-8a7448a17329", "Graft Tree", "Graft", _TREE, "Tree (T): tree")
def graft_tree(tree: Tree) -> Tree:
    """A branch of its own for each item."""
    return modified(tree, GRAFT)


@native("f80cfe18-9510-4b89-8301-8e58faf423bb", "Flatten Tree", "Flatten",
        f"{_TREE}; Path (P): path tree optional", "Tree (T): tree")  # fmt: skip
def flatten_tree(tree: Tree, paths: Tree) -> Tree:
    """All items in one branch, {0} or the path given."""
    given = [path for path in paths.values_in_order() if path is not None]
    return Tree({tuple(given[0]) if given else (0,): modified(tree, FLATTEN).values_in_order()})


@native("1303da7b-e339-4e65-a051-82c4dce8224d", "Simplify Tree", "Simplify",
        f"{_TREE}; Front (F): boolean tree optional", "Tree (T): tree")  # fmt: skip
def simplify_tree(tree: Tree, front: Tree) -> Tree:
    """Paths without the indices that all of them share, with Front only those at their start; one branch stays."""
    paths = tree.paths
    if len(paths) < 2:
        return tree
    shared = [k for k in range(min(map(len, paths))) if len({path[k] for path in paths}) == 1]
    if any(front.values_in_order()):
        shared = [k for k in shared if k == shared.index(k)]
    if len(shared) == min(map(len, paths)):
        shared = shared[1:]
    return Tree({tuple(i for k, i in enumerate(path) if k not in shared): v for path, v in tree.branches()})


@native("071c3940-a12d-4b77-bb23-42b5d3314a0d", "Clean Tree", "Clean",
        "Remove Nulls (N): boolean tree optional; Remove Invalid (X): boolean tree optional; "
        f"Remove Empty (E): boolean tree optional; {_TREE}", "Tree (T): tree")  # fmt: skip
def clean_tree(nulls: Tree, invalid: Tree, empty: Tree, tree: Tree) -> Tree:
    """A tree without nulls, without invalid geometry and without empty branches, each where it is True."""
    return _cleaned(tree, *(any(flag.values_in_order()) for flag in (nulls, invalid, empty)))


@native("7991bc5f-8a01-4768-bfb0-a39357ac6b84", "Clean Tree", "Clean",
        f"{_TREE}; Clean Invalid (X): boolean tree optional; Clean Empty (E): boolean tree optional",
        "Tree (T): tree")  # fmt: skip
def clean_tree_before(tree: Tree, invalid: Tree, empty: Tree) -> Tree:
    """A tree without nulls, and without invalid geometry and empty branches where these are True."""
    return _cleaned(tree, True, *(any(flag.values_in_order()) for flag in (invalid, empty)))


def _cleaned(tree: Tree, nulls: bool, invalid: bool, empty: bool) -> Tree:
    found = Tree()
    for path, values in tree.branches():
        kept = [v for v in values if not (nulls and v is None or invalid and getattr(v, "IsValid", True) is False)]
        if kept or not empty:
            found[path] = kept
    return found


@native("74cad441-2264-45fe-a57d-85034751208a", "Explode Tree", "BANG!",
        "Data (D): any tree optional", "Branch 0 (-): tree ...", sees=True)  # fmt: skip
def explode_tree(tree: Tree, node: Any) -> tuple[Tree, ...]:
    """Each branch at an output of its own, with its path."""
    branches = tree.branches()
    parts = [Tree({path: list(values)}) for path, values in branches]
    return tuple(parts[i] if i < len(parts) else Tree() for i in range(len(node.outputs)))


@native("41aa4112-9c9b-42f4-847e-503b9d90e4c7", "Flip Matrix", "Flip", "Data (D): any tree optional", "Data (D): tree")
def flip_matrix(tree: Tree) -> Tree:
    """Rows become columns: branch i has item i of every branch, null where a branch is shorter."""
    branches = [values for _, values in tree.branches()]
    count = max(map(len, branches), default=0)
    return Tree({(i,): [values[i] if i < len(values) else None for values in branches] for i in range(count)})


@native("3a710c1e-1809-4e19-8c15-82adce31cd62", "Tree Branch", "Branch",
        f"{_TREE}; Path (P): path tree", "Branch (B): tree")  # fmt: skip
def tree_branch(tree: Tree, paths: Tree) -> Tree:
    """The branch of a path, with that path; of several paths, each of them."""
    found = Tree()
    for path in paths.values_in_order():
        if path not in tree:
            raise Unfit(f"Path {text_of(path)} does not exist in the tree")
        found[path] = list(tree[path])
    return found


@native("c1ec65a3-bda4-4fad-87d0-edf86ed9d81c", "Tree Item", "Item",
        f"{_TREE}; Path (P): path tree; Index (i): integer tree; Wrap (W): boolean tree",
        "Element (E): tree")  # fmt: skip
def tree_item(tree: Tree, paths: Tree, indices: Tree, wraps: Tree) -> Tree:
    """The item at an index of a branch; null outside, unless indices wrap."""
    wrap = any(wraps.values_in_order())
    given, places = paths.values_in_order(), indices.values_in_order()
    found = []
    for i in range(max(len(given), len(places))):
        path, index = given[min(i, len(given) - 1)], places[min(i, len(places) - 1)]
        values = tree.get(path, [])
        inside = bool(values) and (wrap or 0 <= index < len(values))
        found.append(values[index % len(values)] if inside else None)
    return Tree({(0,): found})


@native("99bee19d-588c-41a0-b9b9-1d00fb03ea1a", "Tree Statistics", "TStat",
        _TREE, "Paths (P): tree; Length (L): tree; Count (C): tree")  # fmt: skip
def tree_statistics(tree: Tree) -> tuple[Tree, Tree, Tree]:
    """All paths, the number of items in each branch, and how many branches there are."""
    paths = tree.paths
    return Tree.of(paths), Tree.of(len(tree[path]) for path in paths), Tree.of([len(paths)])


@native("b8e2aa8f-8830-4ee1-bb59-613ea279c281", "Unflatten Tree", "Unflatten",
        f"{_TREE}; Guide (G): any tree optional", "Tree (T): tree")  # fmt: skip
def unflatten_tree(tree: Tree, guide: Tree) -> Tree:
    """The items in their order, in branches with the paths and lengths of a guide."""
    rest = tree.values_in_order()
    found = Tree()
    for path, values in guide.branches():
        found[path], rest = rest[: len(values)], rest[len(values) :]
    return found


@native("1177d6ee-3993-4226-9558-52b7fd63e1e3", "Trim Tree", "Trim",
        f"{_TREE}; Depth (D): integer tree", "Tree (T): tree")  # fmt: skip
def trim_tree(tree: Tree, depths: Tree) -> Tree:
    """Branches joined whose paths agree without their last indices, as many as Depth; one index stays."""
    depth = max((one for one in depths.values_in_order() if one is not None), default=1)
    found = Tree()
    for path, values in tree.branches():
        found.add(path[: max(len(path) - depth, 1)], values)
    return found


@native("2d61f4e0-47c5-41d6-a41d-6afa96ee63af", "Shift Paths", "PShift",
        "Data (D): any tree optional; Offset (O): integer tree", "Data (D): tree")  # fmt: skip
def shift_paths(tree: Tree, offsets: Tree) -> Tree:
    """Paths without their first indices, or with a negative offset without their last ones; equal paths are joined."""
    offset = next((one for one in offsets.values_in_order() if one is not None), 0)
    found = Tree()
    for path, values in tree.branches():
        short: Path = path[offset:] if offset >= 0 else path[:offset]
        if short:
            found.add(short, values)
    return found


@native("fe769f85-8900-45dd-ba11-ec9cd6c778c6", "Prune Tree", "Prune",
        f"{_TREE}; Minimum (N0): integer tree; Maximum (N1): integer tree", "Tree (T): tree")  # fmt: skip
def prune_tree(tree: Tree, least: Tree, most: Tree) -> Tree:
    """Without branches that have fewer or more items than allowed; a maximum of 0 is no limit."""
    low, high = (next(iter(one.values_in_order()), 0) or 0 for one in (least, most))
    return Tree({p: v for p, v in tree.branches() if len(v) >= low and (not high or len(v) <= high)})


@native("eeafc956-268e-461d-8e73-ee05c6f72c01", "Stream Filter", "Filter",
        "Gate (G): integer tree; Stream 0 (0): any tree optional ...", "Stream (S): tree")  # fmt: skip
def stream_filter(gates: Tree, *streams: Tree) -> Tree:
    """The stream whose number is the gate."""
    gate = next(iter(gates.values_in_order()), None)
    if gate is None or gate not in range(len(streams)):
        raise Unfit(f"Gate {gate} is not the number of a stream")
    chosen: Tree = streams[gate]
    return chosen


@native("71fcc052-6add-4d70-8d97-cfb37ea9d169", "Stream Gate", "Gate",
        "Stream (S): any tree optional; Gate (G): integer tree", "Target 0 (0): tree; Target 1 (1): tree ...",
        sees=True)  # fmt: skip
def stream_gate(stream: Tree, gates: Tree, node: Any) -> tuple[Tree, ...]:
    """The stream at the output whose number is the gate; the others have no data."""
    gate = next(iter(gates.values_in_order()), None)
    return tuple(stream if i == gate else Tree() for i in range(len(node.outputs)))


@native("65283518-ad00-49d3-87fb-f76823ebb162", "Data Dam", "Dam",
        "Data A (A): any tree optional ...", "Data A (A): tree ...")  # fmt: skip
def data_dam(*streams: Tree) -> tuple[Tree, ...]:
    """Data as it comes; nothing is delayed, since a run waits for everything."""
    return streams


@native("946cb61e-18d2-45e3-8840-67b0efa26528", "Construct Path", "Path", "Indices (I): integer list", "Branch (B)")
def construct_path(indices: list[int]) -> Path:
    """A path of whole numbers."""
    return tuple(indices)


@native("df6d9197-9a6e-41a2-9c9d-d2221accb49e", "Deconstruct Path", "DPath", "Branch (B): path", "Indices (I): list")
def deconstruct_path(path: Path) -> list[int]:
    """The whole numbers of a path."""
    return list(path)
