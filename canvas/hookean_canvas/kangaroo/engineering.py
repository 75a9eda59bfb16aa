"""K2Engineering, a plug-in of goals with units for Kangaroo 2, for the tables of the import."""

from __future__ import annotations

from hookean_canvas.kangaroo import engineering_goals, engineering_tools
from hookean_canvas.kangaroo.pieces import Piece, Swap

_TOLD = "results are not rounded"


def _goal(helper: str, output: str, differs: str = "", /, exact: str = "", **inputs: str) -> Swap:
    """A script that makes our force; inputs of theirs that differ from ours by `e_modulus="e-modulus|e"` and so on."""
    given = {old: ours for ours, names in inputs.items() for old in names.split("|")}
    without = {"strength": exact} if exact else {}
    return Swap((Piece(helper, given, {"force": output}),), differs, without, dict.fromkeys(without))


def _tool(helper: str, outputs: str, differs: str = "", **inputs: str) -> Swap:
    given = {old: ours for ours, names in inputs.items() for old in names.split("|")}
    results = dict(pair.split("=", 1) for pair in outputs.split())
    return Swap((Piece(helper, given, results),), differs)


_MODULUS = {"e_modulus": "e-modulus|e", "area": "area|a"}
_HELD = {"x": "xfixed|x", "y": "yfixed|y", "z": "zfixed|z"}
_TURNED = {"rx": "rxfixed|rx", "ry": "ryfixed|ry", "rz": "rzfixed|rz"}
_NODES = {"normals": "vertexnormals|na", "option": "option|opt"}

ENGINEERING: dict[str, Swap] = {
    "bar": _goal("*bar", "b|bar", "springs with the axial stiffness EA", line="line|ln", **_MODULUS),
    "cable": _goal(
        "*cable",
        "cable",
        "springs in tension only, with the pre-tension at the start length",
        line="line|ln",
        pretension="pretension|p",
        **_MODULUS,
    ),
    "rod": _goal(
        "*rod",
        "r|rod",
        "bend with EI: the moment goes with the angle over the mean start length there, with its sine over the chord "
        "in K2Engineering; the same for small angles",
        linea="linea|lna",
        lineb="lineb|lnb",
        e_modulus="e-modulus|e",
        inertia="inertia|i",
        z_distance="z-distance|z",
        restangleoption="restangleoption|opt",
    ),
    "beam": _goal(
        "*beam",
        "beam",
        "beam: bending stays exact where beams move far; planes that are not square to their lines are beams bent in",
        startplane="startplane|startpln",
        endplane="endplane|endpln",
        e_modulus="e-modulus|e",
        g_modulus="g-modulus|g",
        a="a",
        iy="iy",
        iz="iz",
        it="it",
    ),
    "load": _goal("*load", "loadgoal|l", "unary", point="point|pt", nodalforce="nodalforce|f"),
    "support": _goal(
        "*support",
        "simplesupportgoal|s",
        "anchors, which hold exactly",
        exact="anchors hold exactly here, so they have no strength",
        point="pinnedsupportpt|supportpt|pt",
        **_HELD,
    ),
    "support6dof": _goal(
        "*support6",
        "support6dofgoal|s",
        "support, with the strength in N/m and N m",
        point="supportpt|pt",
        strength="strength",
        **_HELD,
        **_TURNED,
    ),
    "baroutput": _tool(
        "*baroutput", "line=line|ln axialforce=axialforce|f axialstress=axialstress|stressa", _TOLD, data="bardata|bd"
    ),
    "rodoutput": _tool(
        "*rodoutput",
        "planes=plane|pl bendingmoment=bendingmoment|m bendingstress=bendingstress|stressb",
        _TOLD,
        data="roddata|rd",
    ),
    "beamoutput": _tool(
        "*beamoutput",
        "p0=p0 p1=p1 n=n vy=vy vz=vz mt=mt my0=my0 mz0=mz0 my1=my1 mz1=mz1",
        f"{_TOLD}; shear forces act in a section: Vz = (My1 - My0) / l of the moments there, Vy likewise",
        data="beamdata|bd",
    ),
    "supportoutput": _tool(
        "*supportoutput", "supportpt=supportpt|pt reactionforce=reactionforce|rf", data="supportdata|sd"
    ),
    "support6dofoutput": _tool(
        "*support6output",
        "supportplane=supportplane|pl reactionforce=reactionforce|rf reactionmoment=reactionmoment|rm",
        data="support6dofdata|sd",
    ),
    "materials": _tool(
        "*material",
        "name=materialname|name density=density|rho modulus=young'smodulus|e shear=shearmodulus|g strength=strength|fy",
        "the shear modulus is E / (2 + 2 nu) for steel and aluminium (nu 0.3 and 0.33), and missing for others",
        materialindex="materialindex|matid",
    ),
    "circularcs": _tool(
        "*circle",
        "area=a|area inertia=i|inertia outer=z|zdist torsion=it",
        diameter="diameter|d",
        thickness="thickness|t",
    ),
    "rectangularcs": _tool(
        "*rectangle",
        "area=a|area iy=iy|i|inertia iz=iz torsion=it",
        "the torsion constant of boxes is Bredt's, of the wall's middle line",
        width="width|w",
        height="height|h",
        thickness="thickness|t",
    ),
    "barlength": _tool("*lengths", "points=points|pts nodallengths=nodallengths|nodelengths|l", bars="bars"),
    "barselfweight": _tool(
        "*weight",
        "nodalselfweight=nodalselfweight|fweight",
        nodallengths="nodallengths|l",
        area="crosssectionarea|a",
        density="materialdensity|rho",
    ),
    "beamorientation": _tool(
        "*frames",
        "startplane=startplane|startpln endplane=endplane|endpln",
        line="line|ln",
        flipvertical="flipvertical|flipv",
    ),
    "displacements": _tool(
        "*moved",
        "displacements=totaldisplacements|vdispl x=maximumdisplacementx|xmax y=maximumdisplacementy|ymax "
        "z=maximumdisplacementz|zmax",
        initial="initialpositions|pinit",
        final="finalpositions|pfinal",
    ),
    "pretension": _tool(
        "*tension",
        "distribution=ptdistribution|ptdistr",
        rest="restlength|l0",
        strength="strength|s0",
        length="fflength|l1",
        most="maxpretension|ptmax",
    ),
    "meshsnowload": _tool("*snow", "nodalload=nodalsnowload|fs", snow="snow|s", **_NODES),
    "meshwindload": _tool("*gusts", "nodalload=nodalwindload|fw", wind="wind|w", **_NODES),
    "transformmoment": _tool(
        "*moment", "transformed=transformedmoment|m2", moment="moment|m1", plane_1="plane1|pln1", plane_2="plane2|pln2"
    ),
}
"""What stands for each of its components, by the name in lower case without spaces."""

GOALS = frozenset(["bar", "cable", "rod", "beam", "load", "support", "support6dof", "pressure", "meshselfweight"])
"""Those that flow into a solver."""

_DRAWS = "it draws in Rhino's viewport, and its numbers still arrive; the Engine draws forces and reactions by itself"
_MESHES = "it takes a mesh of another plug-in, Plankton; Area Weight, Pressure and Wind Pressure share areas of a mesh"
REASONS: dict[str, str] = {
    **dict.fromkeys(
        (
            "axialvisualisation",
            "bendingvisualisation",
            "bendingvisualisation6dof",
            "displacementvisualisation",
            "shearvisualisation",
            "loadvisualisation",
        ),
        _DRAWS,
    ),
    "loadoutput": "the load is the vector that is wired into Load",
    "meshvertexarea": _MESHES,
    "meshselfweight": _MESHES,
    "shear": "it finds the rods of a line by rounded coordinates; Beam reports Vy and Vz",
    "pressure": "Pressure takes a mesh, in Pa; K2Engineering's takes a mesh with a gas law",
}
"""Why the others stay."""

HELPERS = {**engineering_goals.HELPERS, **engineering_tools.HELPERS}
TOLD = {helper: f"a script, {recipe.name}" for helper, recipe in HELPERS.items()}
_FORCES = {
    "*bar": "Springs", "*cable": "Springs", "*rod": "Bend", "*beam": "Beam", "*load": "Unary", "*support": "Anchors",
    "*support6": "Support",
}  # fmt: skip
TOLD |= {helper: f"{force}, by a script" for helper, force in _FORCES.items()}
"""What they are called in the table of the documentation."""
