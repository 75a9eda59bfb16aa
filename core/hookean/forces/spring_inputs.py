"""Stiffness and rest length of springs by what they are given."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from hookean.errors import InputError
from hookean.forces import elastic
from hookean.forces.base import Floats, Ints, Places, lengths
from hookean.values.columns import fault

if TYPE_CHECKING:
    from hookean.forces.springs import Springs

OTHERS = ("axial_stiffness", "material", "section")


def one_way(springs: Springs) -> None:
    """A fault unless stiffness and prestress are each given in one way."""
    ways = [name for name in ("stiffness", "axial_stiffness") if getattr(springs, name) is not None]
    parts = [name for name in ("material", "section") if getattr(springs, name) is not None]
    beside = parts == ["section"] and len(ways) == 1  # k or EA, and an area for the stress
    ways += [" and ".join(parts)] if parts and not beside else []
    if len(ways) > 1 or (len(parts) == 1 and not beside) or not ways:
        said = f"{' and '.join(ways)} given" if ways else "the stiffness is missing"
        raise fault(f"{said}; give exactly one of stiffness, axial_stiffness, or material and section")
    starts = [name for name in ("rest_length", "force", "strain") if getattr(springs, name) is not None]
    if len(starts) > 1:
        raise fault(f"{' and '.join(starts)} given; give at most one of rest_length, force, strain")
    if springs.strain is not None and not (np.asarray(springs.strain) > -1.0).all():
        raise fault(f"{float(np.min(springs.strain)):g} given; more than -1 allowed", "/strain")
    if springs.temperature is not None and springs.material is None:
        raise fault("temperature needs a material with expansion, and a section", "/temperature")
    if springs.tension_only and springs.compression_only:
        raise fault("tension_only and compression_only given; a spring with both has no force: give one of them")
    if springs.mesh is None and springs.edges != "all":
        raise fault("edges are those of a mesh; give mesh, or leave edges out", "/edges")
    _cutoffs_in_order(springs.lower_cutoff, springs.upper_cutoff)
    for only, cutoff in (("tension_only", "lower_cutoff"), ("compression_only", "upper_cutoff")):
        if getattr(springs, only) and np.any(getattr(springs, cutoff)):
            raise fault(f"{only} and {cutoff} given; give one of them")


def _cutoffs_in_order(lower: float | Floats, upper: float | Floats) -> None:
    """A fault where a spring would work at no length."""
    if not np.count_nonzero(upper):
        return
    low, high = np.ravel(lower), np.ravel(upper)
    if 1 not in (len(low), len(high)) and len(low) != len(high):
        return  # not as many as elements: reported elsewhere
    low, high = np.broadcast_arrays(low, high)
    wrong = np.flatnonzero((high > 0.0) & (low > high))
    if len(wrong):
        said = f"{low[wrong[0]]:g} given, above the upper cutoff, {high[wrong[0]]:g}; exchange them"
        raise fault(said, "/lower_cutoff")


def resolved(springs: Springs, places: Places, index: Ints) -> tuple[Floats, Floats]:
    """k [force/length] and the rest length [length], before the rest factor, of elements (m, 2); InputError where
    there is none."""
    elastic.known_area(springs, places)
    start = np.zeros(len(index))
    if springs.rest_length is None or springs.strain is not None or springs.force is not None:
        start = lengths(places.x.take(index[:, 1], axis=0) - places.x.take(index[:, 0], axis=0))
    if springs.stiffness is not None:
        k = _each(springs.stiffness, len(index))
        return k, _rest(springs, places, start, k, None)
    axial = springs.axial_stiffness
    if axial is None:
        axial = elastic.axial_stiffness(springs, places)
    whole = _each(axial, len(index))
    rest = _rest(springs, places, start, None, whole)
    own = rest * springs.rest_factor
    none = np.flatnonzero(~(own > 0.0))
    if len(none):
        said = f"element {none[0]} has no rest length, so that k = EA / rest length has no value"
        raise InputError("", f"{said}; give stiffness, or a rest length and factor above 0")
    return whole / own, rest


def _rest(springs: Springs, places: Places, start: Floats, k: Floats | None, axial: Floats | None) -> Floats:
    rest = start if springs.rest_length is None else np.asarray(springs.rest_length, dtype=np.float64)
    if springs.strain is not None:
        rest = start / (1.0 + np.asarray(springs.strain))
    if springs.force is not None:
        rest = _of_force(np.broadcast_to(springs.force, start.shape), start, k, axial)
    return _each(rest * elastic.growth(springs, places), len(start))


def _each(value: Any, count: int) -> Floats:
    """One value, or one for each element, as one for each (count,)."""
    values = np.asarray(value, dtype=np.float64)
    return values if values.shape == (count,) else np.full(count, values)


def _of_force(force: Floats, start: Floats, k: Floats | None, axial: Floats | None) -> Floats:
    """Rest lengths by which springs of these start lengths have a force: k (l - L0), or EA (l - L0) / L0."""
    if axial is not None:
        whole = axial + force
        low = np.flatnonzero(~(whole > 0.0))
        if len(low):
            said = f"element {low[0]} with EA = {axial[low[0]]:g} cannot have a force of {force[low[0]]:g}"
            raise InputError("", f"{said}; more than -EA is possible")
        return np.asarray(start * axial / whole)
    assert k is not None
    rest: Floats = start - np.divide(force, k, out=np.full(start.shape, np.inf), where=k > 0.0)
    low = np.flatnonzero(~((rest >= 0.0) & np.isfinite(rest)))
    if len(low):
        said = f"element {low[0]} with k = {k[low[0]]:g} and length {start[low[0]]:g} cannot have a force of"
        raise InputError("", f"{said} {force[low[0]]:g}; at most k x length is possible")
    return rest
