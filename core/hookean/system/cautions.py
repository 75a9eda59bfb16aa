"""What a person should know of a compiled scene before it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hookean.compiled import dispatch
from hookean.discretize import meshes
from hookean.forces import Block, Force
from hookean.system.loose_ends import loose_ends

if TYPE_CHECKING:
    from hookean.system.system import System
    from hookean.system.weld import Welded

Floats = NDArray[np.float64]


def coincide(x, indices, rest, touched, same, closed):  # type: ignore[no-untyped-def]
    """Count how many ends of elements touch a particle, 2 for more, and note which of those between two begin and end
    at one, and which of the others have a rest length and no length at the start; how many of each."""
    alike, short = 0, 0
    for e in range(indices.shape[0]):
        for j in range(indices.shape[1]):
            touched[indices[e, j]] = min(touched[indices[e, j]] + 1, 2)
        if indices.shape[1] == 2:
            a, b = np.uint64(indices[e, 0]), np.uint64(indices[e, 1])
            here = x[a, 0] == x[b, 0] and x[a, 1] == x[b, 1] and x[a, 2] == x[b, 2]
            same[e] = a == b
            closed[e] = here and a != b and rest[e] > 0.0
            alike += same[e]
            short += closed[e]
    return alike, short


def _rests(block: Block) -> Floats:
    """Rest lengths (m,) [length] of elements that have one, else zeros."""
    rest = [block.parameters[:, i] for i, name in enumerate(block.names) if name in ("rest_length", "rest_factor")]
    return np.asarray(rest[0] * rest[1]) if len(rest) == 2 else np.zeros(len(block.indices))


def cautions(system: System) -> list[str]:
    """Warnings before a run: materials in other units, springs of zero length, loads on unsupported particles,
    rotations held of particles that have none."""
    materials = system.scene.materials.items()
    doubts = {f"{name}/{of}": said for name, one in materials for of, said in one.doubts(system.scene.units).items()}
    warnings = [f"/materials/{place}: {said}" for place, said in doubts.items()]
    touched = np.zeros(len(system.x), dtype=np.int8)
    for group in system.groups:
        if group.cls.role == "load":
            sized = [part for part in group.parts if part.force.element_arity > 1 or not len(part.inputs)]
            warnings += [said for part in sized if (said := without_size(system, part.number, part.force))]
            if group.cls.outward:
                warnings += [said for part in group.parts if (said := turned_faces(system, part.number, part.force))]
            continue
        for part in group.parts:
            block = group.of(part)
            index = np.ascontiguousarray(group.particles[part.rows])
            same, closed = np.zeros((2, len(index)), dtype=np.int8)
            if not len(index):
                warnings.append(_nowhere(system, part.number))
                continue
            alike, short = dispatch.compiled(coincide)(system.x, index, _rests(block), touched, same, closed)
            if alike and not part.force.pointed:
                warnings.append(
                    f"/forces/{part.number}: {alike} of {len(same)} elements start and end at one particle (first: "
                    f"element {int(np.argmax(same))}) and have no length; lengthen them or lower weld_tolerance"
                )
            if short:
                warnings.append(
                    f"/forces/{part.number}: {short} of {len(closed)} elements have zero length (first: element "
                    f"{int(np.argmax(closed))}), so their forces have no direction; move their ends apart"
                )
    once = touched == 1
    idle = ((system.load_count > 0) & (touched == 0))[: system.slots.count].nonzero()[0]
    for number, given in enumerate(system.scene.anchors):
        places = given.points if given.particles is None else given.particles
        if places is not None and not places.size:
            said = "the anchor holds nothing: no points are given; give some, or remove it"
            warnings.append(f"/anchors/{number}: {said}")
    warnings += _elsewhere(system)
    for anchor in system.held:
        if anchor.whole:
            touched[anchor.particles] = 1
        if anchor.turns and (none := system.slots.rows(anchor.particles) < 0).any():
            warnings.append(
                f"/anchors/{anchor.number}/rotations: particle {anchor.particles[none][0]} has no rotation to hold: no "
                "beam ends there" + (f" (nor have {none.sum() - 1} more)" if none.sum() > 1 else "")
            )
    alone = idle[touched[idle] == 0] if len(idle) else idle
    if len(alone) < len(idle):
        direct = idle[touched[idle] > 0]
        more = f" (and {len(direct) - 1} more)" if len(direct) > 1 else ""
        warnings.append(
            f"particle {direct[0]} passes its load straight to its anchor{more}: no spring or other force touches it; "
            "leave it out of the load, or connect it"
        )
    if len(alone) and not system.contacts:
        warnings.append(
            f"particle {alone[0]} carries a load but is unsupported: no spring, other force or anchor holds it"
            + (f" (and {len(alone) - 1} more)" if len(alone) > 1 else "")
        )
    if sum(len(group.parts) for group in system.groups if group.cls.role == "internal") > 1:
        from hookean.system.near_misses import near_misses

        warnings += near_misses(system)
    return [*warnings, *closed_up(system.places), *loose_ends(system, once)]


def closed_up(places: Welded) -> list[str]:
    """Meshes with edges whose ends became one particle, as a mesh in millimetres has them where the unit is a metre."""
    found = []
    named = [vars(force).get("mesh") for force in places.scene.forces if force.role != "load"]
    for name in dict.fromkeys(str(mesh) for mesh in named if mesh is not None):
        mesh = places.scene.meshes[name]
        ends = np.stack([mesh.faces, np.roll(mesh.faces, -1, axis=1)], axis=2).reshape(-1, 2)
        at = places.vertices(name)[ends]
        ends = ends[(at[:, 0] == at[:, 1]) & (at[:, 0] >= 0)]
        ends = ends[(mesh.vertices[ends[:, 0]] != mesh.vertices[ends[:, 1]]).any(axis=1)]
        if len(ends):
            short = np.unique(np.sort(ends, axis=1), axis=0)
            longest = float(np.linalg.norm(mesh.vertices[short[:, 0]] - mesh.vertices[short[:, 1]], axis=1).max())
            many = "1 edge has its ends" if len(short) == 1 else f"{len(short)} edges have their ends"
            found.append(
                f"/meshes/{name}: {many} in one particle (first: vertices {short[0, 0]} and {short[0, 1]}), up to "
                f"{longest:.3g} {places.scene.units.length} long; lower weld_tolerance, "
                f"{places.tolerance:g} {places.scene.units.length} now, or draw the mesh larger"
            )
    return found


def turned_faces(system: System, number: int, load: Any) -> str:
    """Which faces of a load along their normals run the other way round than one beside them, so that it pushes to
    both sides of the mesh. Empty where all is well; edges of more than two faces have no side."""
    faces = system.places.faces(load.mesh)
    sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1)
    kept = (sides[:, :, 0] != sides[:, :, 1]) & (faces.min(axis=1, initial=0) >= 0)[:, None]
    owner, (one, other) = np.nonzero(kept)[0], sides[kept].T
    keys = np.array([one, np.minimum(one, other)]) * len(system.x) + [other, np.maximum(one, other)]
    ways, edges = (np.unique(key, return_inverse=True, return_counts=True)[1:] for key in keys)  # rows are slower
    turned = np.flatnonzero((ways[1][ways[0]] == 2) & (edges[1][edges[0]] == 2))
    if not len(turned):
        return ""
    first, second = turned[keys[0, turned] == keys[0, turned[0]]]
    return (
        f"/forces/{number}/mesh: faces beside each other run round in different directions at {len(turned) // 2} edges "
        f"(first: faces {owner[first]} and {owner[second]}), so {load.kind_name} pushes to both sides of the mesh; "
        "unify their normals"
    )


def _nowhere(system: System, number: int) -> str:
    """That a force has no elements: none were given, or its mesh has none for it."""
    force = system.scene.forces[number]
    mesh = getattr(force, "mesh", None)
    why = (
        "no elements are given; give some" if mesh is None else f'mesh "{mesh}" has no element for it; change the mesh'
    )
    return f"/forces/{number}: {force.kind_name} acts on nothing: {why}, or remove the force"


def _elsewhere(system: System) -> list[str]:
    """Anchors that hold a particle where they, or earlier ones, do not: the last target counts."""
    warnings: list[str] = []
    held = [particle for anchor in system.held for particle in anchor.particles.tolist()]
    if len(set(held)) == len(held):
        return warnings
    target, holder = np.full((len(system.x), 3), np.nan), np.full((len(system.x), 3), -1)
    for anchor in system.held:
        cells = np.ix_(anchor.particles, np.flatnonzero(anchor.free == 0.0))
        wanted, earlier, before = anchor.targets[:, cells[1][0]], target[cells], holder[cells]
        target[cells], holder[cells] = wanted, anchor.number
        for there, whose in ((earlier, before), (target[cells], holder[cells])):
            apart = np.argwhere(np.abs(there - wanted) > system.scene.weld_tolerance)
            if len(apart):
                row, column = apart[0]
                other = whose[row, column]
                warnings.append(
                    f"/anchors/{anchor.number}: particle {anchor.particles[row]} is held at "
                    f"{'xyz'[cells[1][0][column]]} = {wanted[row, column]:g}, and by "
                    f"{'this anchor, too,' if other == anchor.number else f'/anchors/{other}'} at "
                    f"{there[row, column]:g}; the last counts: give it one target"
                )
                break
    return warnings


def without_size(system: System, number: int, load: Force) -> str:
    """Which elements of a load weld to less than they were drawn as, so that their load is lost; or that it has none.
    Empty where all is well."""
    place = f"/forces/{number}"
    which, whole = _shrunk(system.places, load)
    if not whole:
        return f"{place}: {load.kind_name} acts on nothing: no elements are given; give some, or remove the force"
    if not len(which):
        return ""
    less = "a line, which has no area" if load.element_arity > 2 else "one particle, which has no length"
    return (
        f"{place}: {len(which)} of {whole} elements (first: element {which[0]}) are no larger than weld_tolerance and "
        f"become {less}, so their load is lost; lower weld_tolerance, or draw them larger"
    )


def _shrunk(places: Welded, load: Force) -> tuple[NDArray[np.int64], int]:
    """Elements of a load that are drawn with a size, and whose corners became one particle, of faces two; and how many
    elements there are."""
    mesh, lines = getattr(load, "mesh", None), getattr(load, "lines", None)
    if load.element_arity == 1 or (mesh is None and lines is None):
        return np.zeros(0, np.int64), len(places.elements(load))
    if lines is not None:
        corners, drawn = places.elements(load), np.asarray(lines)
    else:
        data = places.scene.meshes[str(mesh)]
        find = meshes.naked_edges if getattr(load, "edges", "all") == "naked" else meshes.edges
        of = data.faces if load.element_arity > 2 else find(data)
        corners, drawn = places.vertices(str(mesh))[of], data.vertices[of]
    ordered = np.sort(corners, axis=1)
    distinct = 1 + np.count_nonzero(np.diff(ordered, axis=1), axis=1)
    shrunk = np.flatnonzero((distinct < min(corners.shape[1], 3)) & (ordered[:, 0] >= 0))
    sides = drawn[shrunk] - np.roll(drawn[shrunk], 1, axis=1)
    sizes = np.cross(sides[:, :1], sides[:, 1:]) if load.element_arity > 2 else sides
    return shrunk[(sizes != 0.0).any(axis=(1, 2))], len(corners)
