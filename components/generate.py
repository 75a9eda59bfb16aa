"""Write the force bundles from the force classes, draw the icon of every bundle and list all in README.md.

python components/generate.py          write what differs
python components/generate.py --check  only print what differs; exit code 1 if anything does
"""

import json
import sys
from pathlib import Path

from hookean_canvas.components import bundles
from hookean_canvas.components import force_bundles
from hookean_canvas.components import icons

HERE = Path(__file__).resolve().parent
BEGIN, END = "<!-- all components, by generate.py -->\n", "<!-- end -->\n"


def main(arguments):
    """Bring bundles and page up to date; 1 where something differs and nothing may be written."""
    check = "--check" in arguments
    stale = [found for make in (forces, drawn, listed) for found in written(make(), check)]
    return 1 if check and stale else 0


def written(files, check):
    """The files that differ on the disk; they are printed, and written unless only checked."""
    stale = [(path, data) for path, data in files if not path.is_file() or path.read_bytes() != data]
    for path, data in stale:
        if not check:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
        print(path.relative_to(HERE).as_posix() + (" differs" if check else ""))
    return stale


def forces():
    """Code and metadata of every force."""
    found = force_bundles.files()
    return [(HERE / f / name, text.encode("utf-8")) for f in sorted(found) for name, text in sorted(found[f].items())]


def drawn():
    """The icon of every bundle; one that shows the same is left as it is."""
    folders = {path.parent.name for path in HERE.glob("*/metadata.json")} | set(force_bundles.files())
    for folder in sorted(folders):
        path, icon = HERE / folder / "icon.png", icons.png(folder)
        same = path.is_file() and icons.same_picture(path.read_bytes(), icon)
        yield path, path.read_bytes() if same else icon


def listed():
    """The page with the table of all bundles."""
    readme = HERE / "README.md"
    if not readme.is_file():
        return []
    rows = ["| panel | component | nickname | description |", "| --- | --- | --- | --- |"]
    found = [json.loads(path.read_text(encoding="utf-8")) for path in HERE.glob("*/metadata.json")]
    for panel in bundles.SUBCATEGORIES:
        for entry in sorted((e for e in found if e.get("subcategory") == panel), key=lambda e: e["name"]):
            told = entry["description"].split("\n")[0].replace("|", "\\|")
            rows.append("| {} | {} | {} | {} |".format(panel, entry["name"], entry["nickname"], told))
    text = readme.read_text(encoding="utf-8")
    before, rest = text.split(BEGIN)
    made = before + BEGIN + "\n" + "\n".join(rows) + "\n\n" + END + rest.split(END)[1]
    return [(readme, made.encode("utf-8"))]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
