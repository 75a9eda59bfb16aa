"""A hypar roof on one page: form, cases, checks, cable lengths, cutting patterns and report, from the model and recipe
beside this file: `python page.py [FOLDER [PROCESSES]]`; several processes pay from some thousand particles on."""

import sys
from concurrent.futures import ProcessPoolExecutor
from contextlib import nullcontext
from multiprocessing import get_context
from pathlib import Path

import hookean
from hookean.files.limits import read_limits
from hookean.files.relax_file import read_scene
from hookean.files.report import report
from hookean.files.sheets import write_sheets
from hookean.files.tables import csv_text
from hookean.scene.scene import Scene
from hookean.workshop.patterns import strains

HERE = Path(__file__).parent
PRESTRESS, STIFFNESS, POISSON = (3.0, 3.0), (800.0, 600.0), 0.3  # kN/m, of the cloth along warp and weft
SIDE, WIDTH, ALLOWANCE = 10.0, 1.2, 0.04  # m, of the roof, of a strip of cloth, and for its seams


def design(scene: Scene, folder: Path, processes: int = 1) -> hookean.LoadCases:
    """Take a roof from its form to what the workshop needs; the files are written to `folder`."""
    with ProcessPoolExecutor(processes, get_context("spawn")) if processes > 1 else nullcontext() as pool:
        if pool is not None:
            pool.submit(strains, PRESTRESS, STIFFNESS)  # the processes start, and import, while the form is found
        cases = hookean.load_cases(scene, list(scene.combinations), executor=pool)
        strips = pool.submit(cut, cases.form, folder) if pool is not None else None
        limits = read_limits((HERE / "limits.toml").read_text(encoding="utf-8"))
        page = report(scene, title="Hypar roof", limits=limits, cases=cases)
        said = cut(cases.form, folder) if strips is None else strips.result()
    (folder / "report.html").write_text(page, encoding="utf-8")
    ropes = hookean.cables(cases.frozen)
    (folder / "cables.csv").write_text(csv_text(ropes.table()), encoding="utf-8")
    print(cases.envelope)
    print("\n".join(said))
    return cases


def cut(form: hookean.Result, folder: Path) -> list[str]:
    """Cut the form into strips and write them; returns a few lines about them."""
    compensation = strains(PRESTRESS, STIFFNESS, POISSON)
    rows = round(len(form.particles) ** 0.5 * WIDTH / SIDE)  # of the mesh, to a strip
    strips = hookean.cutting_patterns(form, compensation=compensation, allowance=ALLOWANCE, rows=rows, mark_every=rows)
    write_sheets(strips, folder / "strips.dxf")
    (folder / "strips.csv").write_text(csv_text(strips.table()), encoding="utf-8")
    return strips.summary()


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    many = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    design(read_scene(HERE / "model.3dm", HERE / "recipe.toml"), target, many)
