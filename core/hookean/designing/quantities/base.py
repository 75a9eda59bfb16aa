"""What a quantity of an equilibrium is, and what quantities share.

A quantity has values (k,), their derivatives by all positions (k, 3n), and by the unknowns at fixed positions (k, u).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray

from hookean.errors import InputError
from hookean.values.columns import Model

if TYPE_CHECKING:
    from hookean.designing.equilibrium import Equilibrium
    from hookean.designing.unknowns import Unknowns

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Slopes = tuple[Any, Any]
"""Derivatives by positions (k, 3n) and by unknowns (k, u), sparse."""

Axes = Literal["x", "y", "z", "xy", "xz", "yz", "xyz"]
NOTHING = "{kind} measures nothing, because no particles or elements are selected; give at least one"
AXES = {"x": 0, "y": 1, "z": 2}


class Quantity(Model):
    """Base of all quantities."""

    unit: ClassVar[str] = ""  # dimension of its values, see `Units.of`
    kind_name: ClassVar[str] = ""  # the default of `kind`

    @classmethod
    def __pydantic_init_subclass__(cls, **given: Any) -> None:
        super().__pydantic_init_subclass__(**given)
        if "kind" in cls.model_fields:
            cls.called = cls.kind_name = str(cls.model_fields["kind"].default)

    def values(self, found: Equilibrium, pointer: str) -> Floats:
        """Its values (k,) at an equilibrium; InputError at the pointer where it does not fit the scene."""
        raise TypeError(f"{type(self).__name__} does not define values()")

    @property
    def centred(self) -> bool:
        """Whether values are less their mean; `slopes` are of the values themselves, so that they stay sparse."""
        return False

    @property
    def positive(self) -> Quantity | None:
        """The same as parts that are at least 0 at any shape and add up to it; None if it has none."""
        return None

    def differs_from(self, found: Equilibrium, pointer: str) -> float:
        """The size [unit] of what its values are differences of; 0 where they are values themselves."""
        return 0.0

    def slopes(self, found: Equilibrium, unknowns: Unknowns, pointer: str) -> Slopes:
        """Their derivatives, before the mean is taken from them where they are `centred`."""
        raise TypeError(f"{type(self).__name__} does not define slopes()")


def measured(quantity: Quantity, found: Equilibrium, pointer: str) -> Floats:
    """The values (k,) of a quantity; InputError if it has no values."""
    values = quantity.values(found, pointer)
    if not len(values):
        raise InputError(pointer, NOTHING.format(kind=quantity.kind_name))
    return values


def largest_force(found: Equilibrium) -> float:
    """The largest force [force] that an element puts on a particle, which forces are sums of."""
    system, memories = found.system, found.state.memory
    own = [
        system.element_forces(group, found.state, memory)[:, : group.particles.shape[1]]
        for group, memory in zip(system.groups, memories, strict=True)
    ]
    return max((float(np.linalg.norm(each, axis=2).max(initial=0.0)) for each in own), default=0.0)


def particle_places(found: Equilibrium, particles: Ints, pointer: str) -> Ints:
    """The coordinates (k, 3) of particles among all; InputError where one does not exist."""
    n = found.system.slots.count
    if len(particles) and particles.max() >= n:
        given = int(particles.max())
        raise InputError(f"{pointer}/particles", f"particle {given} does not exist; there are {n}, counted from 0")
    return np.asarray(3 * particles[:, None] + np.arange(3))


def across(direction: Any) -> Floats:
    """Two directions (2, 3) at right angles to one and to each other."""
    along = direction / np.linalg.norm(direction)
    first = np.cross(along, np.eye(3)[np.argmin(np.abs(along))])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(along, first)])


def nothing(rows: int, columns: int) -> Any:

    from scipy.sparse import csr_matrix

    return csr_matrix((rows, columns))


def matrix(rows: Any, columns: Any, values: Any, shape: tuple[int, int]) -> Any:

    from scipy.sparse import coo_matrix

    flat = [np.asarray(each).ravel() for each in (values, rows, columns)]
    return coo_matrix((flat[0], (flat[1], flat[2])), shape=shape).tocsr()


def combined(slopes: list[Slopes], weights: list[Floats]) -> Slopes:
    """Sums of derivatives, the rows of each by weights."""
    from scipy.sparse import diags

    by_place = sum(diags(weight) @ slope[0] for slope, weight in zip(slopes, weights, strict=True))
    by_unknown = sum(diags(weight) @ slope[1] for slope, weight in zip(slopes, weights, strict=True))
    return by_place.tocsr(), by_unknown.tocsr()


def summed(matrix: Any) -> Any:

    from scipy.sparse import csr_matrix

    return csr_matrix(matrix.sum(axis=0))
