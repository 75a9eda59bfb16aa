"""Natural frequencies: the small free vibrations of a shape about its equilibrium."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hookean.analysis.at_rest import AtRest
from hookean.analysis.load_cases import of_case
from hookean.analysis.matrices import Unknowns, against_turns, condensed, factor, largest_row
from hookean.analysis.one_way import between
from hookean.errors import InputError
from hookean.forces.self_weight import SelfWeight
from hookean.running.result import Result
from hookean.running.simulation import Simulation
from hookean.scene.scene import Scene
from hookean.values.materials import gravity
from hookean.values.units import Units

Floats = NDArray[np.float64]

ROUNDING = 4.0 * float(np.finfo(np.float64).eps)  # part of the largest eigenvalue that rounding may leave of one
MOST = 1000
WEIGHED = SelfWeight.kind_name  # masses of the self-weight
UNIT_MASSES = f'every particle has the mass 1, the default; for a real structure give masses, or masses "{WEIGHED}"'
OF_FORM = (
    "these are frequencies of the form, whose films and lines of constant tension are not elastic; for those of the"
    " frozen model name a load case, case='...'"
)


@dataclass(frozen=True)
class Frequencies:
    """Natural frequencies of a shape, the lowest first.

    `frequencies` (k,) and `angular_frequencies` (k,) [1/time]; 0 for motions that nothing resists, negative for
    motions that grow (the shape is unstable there: the square of the angular frequency is negative). `modes` (k, n, 3)
    the motions of the particles, the largest part of each 1 [-]. `effective_masses` (k, 3) [mass]: the mass that moves
    with a mode when the supports shake along x, y or z, out of `mass` (3,) that can move. `notes` are sentences on the
    masses, and on elements that are just where they go slack.
    """

    frequencies: Floats
    angular_frequencies: Floats
    modes: Floats
    effective_masses: Floats
    mass: Floats
    particles: Floats = field(repr=False)
    units: Units = field(default_factory=Units)
    notes: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return "\n".join(["Frequencies", *(f"  {line}" for line in self.summary())])

    @property
    def periods(self) -> list[float | None]:
        """Periods (k,) [time]; None where a motion does not come back."""
        return [1.0 / f if f > 0.0 else None for f in self.frequencies.tolist()]

    def summary(self) -> list[str]:
        """A line for each mode, frequency and period, and notes."""
        unit, lines = self.units.time, []
        for i, (found, period) in enumerate(zip(self.frequencies.tolist(), self.periods, strict=True)):
            end = f"period {period:.6g} {unit}" if period else "no resistance" if found == 0.0 else "unstable"
            lines.append(f"mode {i + 1}: {found:.6g} 1/{unit}, {end}")
        return [*lines, *self.notes]

    def to_dict(self) -> dict[str, Any]:
        """As plain lists and numbers, by the names of the HTTP answer."""
        return {
            "frequencies": self.frequencies.tolist(),
            "angular_frequencies": self.angular_frequencies.tolist(),
            "periods": self.periods,
            "modes": self.modes.tolist(),
            "effective_masses": self.effective_masses.tolist(),
            "mass": self.mass.tolist(),
            "particles": self.particles.tolist(),
            "units": self.units.model_dump(),
            "notes": list(self.notes),
        }


def frequencies(
    model: Scene | Result | Simulation, count: int = 6, *, masses: Any = None, case: str | None = None
) -> Frequencies:
    """The lowest natural frequencies and modes of an equilibrium: K phi = omega^2 M phi.

    K is the exact tangent stiffness of the shape, with the stress that it carries; M the lumped masses of the
    particles. Held axes do not move. Large models use shift-invert Lanczos iteration.

    - `model`: A scene (which is relaxed), a result that converged, or a simulation at rest.
    - `count`: How many modes; fewer are returned where the shape has fewer free axes.
    - `masses`: Masses (n,) of the particles, or one for all [force time^2/length]; "self_weight": those of the
      `self_weight` forces that act, their weight over g without the factors of a load case; default: those of the
      scene, 1 unless given.
    - `case`: A load case or combination of the scene, in which it is frozen; default: none.

    Raises InputError for a shape that is not at rest, an unknown case, a force without a tangent, or masses that are
    not positive.
    Source: Clough and Penzien, Dynamics of Structures, 1993, chapters 11 to 13; Ericsson and Ruhe, The spectral
    transformation Lanczos method, 1980.
    """
    if not (isinstance(count, int) and 1 <= count <= MOST):
        raise InputError("count", f"{count!r} given; a whole number from 1 to {MOST} is expected")
    rest = AtRest.of(of_case(model, case))
    mass = _masses(rest, masses)
    unknowns = Unknowns.of(rest.system, rest.state, rest.free)
    tangent = unknowns.tangent(rest.system, rest.state)
    own = mass[unknowns.dofs // 3]
    stiffness, turns = against_turns(tangent, unknowns.dofs, rest.system.slots.count, own)
    squares, vectors = lowest(stiffness, own, min(count, len(own) - turns))
    vectors = vectors / np.sqrt(own)[:, None]
    angular = np.sign(squares) * np.sqrt(np.abs(squares))
    modes = np.array([_scaled(unknowns.spread(vector)) for vector in vectors.T]).reshape(-1, len(mass), 3)
    own_rows = rest.system.slots.count
    shaken = np.einsum("knc,n->kc", (modes * rest.free)[:, :own_rows], mass[:own_rows])
    modal = np.einsum("knc,knc,n->k", modes, modes, mass)
    return Frequencies(
        angular / (2.0 * np.pi),
        angular,
        modes[:, :own_rows],
        shaken**2 / modal[:, None],
        np.asarray((rest.free * mass[:, None])[:own_rows].sum(axis=0)),
        rest.state.x[:own_rows],
        rest.system.scene.units,
        (*_notes(rest, masses is None and bool((mass[:own_rows] == 1.0).all())), *between(rest)),
    )


def _notes(rest: AtRest, unit_masses: bool) -> list[str]:
    """Sentences on masses, and on a form that is to be frozen."""
    stages = rest.system.scene.stages
    frozen = stages is not None and bool(stages.freeze or stages.films)
    return [UNIT_MASSES] * unit_masses + [OF_FORM] * frozen


def _masses(rest: AtRest, given: Any) -> Floats:
    if given is None:
        return rest.system.mass
    slots, count = rest.system.slots, rest.system.slots.count
    if isinstance(given, str):
        if given != WEIGHED:
            raise InputError("masses", f'{given!r} given; give numbers, or "{WEIGHED}"')
        given = _weighed(rest)
    try:
        mass = np.array(np.broadcast_to(np.asarray(given, dtype=float), (count,)))
    except (TypeError, ValueError):
        raise InputError("masses", f"give one mass, or one for each of the {count} particles") from None
    if not (np.isfinite(mass) & (mass > 0.0)).all():
        spot = int(np.argmax(~(np.isfinite(mass) & (mass > 0.0))))
        raise InputError(f"masses/{spot}", f"{mass[spot]:g} given; masses are more than 0 and finite")
    rows = slots.extended(mass, 1.0)
    rows[slots.first] = mass[slots.particles]  # a rotation has the mass of its particle
    return rows


def _weighed(rest: AtRest) -> Floats:
    """Masses (n,) of the `self_weight` forces that act, without factors of load cases; InputError where a particle that
    moves has none."""
    system = rest.system
    found = np.zeros(system.slots.count)
    for group in system.groups:
        if group.cls is not SelfWeight:
            continue
        for part in group.parts:
            block, force = group.of(part), part.force
            assert isinstance(force, SelfWeight)
            g = (gravity(system.scene.units) if force.gravity is None else force.gravity) * force.acting
            weight = np.linalg.norm(block.parameters[:, :3], axis=1)
            found += np.bincount(block.indices[:, 0], weight / abs(g) if g != 0.0 else 0.0 * weight, len(found))
    without = found <= 0.0
    moves = np.flatnonzero(without & (rest.free[: len(found)] > 0.0).any(axis=1))
    if len(moves):
        said = f"particle {moves[0]} moves and has no self_weight; add one there, or give masses as numbers"
        raise InputError("masses", said)
    found[without] = 1.0  # held in all axes: it does not count
    return found


def lowest(stiffness: Any, mass: Floats, count: int) -> tuple[Floats, Floats]:
    """The lowest eigenvalues of M^-1/2 K M^-1/2 and their vectors (unknowns, count), what rounding leaves of zero as
    zero."""
    import scipy.sparse as sparse

    size, total = len(mass), stiffness.shape[0]
    root = np.append(1.0 / np.sqrt(mass), np.ones(total - size))
    scaled = (sparse.diags(root) @ stiffness @ sparse.diags(root)).tocsc()
    noise = ROUNDING * largest_row(scaled)
    if not size:
        return np.zeros(0), np.zeros((0, 0))
    if size <= 400 or count > size - 2:
        import scipy.linalg

        values, vectors = scipy.linalg.eigh(condensed(scaled, size), subset_by_index=(0, count - 1))
    else:
        values, vectors = _inverted(scaled, size, count, noise)
    return np.where(np.abs(values) <= noise, 0.0, values), vectors


def _inverted(scaled: Any, size: int, count: int, noise: float) -> tuple[Floats, Floats]:
    """By Lanczos iteration on (K - s M)^-1, s below all eigenvalues; unknowns after `size` have no mass."""
    import scipy.sparse as sparse
    from scipy.sparse.linalg import LinearOperator, eigsh

    total = scaled.shape[0]
    mass = sparse.diags(np.append(np.ones(size), np.zeros(total - size)), format="csc")
    shift = max(noise, np.finfo(float).tiny)
    found = factor(scaled + shift * mass)
    while found is None or found.negatives:
        shift *= 10.0
        found = factor(scaled + shift * mass)
    solve = LinearOperator((total, total), matvec=found.solve, dtype=np.float64)
    start = np.append(np.sin(12.9898 * np.arange(1.0, size + 1.0)), np.zeros(total - size))
    values, vectors = eigsh(scaled, count, mass, sigma=-shift, which="LM", OPinv=solve, v0=start, tol=0.0)
    order = np.argsort(values, kind="stable")
    return np.asarray(values[order]), np.asarray(vectors[:size, order])


def _scaled(motion: Floats) -> Floats:
    """A motion whose largest part is 1."""
    spot = np.unravel_index(np.argmax(np.abs(motion)), motion.shape)
    return np.asarray(motion / motion[spot])
