"""Write the force bundles from the force classes and draw the icon of every bundle in this folder.

python components/generate.py          write what differs
python components/generate.py --check  only say what differs; exit code 1 if anything does
"""

import sys
from pathlib import Path

from hookean_canvas import force_bundles, icons

HERE = Path(__file__).resolve().parent


def main(arguments):
    """Bring the bundles up to date; 1 where something differs and nothing may be written."""
    check = "--check" in arguments
    stale = []
    for folder, files in sorted(force_bundles.files().items()):
        for name, text in sorted(files.items()):
            path = HERE / folder / name
            if not path.is_file() or path.read_bytes() != text.encode("utf-8"):
                stale.append((path, text.encode("utf-8")))
    bundles = {path.parent.name for path in HERE.glob("*/metadata.json")} | set(force_bundles.files())
    for folder in sorted(bundles):
        path, icon = HERE / folder / "icon.png", icons.png(folder)
        if not path.is_file() or not icons.same_picture(path.read_bytes(), icon):
            stale.append((path, icon))
    for path, data in stale:
        if not check:
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(data)
        print(path.relative_to(HERE).as_posix() + (" differs" if check else ""))
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
