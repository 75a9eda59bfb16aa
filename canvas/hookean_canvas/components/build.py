"""Everything a person installs, from the bundles: user objects for each Rhino, and packages for its package manager."""

from __future__ import annotations

import os
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import hookean
from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.components import userobject, yak
from hookean_canvas.components.bundles import Bundle, read_all
from hookean_canvas.components.inline import Flavour
from hookean_canvas.inspect import lint

DESCRIPTION = "Particle-spring form finding: cables, nets, membranes and shells relax to equilibrium on the canvas."
TAGS: dict[Flavour, str] = {"rhino8": "rh8-any", "rhino7": "rh7-any"}
FOLDER = "Hookean"  # below UserObjects
PLUGIN = "Grasshopper (b45a29b1-4343-4035-989e-044e8580d9cf)"
"""Grasshopper's folder on a Mac, below the plug-ins of a Rhino."""


@dataclass(frozen=True)
class Built:
    """What a build wrote: user objects and packages."""

    user_objects: tuple[Path, ...]
    packages: tuple[Path, ...]


def build(output: Path, bundles: list[Bundle] | None = None) -> Built:
    """Write `rhino8/*.ghuser`, `rhino7/*.ghuser` and a package of each to the folder `output`.

    The folders rhino8 and rhino7 are replaced; the same bundles give the same bytes. InputError where a bundle is
    wrong, or where a file as read back does not pass `lint.faults`.
    """
    bundles = read_all() if bundles is None else bundles
    if not bundles:
        raise InputError("components", "hold no bundle; there is nothing to build.")
    written: list[Path] = []
    packages: list[Path] = []
    for flavour in userobject.BASES:
        folder = output / flavour
        for stale in folder.glob("*.ghuser"):
            stale.unlink()
        folder.mkdir(parents=True, exist_ok=True)
        files = [_write(folder, bundle, flavour) for bundle in bundles if fits(bundle, flavour)]
        written += files
        package = output / yak.file_name(hookean.__version__, TAGS[flavour])
        content = {path.name: path.read_bytes() for path in files}
        icon = next((b.icon for b in bundles if b.folder == "Engine"), bundles[0].icon)
        yak.write(package, content, hookean.__version__, DESCRIPTION, icon)
        packages.append(package)
    return Built(tuple(written), tuple(packages))


def fits(bundle: Bundle, flavour: Flavour) -> bool:
    """Whether a component exists in a flavour: Rhino 7 cannot install the packages that some ask for."""
    return flavour == "rhino8" or not bundle.rhino8_only


def install(rhino: int, folder: Path | None = None) -> list[Path]:
    """Write the user objects for a Rhino into Grasshopper's folder (none: where it is found), in one of their own.

    InputError where no Grasshopper is found.
    """
    target = folder or user_objects_folder(rhino)
    if target is None or not target.is_dir():
        where = f"{target} does not exist" if folder else "it was not found on this machine"
        raise InputError(
            "UserObjects",
            f"{where}; in Grasshopper, File > Special Folders > User Object Folder opens it: give it with --folder, "
            "or copy the .ghuser files of `hookean canvas build` there.",
        )
    flavour: Flavour = "rhino7" if rhino == 7 else "rhino8"
    place = target / FOLDER
    place.mkdir(exist_ok=True)
    for stale in place.glob("Hookean_*.ghuser"):
        stale.unlink()
    return [_write(place, bundle, flavour) for bundle in read_all() if fits(bundle, flavour)]


def user_objects_folder(
    rhino: int, system: str = sys.platform, environment: Mapping[str, str] = os.environ
) -> Path | None:
    """Where Grasshopper keeps user objects: one folder for all Rhinos on Windows, one each on a Mac; else None."""
    if system == "win32" and environment.get("APPDATA"):
        return Path(environment["APPDATA"]) / "Grasshopper" / "UserObjects"
    if system == "darwin" and environment.get("HOME"):
        rhinos = Path(environment["HOME"]) / "Library" / "Application Support" / "McNeel" / "Rhinoceros"
        return rhinos / f"{rhino}.0" / "Plug-ins" / PLUGIN / "UserObjects"
    return None


def _write(folder: Path, bundle: Bundle, flavour: Flavour) -> Path:
    """Write one user object and read it back; InputError where it does not pass the checks."""
    path = folder / userobject.file_name(bundle)
    archive.write(userobject.user_object(bundle, flavour), path)
    faults = lint.faults(archive.read(path))
    if faults:
        path.unlink()
        raise InputError(f"{bundle.folder} ({flavour})", f"{'; '.join(faults)}.")
    return path
