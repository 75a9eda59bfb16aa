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
