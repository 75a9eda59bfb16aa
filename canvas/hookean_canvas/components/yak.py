"""Packages for Rhino's package manager (yak): a zip with a manifest, the same bytes from the same files.

Rules: developer.rhino3d.com, "The Package Manifest" and "The Anatomy of a Package".
"""

from __future__ import annotations

import json
import re
import zipfile
from collections.abc import Mapping
from pathlib import Path

from hookean.errors import InputError

NAME = "hookean"
DATE = (1980, 1, 1, 0, 0, 0)  # of every file; a zip knows no earlier one
KEYWORDS = ("form finding", "particle-spring", "relaxation", "cable net", "membrane", "shell")


def file_name(version: str, tag: str) -> str:
    """The name of a package, such as `hookean-0.1.0-rh8-any.yak`."""
    return f"{NAME}-{version}-{tag}.yak"


def manifest(version: str, description: str) -> str:
    """The text of manifest.yml; raises InputError for a version that the package manager does not accept."""
    if not re.fullmatch(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?", version):
        raise InputError("version", f"{version!r} is not a semantic version; write it like 1.2.3 or 1.2.3-beta.1.")
    lines = [f"name: {NAME}", f"version: {version}", "authors:", "  - hookean"]
    lines += [f"description: {json.dumps(description)}", "keywords:", *(f"  - {word}" for word in KEYWORDS)]
    return "\n".join([*lines, "icon: icon.png"]) + "\n"


def write(path: Path, files: Mapping[str, bytes], version: str, description: str, icon: bytes) -> None:
    """Write a package of `files` (bytes by name; plug-ins and user objects stand at the top)."""
    content = {**files, "icon.png": icon, "manifest.yml": manifest(version, description).encode("utf-8")}
    with zipfile.ZipFile(path, "w") as package:
        for name in sorted(content):
            entry = zipfile.ZipInfo(name, DATE)
            entry.external_attr = 0o644 << 16
            entry.create_system = 3  # the same on every system
            entry.compress_type = zipfile.ZIP_DEFLATED
            package.writestr(entry, content[name], compresslevel=9)
