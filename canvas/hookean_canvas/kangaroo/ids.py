"""Ids by which Kangaroo's components are known in files, for `hookean canvas import` and `show`.

Read from public definitions (github.com/naysok/Study-Kangaroo: 126 files of both generations) and from a public listing
of Rhino's components (github.com/hellguz/ScriptBridgeJS, gh_docs_generation). Other classic components are known by
their library and name.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal
from uuid import UUID

from hookean.errors import InputError
from hookean_canvas import archive
from hookean_canvas.archive import Chunk
from hookean_canvas.archive.chunk import CLUSTERS
from hookean_canvas.archive.guids import CLUSTER, PANEL, SCRIBBLE
from hookean_canvas.kangaroo.solver_scripts import used_by

CLASSIC_LIBRARY = UUID("6bb8ff08-9dd5-cccd-7191-72c85ccf8b6a")
SECOND_LIBRARY = UUID("c2ea695e-1a09-6f42-266d-113498879f60")
Generation = Literal["classic", "second", "engineering"]

GENERATIONS: dict[Generation, str] = {
    "classic": "Kangaroo 0.099",
    "second": "Kangaroo 2",
    "engineering": "K2Engineering",
}

_CLASSIC = """
0db23e16-f91a-4105-3067-8d7ab0c60e4f KangarooPhysics
3aee0d21-e730-472d-bbbc-ed14d1d835ed Kangaroo Settings
c5a96f87-dae5-407c-9180-0c0e6ef7ddf9 SpringsFromLine
3ba652e9-f566-441d-8d04-02151edf69b4 SpringsFromLine
e097cb71-d5d0-4bba-a0d3-a35fae35b384 UnaryForce
7a01aec4-142c-4319-836d-a550b6b63d2d removeDuplicatePts
7a02aec5-143c-4319-836d-a550b6b65d1d removeDuplicateLines
502f3639-bf2e-4c15-b50f-a14c8344edea MeshMachine
459a1da8-409f-491d-b264-367952758072 Sequence
7201e22c-8588-4385-a080-78fbe7b7b6d7 Counter
d357c146-402e-4fbd-abfb-d7e5d4514181 Trail
3ec0b1a3-d39a-4a47-abe2-96f68d5053c8 Combine&Clean
6d5fdb14-6456-4817-999e-813d58655f8a RefineStrips
1ec4ad46-0e55-487a-b2de-ed94650420b4 Refine
f792e9d1-1f8d-4f79-a4a2-91b9474858be NakedVertices
7d7418df-2bd6-40bf-9edb-8f4d626b18ee HingePoints
ffa8c1b0-a6db-438f-893b-15203b0b55f0 WarpWeft
2af1f7ef-7321-4193-b4be-e97410eb9905 FoldAngle
"""
_SECOND = """
c681ef8e-fbf7-4277-a6a8-8a00d94cc953 Length(Pts)
559ec10e-2671-4bba-b5a7-11816e8fb17b RigidBody
eda40a97-17ec-4a46-99bc-21d952b80ece AlignFaces
3f8b0f83-6e8e-4a9d-b0ff-9474cc9eb89b Beam
ec32b3f0-38ac-4c29-9af8-1043d66ff3c5 Concentric
76b38cca-507d-409e-a773-044b2577d0b4 RigidBody
e245de5b-6d3b-48d3-8092-3bf0202ebf8f RigidBody
b01ceba0-0bff-4901-af2a-daca22f8fc07 RigidBodyCollide
8aa5774d-422a-433b-9a3f-667946bde157 RigidPointSet
81cc6201-6cda-4954-8503-66be5363aac8 SolidPlaneCollide
0b3b7956-f88b-4ca3-99f6-b6508a8dac3f Support
c41696fc-e8e8-42c9-89b2-a5a6aac030b0 Support
f5f95b51-7431-4e80-a32f-d33e5dee53a5 Angle
c5ca5c17-3d7c-4848-b994-a7406dc519ed AngleSnap
d228945d-3133-412f-9283-d2ac418e82a2 ClampAngle
f8e123b6-517c-409a-9a2f-c3acf58617cd EqualAngle
8abedb3c-ff82-46ea-8f77-fcb236b55d89 G2
51cbcf97-8cf9-4f52-9941-a9b484593db2 Rod
6e9f7437-714b-4140-99e8-0842de58f59c CoCircular
236d3928-a06f-4c60-bd2d-787691421391 CoLinear
8f78572b-7fd0-4795-b444-3de3ca5933ae CoPlanar
dd500398-727a-466f-9b51-83634266a83a CoSpherical
4dd9ea95-2ec8-44e3-a772-0e5889d95344 Collide2d
94bf912d-4d0c-4764-a100-5813a98a8b73 Collider
da30b731-7ec7-4cd5-88e6-a6009a681a13 CurveCollide
02b1c69b-b3f7-4528-988e-449a59963e5e CurvePointCollide
cb643f13-4969-4688-928f-5dd1dcbc8517 ImageCircles
86cee9bc-ba05-49ff-ad55-895ae66cc978 SoftBodyCollide
763c5b56-3dc6-4fe0-be7b-6b60cd27f744 SolidPointCollide
4b106d6a-0e09-4edc-941c-27d734ac4d59 SphereCollide
0822cf4a-be2e-4352-aed2-dad197f0611e ClampLength
c9cf79b9-eced-4591-8f8e-641739df0211 ConstantTension
6d36a97d-811f-423a-a4a1-35a7a7637697 Direction
7db2c4c9-15b5-4378-8495-a8f9a8db5723 DynamicWeight1d
537e7b52-4f3e-4bb6-b5f5-98233a66b79d EqualLength
091bae84-8fa9-4b35-8aad-b25b859055f6 Length(Line)
09fef083-0d7b-4e3d-a24c-928a19a71aed LengthRatio
5fa0d301-9b28-47ce-a281-5292c1b1364b LengthSnap
030749a0-2773-45d3-9647-d37662d2ad4c PlasticLength
54443347-13e2-4ad6-b68f-53c878d32c84 Conicalize
15ab0db0-5093-4a37-854a-cee70457a847 CyclicQuad
5d81faae-befc-4c12-b558-beaf2ebee8f1 CyclicQuad
856bd786-9f29-4052-b721-0d64b7b3f3ea Developablize
24e2b0d2-d7b8-4478-8a83-1f04cba701a1 EdgeLengths
b6b6632e-a164-491a-8874-9a214dcc79bc Hinge
9103348d-9ec2-4937-a04f-79c509f8093c Isothermic
b2389d9a-c991-4175-a35f-0d23443a15d2 LiveSoap
8f083dbb-357b-4172-80d0-b584b21b6d75 NoFoldThrough
e29cdc8a-b58e-4854-aa1d-f09b43a9b6a3 Planarize
69a52798-b567-4a36-b5b4-7614bea071bc PlasticHinge
f4b4e68f-150f-4c3f-bc52-cf5ec4047f79 PolygonArea
2e1fb4fb-22a8-4853-a9f5-ab65602aad77 Pressure
0b7b2ba2-7ecd-4f33-b138-883f6e96d08c Smooth
0c68b153-3c88-4e62-9827-f3793c013f88 SoapFilm
76ab889c-8593-4892-861d-a80b5311a981 SoapFilm
3962cf86-9b9e-41d7-94f9-42bd0326291d TangentIncircles
56e9e40d-6d2f-4daf-9316-034f30cf24a0 TangentIncircles
72dadfdd-3be9-44e3-a352-9343f3d5d3b1 TangentialSmooth
2b3f5029-cfec-4f95-96d1-757bd9c51da1 VertexLoads
26efde70-0c5c-4181-af3e-1a767d64b449 Volume
928b2951-2a01-4b6b-8ccb-6fbeb3e490ad Wind
8b4dbe32-0c6c-4304-972e-3f60ed613114 OnCurve
6c1c3018-487b-4573-afc5-3af263ae5808 OnMesh
d4d13384-1914-42ed-b1f2-687c1959bd14 OnPlane
3c30b1a1-4473-4ad4-a700-ea9770726c03 Anchor
b476d3d0-4daf-489c-b91a-49f5dd72a256 Anchor
2128cde3-9694-40b0-874c-670c89341acd AnchorXYZ
2f3fd2e9-2cc4-47be-af5a-2f3916f76a92 Bomb
c955cf0a-2294-423d-bf1a-fc5cba5d2103 Coincident
14ac13f4-c22d-487c-be01-c6daf952f1be Floor
780a08f2-c42d-4b8e-b8c9-8b3e09c318d0 FloorFriction
2019c995-53af-4eb2-976d-95b1fdc823fa Load
580a1a0c-314d-4033-a54c-c129400b4b58 Load
28bedc62-006a-4f19-b97d-e12b20aff875 MagnetSnap
76469b0a-11f0-4b8e-ad65-31a555d4cddd PlasticAnchor
c2d6c6db-37d4-4c95-928f-7afc27842a1e PlasticAnchor
5002d2f7-7878-4965-98ab-2403503891ab Transform
0febdb68-70bd-4882-b5e4-f68d1cddc4ae BouncySolver
3d13a415-6ac5-4b59-9677-3975e4696a85 Grab
4c53ba00-f4bd-4ede-8d26-55106278268d Grab
4c90aad1-0748-4800-99db-a27d690bb1e1 Grab
ea145d1d-7727-4d52-8db6-c9b7100ab7f9 Grab
0ed5e67d-539d-480e-88cb-d81fa795d66c Show
35c49588-244d-43a4-81b2-fd3ef59c1b1d Soft & Hard Solver
313490f5-8e38-4dde-9e9a-05e4d739b35d Solver
8f9f19c0-207a-419d-90f6-2fcadaa845f9 Solver
a54d250e-e285-4f38-9fb3-8dd9c886c659 Solver
fa27771b-cf25-4a21-bf31-8bb20a7822b3 StepSolver
4408343b-577e-4fd8-96ff-df7549189186 ZombieSolver
8cb1880b-464e-470e-87af-ea27ae95132d Bipartite
5a4ba654-7203-474d-83d6-7f1cdfc0a41f ByParent
c0139ec9-4e5a-4978-ab5f-31f5deb9ba4e Checkerboard
2491e794-8360-4317-b0ad-4950f6e0906a Combine&Clean
77e9376b-a397-4010-9b2c-dd0326107a91 Diagonalize
f3fcd287-f1f2-4b76-84ac-e7dd462979fa FaceFaceOffset
b09481df-b73c-4889-b2d7-6ed306beddad FoldAngle
24f82a13-a700-45e0-9528-8646323d4af2 HingePoints
c8b01cec-6dd9-460b-b43f-254314ffdc2e MeshCorners
9c2695de-127b-4b46-a17b-f3a676891c0d MeshDirection
ab723d11-5713-4df2-9d3c-b8bbb3bb5d61 MeshMap
bf54f98d-2fc0-4cb8-91b9-29619a2c6005 MeshTurn
ddb24b31-1192-448f-ace3-b5b3d2399831 NakedVertices
97253642-cb05-43e6-bc79-4bd0306441e5 PlanarityAnalysis
6003658a-c422-41cf-8a2f-8e106b09cc10 Refine
39a12e0c-25a7-43ce-9546-115f3a211a0c RefineStrips
f4d3e531-f23d-495d-8362-d7145e9f762e RemeshByColour
d3ed43b3-73db-4259-82dd-26005879c0a2 Simple
87c0cc0e-d792-481e-b219-cc16b3e7b7b9 SimpleRemesh
c8514ca2-3243-487a-becc-c07a4083db94 Stripper
bdda1028-13e6-41ee-b410-701234f9d39f TangentCircles
dca330b6-f705-4d5e-b9d4-ea90c915ddaf Unroller
fecd8879-9e63-4ff9-a16e-fe85bb0de884 VertexNeighbours
cb7c0f04-123f-4b12-8f81-583b9fc793be WarpWeft
866222ee-6093-4af8-8944-2f9264885385 TriRemesh
4bfe1bf6-fbc9-4ad2-bf28-a7402e1392ee MultiPipe
f1b75016-5818-4ece-be56-065253a2357d MultiPipe
74953dd1-9af7-4736-983c-f258302de692 SplitAtCorners
5e2f9e3f-d467-46f6-870c-6fa7cd01e1ed removeDuplicatePts
5b882297-9063-439e-82b9-70961f743c5d removeDuplicateLines
"""

_ENGINEERING = """
7ecb0b99-b4b4-4655-bded-5595997e820a Materials
c2bd6c3c-314b-47c2-b716-5b0f2f532e7f AxialVisualisation
64e19caa-a444-4ac4-bbc1-5bf4d62dd406 Load
d18d48d0-d9ed-4f1f-9712-70fd08a395c1 Displacements
a2896665-2ab3-4dd6-b660-a69395cdf868 BarSelfweight
40f42bcb-17c5-463b-bbe7-39aea9f7a2d6 CircularCS
2672a780-8cb4-4da5-bd5f-67ddcbeed60b Support
84466009-1456-467c-8f43-8a13b1161b5a BarLength
ab0bb292-8e4a-46d3-8890-955f0c00bc9b SupportOutput
95d2e6d6-399c-4ec4-843f-fc6335ced616 BarOutput
f76cfabb-06ab-4869-a60d-c6c4865320ea Beam
098b1b46-32dd-4f90-b4ac-c05d6609ea64 BeamOrientation
3e9e7e8a-5f44-4409-93d6-4750f4bb954a Support6DOF
b2c01d87-2e99-4bdd-82af-247158b8d19a RectangularCS
000e9754-d494-431d-8f4a-5760b976d0bb Support6DOFOutput
d64e3058-838d-4eec-8163-5e65a33f090c BeamOutput
ed49e8dd-2c0f-444c-947a-c582a1676b1e BendingVisualisation6DOF
c0cc73f2-a542-44de-98d4-05a828cde909 DisplacementVisualisation
ccf6dc32-7c3c-4836-94c2-e43e1e3c4f0d Bar
efc6c913-9056-4825-b417-01083d2316bc Cable
824f9e75-7bda-4760-bb73-ae2b40c1754b Rod
280510b1-3f9e-42a0-a30d-2282ebae97b5 RodOutput
d9f0db2c-973c-4516-8fd4-34719d5a6b0e BendingVisualisation
058fb304-139f-4a9c-ac05-d8a7506fb3b6 TransformMoment
81e1fe0e-6f4d-4539-898a-5549eec9f351 Pretension
9881eebc-de15-4d78-a45f-3375efbeb5a9 MeshVertexArea
a8003bae-380e-4ddd-aefe-85384e84d79c MeshSnowLoad
4f5d8b78-cd64-42e5-9e42-9bdb884ccd3e MeshWindLoad
92f22337-5926-4e02-9c9d-a853eb62f980 Shear
d488d4b0-242c-4aeb-bace-6c65ab059d5a ShearVisualisation
"""


@dataclass(frozen=True)
class Known:
    """A component of Kangaroo, or of K2Engineering, its plug-in: of which generation, and its name."""

    generation: Generation
    name: str


def _table(generation: Generation, text: str) -> dict[UUID, Known]:
    lines = (line.split(" ", 1) for line in text.strip().splitlines())
    return {UUID(guid): Known(generation, name) for guid, name in lines}


def key(name: str) -> str:
    """A name as the tables of the import have it: lower case, without spaces."""
    return "".join(name.lower().split())


COMPONENTS: dict[UUID, Known] = (
    _table("classic", _CLASSIC) | _table("second", _SECOND) | _table("engineering", _ENGINEERING)
)


def libraries(definition: Chunk) -> dict[UUID, Generation]:
    """The libraries of Kangaroo by id: the two known ones, and any that a definition lists under such a name."""
    found: dict[UUID, Generation] = {CLASSIC_LIBRARY: "classic", SECOND_LIBRARY: "second"}
    listed = definition.chunk("GHALibraries")
    for library in listed.chunks if listed is not None else ():
        name = str(library.value("Name", default=""))
        if "k2eng" in name.lower():
            found[library.value("Id")] = "engineering"
        if "kangaroo" in name.lower() and library.value("Id") not in found:
            found[library.value("Id")] = "second" if "2" in name else "classic"
    return found


def recognised(thing: Chunk, of: dict[UUID, Generation]) -> Known | None:
    """Which component of Kangaroo an object of a definition is; None for every other one."""
    known = COMPONENTS.get(thing.value("GUID"))
    generation = of.get(thing.value("Lib", default=UUID(int=0)))
    if known is None and generation is not None:
        return Known(generation, str(thing.value("Name", default="a component without a name")))
    return known


def hidden(thing: Chunk, of: dict[UUID, Generation], depth: int = 0) -> str | None:
    """What of Kangaroo an object carries without being of it, in words: parts of a cluster, imports of a script."""
    container = thing.chunk("Container")
    if container is None or thing.value("GUID") in (PANEL, SCRIBBLE):
        return None
    document = container.value("ClusterDocument")
    if document is not None:
        try:
            inside = archive.of_bytes(document, "cluster") if isinstance(document, bytes) and depth < CLUSTERS else None
        except InputError:
            inside = None
        if inside is None:
            return "a cluster that cannot be opened; it may hold components of Kangaroo"
        names = _names(inside, of, depth + 1)
        return f"a cluster that holds {', '.join(names)} of Kangaroo" if names else None
    return used_by(container) if thing.value("GUID") != CLUSTER else None


def _names(inside: Chunk, of: dict[UUID, Generation], depth: int) -> list[str]:
    found = []
    for thing in inside.walk():
        if thing.name == "Object":
            known = recognised(thing, of | libraries(inside))
            words = None if known else hidden(thing, of, depth)
            found += [known.name] if known else [words] if words else []
    return found
