"""The one error a person can cause: bad input, told in one sentence with its place."""

from __future__ import annotations


class InputError(ValueError):
    """Bad input: where it stands, what was given, what is allowed, what to do.

    `pointer` is a JSON pointer into the scene (`/forces/3/lines/17`) or the name of a file or option;
    `sentence` says the rest. `str(error)` reads as one line.
    """

    def __init__(self, pointer: str, sentence: str) -> None:
        super().__init__(f"{pointer}: {sentence}" if pointer else sentence)
        self.pointer = pointer
        self.sentence = sentence


def refuse_pointer(data: bytes, name: str) -> None:
    """InputError where the bytes of the file `name` are a Git LFS pointer: the text that stands for a file not fetched.

    Source: the Git LFS specification, docs/spec.md: a pointer's first line is `version` and the address of the version.
    """
    if data.startswith(b"version https://git-lfs.github.com/spec/"):
        raise InputError(name, "is a Git LFS pointer, not the file itself; run `git lfs pull` where it was cloned.")
