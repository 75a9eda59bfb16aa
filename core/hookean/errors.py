"""The one error a person can cause: bad input, in one sentence with its place."""

from __future__ import annotations

from collections.abc import Sequence


class InputError(ValueError):
    """Bad input: where it is, what was given, what is allowed, what to do.

    `pointer` is a JSON pointer into the scene (`/forces/3/lines/17`) or the name of a file or option; `sentence` has
    the rest. `str(error)` reads as one line. `faults` has each fault as an error of its own, where there are several.
    """

    def __init__(self, pointer: str, sentence: str, faults: Sequence[InputError] = ()) -> None:
        super().__init__(f"{pointer}: {sentence}" if pointer else sentence)
        self.pointer = pointer
        self.sentence = sentence
        self._faults = tuple(faults)

    @property
    def faults(self) -> tuple[InputError, ...]:
        """All faults, the first one first; of a single fault the error itself."""
        return self._faults or (self,)


def several(faults: Sequence[InputError]) -> InputError:
    """The first of one or more faults as one error; its sentence has how many more there are."""
    first, *more = faults
    if not more:
        return first
    return InputError(first.pointer, f"{first.sentence} (and {len(more)} more fault{'s' * (len(more) > 1)})", faults)


def refuse_pointer(data: bytes, name: str) -> None:
    """InputError where the bytes of the file `name` are a Git LFS pointer: the text that stands for a file not fetched.

    Source: the Git LFS specification, docs/spec.md: a pointer's first line is `version` and the address of the version.
    """
    if data.startswith(b"version https://git-lfs.github.com/spec/"):
        raise InputError(name, "is a Git LFS pointer, not the file itself; run `git lfs pull` in the clone.")
