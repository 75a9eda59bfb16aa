"""From a recipe and the objects it selects to a Scene, remembering which object everything came from."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from hookean.errors import InputError
from hookean.files.recipe import shapes
from hookean.files.recipe.curves import lying_on
from hookean.files.recipe.drawing import Drawing, Item
from hookean.files.recipe.guides import pulling
from hookean.files.recipe.select import Term, count, is_selector, listed, select, terms
from hookean.files.recipe.shapes import Shape, Split
from hookean.files.recipe.snapping import drawn_on, reach_of, snapped
from hookean.scene.scene import Scene

PLACE_FIELDS = ("points", "lines", "mesh")
SPLIT_FIELDS = ("divide", "divide_u", "divide_v")


@dataclass(eq=False)
class Built:
    """A scene, and for each force and anchor the shape its elements came from (None: given as numbers).

    `meshes` holds the shape behind each of the scene's meshes, `geometry` the item behind each carried geometry,
    `uses` what became of each item, `left` why an item was left out, `notes` a line for each table.
    """

    scene: Scene
    drawing: Drawing
    forces: list[Shape | None]
    anchors: list[Shape | None]
    meshes: dict[str, Shape]
    geometry: list[Item | None]
    uses: dict[Item, list[str]]
    left: dict[Item, str]
    notes: list[str] = field(default_factory=list)
    guessed: bool = False  # anchors were not marked, so loose ends are held

    @property
    def size(self) -> str:
        """How large what forces act on was drawn, in the file's unit, such as `2 x 4 x 0.5 mm`; "" for nothing."""
        found = [s.array.reshape(-1, 3) for s in (*self.forces, *self.meshes.values()) if s is not None]
        points = np.concatenate([np.zeros((0, 3)), *found]) / self.drawing.factor
        sides = [f"{side:.4g}" for side in np.ptp(points, axis=0)] if len(points) else []
        return f"{' x '.join(sides)} {self.drawing.unit}" if sides else ""


def build(drawing: Drawing, recipe: Mapping[str, Any], *, lenient: bool = False) -> Built:
    """The scene a recipe describes; `lenient` leaves out what cannot be used instead of refusing it.

    Raises InputError where a selector finds nothing or does not fit, or the scene has a fault.
    """
    return _Builder(drawing, recipe, lenient).built()


class _Builder:
    def __init__(self, drawing: Drawing, recipe: Mapping[str, Any], lenient: bool) -> None:
        self.drawing, self.lenient = drawing, lenient
        self.recipe = {k: v for k, v in recipe.items() if k not in ("units", "hidden")}
        tolerance = self.recipe.setdefault("weld_tolerance", drawing.tolerance)
        self.tolerance = float(tolerance) if isinstance(tolerance, int | float) and tolerance >= 0 else 0.0
        given = self.recipe.get("meshes", {})
        self.literal: Mapping[str, Any] = given if isinstance(given, Mapping) else {}
        self.splits: dict[Item, Split] = {}
        self.meshes: dict[str, Shape] = {}
        self.known: dict[tuple[Any, ...], str] = {}
        self.uses: dict[Item, list[str]] = {}
        self.left: dict[Item, str] = {}
        self.misfits: list[str] = []
        self.notes: list[str] = []

    def built(self) -> Built:
        scene = dict(self.recipe)
        scene["units"] = self.drawing.units
        tables = {group: self._tables(group) for group in ("forces", "anchors", "geometry")}
        reach = {i: reach_of(t, f"/anchors/{i}") for i, t in enumerate(tables["anchors"]) if "snap" in t}
        for table in tables["anchors"]:
            table.pop("snap", None)
        for group, given in tables.items():
            for i, table in enumerate(given):
                self._remember(table, f"/{group}/{i}")
        placed = {g: [self._place(g, i, t) for i, t in enumerate(tables[g])] for g in ("forces", "anchors")}
        placed["forces"] = pulling(placed["forces"], self._led, self.drawing.factor, self._known_mesh, self.notes)
        carried = [entry for i, table in enumerate(tables["geometry"]) for entry in self._carry(i, table)]
        for group in placed:
            scene[group] = [table for table, _ in placed[group]]
        scene["geometry"] = [table for table, _ in carried]
        if not self.lenient and not scene["forces"] and "particles" not in scene:
            scene["particles"] = drawn_on([shape for _, shape in placed["anchors"]])
        made = {n: {"vertices": s.array, "faces": s.faces} for n, s in self.meshes.items()}
        if isinstance(self.recipe.get("meshes", {}), Mapping):  # else the scene refuses it
            scene["meshes"] = {**self.literal, **made}
        return Built(
            scene=snapped(Scene.read(scene), reach),
            drawing=self.drawing,
            forces=[shape for _, shape in placed["forces"]],
            anchors=[shape for _, shape in placed["anchors"]],
            meshes=self.meshes,
            geometry=[item for _, item in carried],
            uses=self.uses,
            left={item: why for item, why in self.left.items() if item not in self.uses},
            notes=self.notes,
        )

    def _tables(self, group: str) -> list[dict[str, Any]]:
        given = self.recipe.get(group, [])
        if not isinstance(given, list | tuple) or not all(isinstance(t, Mapping) for t in given):
            raise InputError(f"/{group}", f"give tables, in TOML each under [[{group}]]")
        return [dict(table) for table in given]

    def _split(self, table: Mapping[str, Any], pointer: str) -> Split | None:
        """The division a table gives itself."""
        u, v = table.get("divide_u"), table.get("divide_v")
        if (u is None) != (v is None) or (u is not None and "divide" in table):
            raise InputError(pointer, "give either divide, or divide_u and divide_v both")
        if u is not None:
            return shapes.split_of([u, v], f"{pointer}/divide_u")
        return shapes.split_of(table.get("divide"), f"{pointer}/divide")

    def _remember(self, table: Mapping[str, Any], pointer: str) -> None:
        """How a table divides its objects also holds for tables that select the same ones without dividing."""
        split = self._split(table, pointer)
        for name in PLACE_FIELDS if split else ():
            if is_selector(table.get(name)) and not self._literal_mesh(name, table):
                for term in terms(table[name], f"{pointer}/{name}"):
                    for item in select(self.drawing, term, f"{pointer}/{name}"):
                        self.splits.setdefault(item, split)  # type: ignore[arg-type]

    def _literal_mesh(self, name: str, table: Mapping[str, Any]) -> bool:
        return name in ("mesh", "target") and isinstance(table.get(name), str) and table[name] in self.literal

    def _split_for(self, item: Item, own: Split | None) -> Split | None:
        if own is not None:
            return own
        return self.splits.get(item) or shapes.split_of(item.text.get("divide"), f"{item.label}, user text divide")

    def _place(self, group: str, number: int, table: dict[str, Any]) -> tuple[dict[str, Any], Shape | None]:
        """A force's or an anchor's table with coordinates for selectors."""
        pointer = f"/{group}/{number}"
        own = self._split(table, pointer)
        used: Shape | None = None
        said = "anchor" if group == "anchors" else str(table.get("kind", ""))
        if table.get("name") and isinstance(table["name"], str):
            said += f' "{table["name"]}"'
        said += " that is carried along" if group == "geometry" else ""
        for name in PLACE_FIELDS:
            value = table.get(name)
            if not is_selector(value) or self._literal_mesh(name, table):
                continue
            used = self._shape(name, value, own, f"{pointer}/{name}")
            if name == "mesh":
                table[name] = self._named(value, used, own)
                faces = 0 if used.faces is None else len(used.faces)
                size = f"a mesh of {count(len(used.array), 'vertex', 'vertices')} and {count(faces, 'face')}"
            else:
                used = self._on(used, name, table, pointer, said)
                table[name] = used.array
                size = count(len(used.array), name.removesuffix("s"))
            owners = [used.items[i] for i in np.unique(used.owner)]
            self._use(owners, said)
            self.notes.append(f"{group}[{number}] {said}: {size} from {shapes.counted(owners)}")
        if is_selector(table.get("warp_lines")):
            warp = self._shape("lines", table["warp_lines"], None, f"{pointer}/warp_lines")
            table["warp_lines"] = warp.array
            self._use([warp.items[i] for i in np.unique(warp.owner)], f"warp of {said}")
        plain = {k: v for k, v in table.items() if k not in SPLIT_FIELDS}
        if used is None and isinstance(table.get("points"), np.ndarray):
            self.notes.append(f"{group}[{number}] {said}: {count(len(table['points']), 'point')}")
        return plain, used

    def _on(self, shape: Shape, name: str, table: dict[str, Any], pointer: str, said: str) -> Shape:
        """Of selected points those on the curves that the table asks them to lie on."""
        if name != "points" or "on" not in table:
            return shape
        curves = self._curves(table.pop("on"), f"{pointer}/on")
        self._use(curves, f"curve that holds points of {said}")
        return lying_on(shape, curves, self.drawing.factor, self.tolerance, f"{pointer}/on")

    def _led(self, table: dict[str, Any], pointer: str, said: str) -> Sequence[tuple[Item, ...]]:
        """The curves of a pull, or its target as a mesh of the scene; what is selected."""
        if table.get("kind") == "pull_to_curve" and is_selector(table.get("curve")):
            items = self._curves(table["curve"], f"{pointer}/curve")
            self._use(items, f"curve of {said}")
            return [tuple(items)]
        if not is_selector(table.get("target")) or self._literal_mesh("target", table):
            return []
        split = shapes.split_of(table.pop("target_divide", None), f"{pointer}/target_divide")
        shape = self._shape("mesh", table["target"], split, f"{pointer}/target")
        table["target"] = self._named(table["target"], shape, split)
        self._use(shape.items, f"target of {said}")
        return []

    def _curves(self, value: Any, pointer: str) -> list[Item]:
        found: list[Item] = []
        for term in terms(value, pointer):
            _plain(term, pointer)
            found += self._fitting(term, shapes.is_curve, "curves", pointer)
        if not found:
            raise InputError(pointer, "the file has no visible curve")
        return list(dict.fromkeys(found))

    def _use(self, items: Sequence[Item], said: str) -> None:
        for item in items:
            self.uses.setdefault(item, [])
            if said not in self.uses[item]:
                self.uses[item].append(said)

    def _shape(self, name: str, value: Any, own: Split | None, pointer: str) -> Shape:
        made = {"points": self._points, "lines": self._lines, "mesh": self._mesh}[name]
        self.misfits = []
        found = [s for term in terms(value, pointer) for s in made(term, own, pointer)]
        asked = {t.feature for t in terms(value, pointer)}
        if not sum(len(shape.array) for shape in found) and not (found and asked == {"rim"}):
            closed = "; closed meshes have none" if asked & {"naked", "corners"} else ""
            closed = "; closed curves, and curves whose ends all meet, have none" if "loose" in asked else closed
            why = next((f": {w}" for w in (*self.left.values(), *self.misfits)), closed)
            raise InputError(pointer, f"{listed([str(t) for t in terms(value, pointer)])} gives no {name}{why}")
        if name == "points":
            return shapes.unique(shapes.concatenated(found, 2), self.tolerance)
        if name == "lines":
            return shapes.concatenated(found, 3)
        items = [item for shape in found for item in shape.items]
        first = list(dict.fromkeys(items))
        if len(first) == len(items) and len(found) == 1:
            return found[0]
        return self._joined(first, own, pointer)

    def _points(self, term: Term, own: Split | None, pointer: str) -> list[Shape]:
        meshes = shapes.is_mesh
        fits, hint = shapes.points_from(term.feature, divided=own is not None)
        items = self._fitting(term, fits, hint, pointer)
        if term.feature == "loose":
            return [self._loose(items, term, own, pointer)]
        found: list[Shape] = []
        for item in (i for i in items if not meshes(i)):
            split = self._split_for(item, own)
            points = self._try(item, term, shapes.points_of, term.feature, split, pointer)
            if points is not None:
                found.append(Shape((item,), points * self.drawing.factor, np.zeros(len(points), np.int64)))
        surfaces = [i for i in items if meshes(i)]
        if surfaces:
            shape = self._joined(surfaces, own, pointer, term)
            if len(shape.array) and term.feature == "rim":
                others = [i for i in self._selected("mesh", meshes) if i not in surfaces]
                found.append(shapes.rim(shape, self._joined(others, None, pointer), self.tolerance))
            elif len(shape.array):
                found.append(shapes.mesh_points(shape, term.feature, self.tolerance))
        return found

    def _loose(self, items: Sequence[Item], term: Term, own: Split | None, pointer: str) -> Shape:
        """Ends of curves that meet neither another of them nor another line of a force."""
        others = [item for item in self._selected("lines", shapes.is_curve) if item not in items]
        mine, rest = self._pieces(items, term, own, pointer), self._pieces(others, None, None, pointer)
        return shapes.loose(shapes.concatenated(mine, 3), shapes.concatenated(rest, 3), self.tolerance)

    def _selected(self, place: str, fits: Callable[[Item], bool]) -> list[Item]:
        """What becomes lines or meshes."""
        found: list[Item] = []
        for number, table in enumerate(self._tables("forces")):
            at = f"/forces/{number}/{place}"
            if is_selector(table.get(place)) and not self._literal_mesh(place, table):
                found += [i for term in terms(table[place], at) for i in select(self.drawing, term, at)]
        return [i for i in dict.fromkeys(found) if fits(i)]

    def _lines(self, term: Term, own: Split | None, pointer: str) -> list[Shape]:
        _plain(term, pointer)
        hint = "lines and curves; for the edges of a mesh or surface give mesh = instead of lines ="
        return self._pieces(self._fitting(term, shapes.is_curve, hint, pointer), term, own, pointer)

    def _pieces(self, items: Sequence[Item], term: Term | None, own: Split | None, pointer: str) -> list[Shape]:
        """The lines of curves, a shape for each."""
        found = []
        for item in items:
            lines = self._try(item, term, shapes.lines_of, self._split_for(item, own), pointer)
            if lines is not None:
                found.append(Shape((item,), lines * self.drawing.factor, np.zeros(len(lines), np.int64)))
        return found

    def _mesh(self, term: Term, own: Split | None, pointer: str) -> list[Shape]:
        _plain(term, pointer)
        items = self._fitting(term, shapes.is_mesh, "meshes, surfaces, Breps and extrusions", pointer)
        return [self._joined(items, own, pointer, term)]

    def _joined(self, items: Sequence[Item], own: Split | None, pointer: str, term: Term | None = None) -> Shape:
        kept, meshes = [], []
        for item in items:
            split = self._split_for(item, own)
            mesh = self._try(item, term, shapes.mesh_of, split, pointer)
            if mesh is not None:
                kept.append(item)
                meshes.append(mesh)
        if not kept:
            return Shape((), np.zeros((0, 3)), np.zeros(0, np.int64), np.zeros((0, 4), np.int64))
        return shapes.joined(kept, meshes, self.drawing.factor)

    def _fitting(self, term: Term, fits: Callable[[Item], bool], what: str, pointer: str) -> list[Item]:
        """The selected items that are supported here; raises InputError if none of them is supported."""
        items = select(self.drawing, term, pointer)
        good = [item for item in items if fits(item)]
        if not good and not term.everything:
            raise InputError(pointer, f'"{term}" finds {shapes.counted(items)}; allowed are {what}')
        if not good:
            self.misfits.append(f"the file has {shapes.counted(items)}; allowed are {what}")
        return good

    def _try(self, item: Item, term: Term | None, make: Callable[..., Any], *arguments: Any) -> Any:
        """What `make` gives; where it refuses, None and the reason noted, if what does not fit may be left out."""
        try:
            return make(item, *arguments)
        except InputError as error:
            if not (self.lenient or (term is not None and term.everything)):
                raise
            self.left[item] = error.sentence.removeprefix(item.label).lstrip(": ")
            return None

    def _known_mesh(self, name: str) -> Any:
        """A mesh of the scene."""
        return self.meshes.get(name, self.literal.get(name))

    def _named(self, value: Any, shape: Shape, own: Split | None) -> str:
        """The name of a mesh in the scene; the same objects divided the same way are one mesh."""
        key = (own, *shape.items)
        if key not in self.known:
            base = value if isinstance(value, str) else ", ".join(value)
            name, number = base, 1
            while name in self.meshes or name in self.literal:
                number += 1
                name = f"{base} ({number})"
            self.known[key] = name
            self.meshes[name] = shape
        return self.known[key]

    def _carry(self, number: int, table: dict[str, Any]) -> list[tuple[dict[str, Any], Item | None]]:
        """Carried geometry: polylines and curves one for each object, the rest together."""
        pointer, kind = f"/geometry/{number}", table.get("kind")
        value = table.get("points")
        if kind not in ("polyline", "curve") or not is_selector(value):
            made, shape = self._place("geometry", number, table)
            return [(made, shape.items[0] if shape is not None and len(shape.items) == 1 else None)]
        own = self._split(table, pointer)
        plain = {k: v for k, v in table.items() if k not in SPLIT_FIELDS}
        found: list[tuple[dict[str, Any], Item | None]] = []
        for term in terms(value, f"{pointer}/points"):
            _plain(term, f"{pointer}/points")
            for item in self._fitting(term, shapes.is_curve, "curves", f"{pointer}/points"):
                if kind == "polyline":
                    points = shapes.points_of(item, "vertices", self._split_for(item, own), f"{pointer}/points")
                    more: dict[str, Any] = {}
                else:
                    points, more = shapes.controls_of(item)
                named = {"name": item.name or item.layer, **plain, **more, "points": points * self.drawing.factor}
                found.append((named, item))
        self._use([item for _, item in found if item is not None], f"carried {kind}")
        self.notes.append(
            f"geometry[{number}]: {count(len(found), kind)} {'moves' if len(found) == 1 else 'move'} with the particles"
        )
        return found


def _plain(term: Term, pointer: str) -> None:
    if term.feature:
        raise InputError(pointer, f'"{term}" selects points; {term.feature}: is allowed in points = only')
