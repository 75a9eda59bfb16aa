"""Natives of the tab Sets that match, split and renumber data trees by patterns of paths."""

from __future__ import annotations

import re

from hookean_canvas.run.natives.declare import Unfit, native
from hookean_canvas.run.trees import Path, Tree


def matches(path: Path, mask: str) -> bool:
    """Whether a path has a pattern as {0;?;*}: ? is any index, * any further ones; {!0;1} is any but that, and an index
    may be several, (0,1,2), or a range, (0 to 4).

    Unfit for another pattern.
    """
    text = mask.strip()
    turned = text.startswith(("!", "{!"))
    body = text.replace("!", "", 1) if turned else text
    parts = [part.strip() for part in body.strip().removeprefix("{").removesuffix("}").split(";")]
    return _fits(list(path), parts) != turned


def _fits(path: list[int], parts: list[str]) -> bool:
    if not parts or parts == [""]:
        return not path
    if parts[0] == "*":
        return any(_fits(path[i:], parts[1:]) for i in range(len(path) + 1))
    return bool(path) and _index(path[0], parts[0]) and _fits(path[1:], parts[1:])


def _index(index: int, part: str) -> bool:
    if part == "?":
        return True
    inner = part.removeprefix("(").removesuffix(")").strip()
    found = re.fullmatch(r"(-?\d+)\s+to\s+(-?\d+)", inner)
    if found:
        return int(found[1]) <= index <= int(found[2])
    try:
        compared = re.fullmatch(r"([<>]=?)\s*(-?\d+)", inner)
        if compared:
            other = int(compared[2])
            return {"<": index < other, "<=": index <= other, ">": index > other, ">=": index >= other}[compared[1]]
        return index in [int(one) for one in inner.split(",")]
    except ValueError:
        raise Unfit(f"{part} is no index, ?, * or range") from None


@native("1d8b0e2c-e772-4fa9-b7f7-b158251b34b8", "Path Compare", "Compare", "Path (P): path; Mask (M): text",
        "Comparison (C)")  # fmt: skip
def path_compare(path: Path, mask: str) -> bool:
    """Whether a path has a pattern such as {0;?;*}."""
    return matches(path, mask)


@native("d8b1e7ac-cd31-4748-b262-e07e53068afc", "Split Tree", "Split",
        "Data (D): any tree; Masks (M): text tree", "Positive (P): tree; Negative (N): tree")  # fmt: skip
def split_tree(tree: Tree, masks: Tree) -> tuple[Tree, Tree]:
    """The branches whose paths have one of some patterns, and the others."""
    found = Tree(), Tree()
    patterns = [mask for mask in masks.values_in_order() if mask is not None]
    for path, values in tree.branches():
        found[0 if any(matches(path, mask) for mask in patterns) else 1].add(path, values)
    return found


@native("bfaaf799-77dc-4f31-9ad8-2f7d1a80aeb0", "Replace Paths", "Replace",
        "Data (D): any tree; Search (S): text tree; Replace (R): path tree", "Data (D): tree")  # fmt: skip
def replace_paths(tree: Tree, masks: Tree, paths: Tree) -> Tree:
    """A tree with other paths in the place of those that have a pattern, the first one that fits."""
    pairs = list(zip(masks.values_in_order(), paths.values_in_order(), strict=False))
    found = Tree()
    for path, values in tree.branches():
        found.add(next((new for mask, new in pairs if matches(path, mask)), path), values)
    return found


@native("46372d0d-82dc-4acb-adc3-25d1fde04c4e", "Match Tree", "Match", "Tree (T): any tree; Guide (G): any tree",
        "Tree (T): tree")  # fmt: skip
def match_tree(tree: Tree, guide: Tree) -> Tree:
    """A tree with the paths of another that has as many branches."""
    if len(tree) != len(guide):
        raise Unfit(f"Tree has {len(tree)} branches, and Guide {len(guide)}; they must have as many")
    return Tree({path: values for path, (_, values) in zip(guide.paths, tree.branches(), strict=True)})


def _offset(text: str) -> tuple[Path, int]:
    """The shifts of a path and of an item in a text such as {0;1}(1)."""
    found = re.fullmatch(r"\s*\{([^{}]*)\}\s*[\[(]\s*([+-]?\d+)\s*[\])]\s*", text)
    try:
        if found is None:
            raise ValueError
        return tuple(int(part) for part in found[1].split(";") if part.strip()), int(found[2])
    except ValueError:
        raise Unfit(f"{text!r} is no offset; write one such as {{0;1}}(1)") from None


@native("fac0d5be-e3ff-4bbb-9742-ec9a54900d41", "Relative Item", "RelItem",
        "Tree (T): any tree; Offset (O): text tree; Wrap Paths (Wp): boolean tree optional; "
        "Wrap Items (Wi): boolean tree optional", "Item A (A): tree; Item B (B): tree")  # fmt: skip
def relative_item(tree: Tree, offset: Tree, paths: Tree, items: Tree) -> tuple[Tree, Tree]:
    """Each item of a tree with the one at an offset of its path and number."""
    found: tuple[Tree, Tree] = relative_items(tree, tree, offset, paths, items)
    return found


@native("2653b135-4df1-4a6b-820c-55e2ad3bc1e0", "Relative Items", "RelItem2",
        "Tree A (A): any tree; Tree B (B): any tree; Offset (O): text tree; "
        "Wrap Paths (Wp): boolean tree optional; Wrap Items (Wi): boolean tree optional",
        "Item A (A): tree; Item B (B): tree")  # fmt: skip
def relative_items(first: Tree, second: Tree, offset: Tree, paths: Tree, items: Tree) -> tuple[Tree, Tree]:
    """Each item of a tree with the one of another at an offset of its path and number, where there is one."""
    texts = offset.values_in_order()
    shift, step = _offset(str(texts[0])) if texts else ((), 0)
    wrap_paths, wrap_items = (any(one.values_in_order()) for one in (paths, items))
    most = [1 + max(path[k] for path in second if len(path) > k) for k in range(max(map(len, second), default=0))]
    found = Tree(), Tree()
    for path, values in first.branches():
        moved = [index + by for index, by in zip(path, (*shift, *[0] * len(path)), strict=False)]
        if wrap_paths:
            moved = [index % most[k] if k < len(most) else index for k, index in enumerate(moved)]
        others = second.get(tuple(moved))
        for i, value in enumerate(values if others else ()):
            j = (i + step) % len(others or ()) if wrap_items else i + step
            if others is not None and 0 <= j < len(others):
                found[0].add(path, [value])
                found[1].add(path, [others[j]])
    return found
