"""Data trees as Grasshopper keeps them: lists in branches of a path, and how a component takes them apart."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

Path = tuple[int, ...]
ITEM, LIST, TREE = 0, 1, 2
FLATTEN, GRAFT = 1, 2


class Tree(dict[Path, list[Any]]):
    """Branches by their paths, sorted by path as Grasshopper sorts them: shorter index lists first where they agree."""

    @classmethod
    def of(cls, values: Iterable[Any], path: Path = (0,)) -> Tree:
        """All values in one branch; no branch for no values."""
        found = list(values)
        return cls({path: found}) if found else cls()

    @property
    def paths(self) -> list[Path]:
        """The paths in Grasshopper's order."""
        return sorted(self)

    def branches(self) -> list[tuple[Path, list[Any]]]:
        """Paths and branches in order."""
        return [(path, self[path]) for path in self.paths]

    def values_in_order(self) -> list[Any]:
        """All items, branch after branch."""
        return [value for path in self.paths for value in self[path]]

    def each(self, change: Callable[[Any], Any]) -> Tree:
        """The tree with each item changed by a function."""
        return Tree({path: [change(value) for value in values] for path, values in self.branches()})

    def add(self, path: Path, values: Iterable[Any]) -> None:
        """Append to a branch, which is made where there is none."""
        self.setdefault(path, []).extend(values)

    def take(self, other: Tree) -> None:
        """Append the branches of another tree: what an input does with a second wire."""
        for path, values in other.branches():
            self.add(path, values)


def modified(tree: Tree, mapping: int = 0, reverse: bool = False, simplify: bool = False) -> Tree:
    """A tree after the modifiers of a parameter: reverse, simplify, then flatten (1) or graft (2)."""
    found = Tree({path: list(reversed(values)) if reverse else list(values) for path, values in tree.branches()})
    if simplify:
        found = _simplified(found)
    if mapping == FLATTEN:
        return Tree.of(found.values_in_order())
    if mapping == GRAFT:
        return Tree({(*path, i): [value] for path, values in found.branches() for i, value in enumerate(values)})
    return found


def _simplified(tree: Tree) -> Tree:
    """Without the indices at the front that all paths share; one index stays."""
    paths = tree.paths
    shared = 0
    while paths and all(len(path) > shared + 1 and path[shared] == paths[0][shared] for path in paths):
        shared += 1
    if len(paths) == 1:
        return Tree({(0,): tree[paths[0]]})
    return Tree({path[shared:]: tree[path] for path in paths})


@dataclass(frozen=True)
class Run:
    """One run of a component: the path its results go to, the number of the run in this path, and a value an input.

    An input with list access gets a list, one with tree access the Tree, one without data None or an empty list;
    `lacking` are the numbers of those inputs.
    """

    path: Path
    number: int
    values: list[Any]
    lacking: frozenset[int] = frozenset()


def runs(inputs: Sequence[tuple[int, Tree]]) -> Iterator[Run]:
    """The runs of a component for inputs (access, tree), as Grasshopper matches data.

    Branches are matched by their order, the last one of a shorter tree repeats; in matched branches the items of
    inputs with item access are matched by the longest list, the last item repeats. Results go to the path of the
    input with the most branches, the first one of several. With no data to match there is one run at {0}.
    """
    matched = [tree for access, tree in inputs if access != TREE and tree]
    if not matched:
        lone = frozenset(i for i, (access, _) in enumerate(inputs) if access != TREE)
        yield Run((0,), 0, [_lone(access, tree) for access, tree in inputs], lone)
        return
    leading = max(matched, key=len)
    for i, path in enumerate(leading.paths):
        here = [_branch(tree, i) if access != TREE else [] for access, tree in inputs]
        lacking = frozenset(i for i, (access, _) in enumerate(inputs) if access != TREE and not here[i])
        lengths = [len(branch) for (access, _), branch in zip(inputs, here, strict=True) if access == ITEM and branch]
        for k in range(max(lengths, default=1)):
            values: list[Any] = []
            for (access, tree), branch in zip(inputs, here, strict=True):
                if access == TREE:
                    values.append(tree)
                elif access == LIST:
                    values.append(list(branch))
                else:
                    values.append(branch[min(k, len(branch) - 1)] if branch else None)
            yield Run(path, k, values, lacking)


def _branch(tree: Tree, i: int) -> list[Any]:
    paths = tree.paths
    return tree[paths[min(i, len(paths) - 1)]] if paths else []


def _lone(access: int, tree: Tree) -> Any:
    return tree if access == TREE else [] if access == LIST else None


def text_of(path: Path) -> str:
    """A path as Grasshopper writes it: {0;1}."""
    return "{" + ";".join(str(index) for index in path) + "}"


def path_of(text: str) -> Path:
    """A path from {0;1} or 0;1; raises ValueError."""
    return tuple(int(index) for index in text.strip("{} ").split(";"))
