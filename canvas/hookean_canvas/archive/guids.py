"""Every id a Grasshopper file knows things by: components, parameters, type hints, libraries.

Grasshopper documents none of them; each group names the public files it was read from. Ids are stable since 0.9
(2013) for its own components and since 8.0 (2023) for the scripts.
"""

from __future__ import annotations

import re
from uuid import UUID

from hookean_canvas.archive import native_guids, native_guids_more

# ------------------------------------------------------------------------------------------------ script components
# github.com/mcneel/rhinocodetests (Rhino 8 and 9 definitions), github.com/compas-dev/compas-actions.ghpython_components
SCRIPT = UUID("c9b2d725-6f87-4b07-af90-bd9aefef68eb")
PYTHON3_SCRIPT = UUID("719467e6-7cf5-4848-99b0-c5dd57e5442c")
IRONPYTHON_SCRIPT = UUID("97aa26ef-88ae-4ba6-98a6-ed6ddeca11d1")
CSHARP_SCRIPT = UUID("b6ba1144-02d6-4a2d-b53c-ec62e290eeb7")
GHPYTHON_SCRIPT = UUID("410755b1-224a-4c1e-a407-bf32fb45ea7e")  # Rhino 5 to 7

SCRIPT_PARAMETER = UUID("08908df5-fa14-4982-9ab2-1aa0927566aa")  # both sides of a Rhino 8 script
GHPYTHON_INPUT = UUID("84fa917c-1ed8-4db3-8be1-7bdc4a6495a2")
GHPYTHON_OUTPUT = UUID("8ec86459-bf01-4409-baee-174d0d2b13d0")  # Grasshopper's parameter for data of any type

# -------------------------------------------------------------------------------------------- what stands on a canvas
# Hops_Example.gh of github.com/mcneel/compute.rhino3d (MIT) and the definitions of rhinocodetests
NUMBER_SLIDER = UUID("57da07bd-ecab-415d-9d86-af36d7073abc")
BOOLEAN_TOGGLE = UUID("2e78987b-9dfb-42a2-8b76-3923ac8bd91a")
BUTTON = UUID("a8b97322-2d53-47cd-905e-b932c3ccd74e")
PANEL = UUID("59e0b89a-e487-49f8-bab8-b5bab16be14c")
VALUE_LIST = UUID("00027467-0d24-4fa7-b178-8dc0ac5f42ec")
GROUP = UUID("c552a431-af5b-46a9-a8a4-0fcbc27ef596")
SCRIBBLE = UUID("7f5c6c55-f846-4a08-9c9a-cfdc285cc6fe")
RELAY = UUID("b6236720-8d88-4289-93c3-ac4c99f9b97b")
CLUSTER = UUID("f31d8d7a-7536-4ac8-9c96-fde6ecda4d0a")
HOPS = UUID("c69bb52c-88ba-4640-b69f-188d111029e8")
TIMER = UUID("5a2b0735-ba98-4b7d-a7d3-c1dfc04475ad")
PARAM_VIEWER = UUID("72a29b54-2e48-474b-a400-d2124c4edf79")
GRAPH_MAPPER = UUID("bc984576-7aa6-491f-a91d-e444c33675a7")
DIGIT_SCROLLER = UUID("33bcf975-a0b2-4b54-99fd-585c893b9e88")
CONTROL_KNOB = UUID("bcac2747-348b-4edd-ae1f-77a782cebbdd")
GENE_POOL = UUID("21553c44-ea62-475e-a8bb-62b2a3ee5ca5")  # public code that drives optimisers by it

_SPECIAL = """
9c53bac0-ba66-40bd-8154-ce9829b9db1a Colour Swatch
6da9f120-3ad0-4b6e-9fe0-f8cde3a649b7 Gradient|Gradient Control
318dacd7-9073-4ede-b043-a0c132eb77e0 MD Slider
339c0ee1-cf11-444f-8e10-65c9150ea755 Colour Picker
51a2ede9-8f8c-4fdf-a375-999c2062eab7 Colour Wheel
d69a3494-785b-4beb-969b-d2373f65abfd Image Sampler
216bccd8-bf29-4d3c-b791-54c89a180db3 Image Resource
ab898d46-b8b3-4ed5-b28f-4f8047920262 Calendar
f8a94819-1e2b-4d67-9100-9e983ac493cc Clock
c7b5c66a-6360-4f5f-aa17-a918d0b1c314 Object Details
b8a66384-fc66-4574-a8a9-ad18e610d623 Import Coordinates
c2c0c6cf-f362-4047-a159-21a72e7c272a Import Image
317f1cb2-820d-4a8f-b5c8-5de3594ddfba Import 3DM
6587fcbf-e3cf-480a-b2f5-641794474194 Read File
65283518-ad00-49d3-87fb-f76823ebb162 Data Dam
ae2531b4-bab2-4bb1-b5bf-f2143d10c132 Context Bake
73215ec5-0eb5-4f85-9e07-b09c4590ce2b Context Print
a9a8ebd2-fff5-4c44-a8f5-739736d129ba C# Script
079bd9bd-54a0-41d4-98af-db999015f63d VB Script
"""

# ------------------------------------------------------------------------------------------------ floating parameters
# the same files; those they lack are of public listings of the tab "Params" that agree with them on all the others
_PARAMETERS = """
3e8ca6be-fda8-4aaf-b5c0-3c54c8bb7312 Number
2e3ab970-8545-46bb-836c-1c11e5610bce Integer
cb95db89-6165-43b6-9c41-5702bc5bf137 Boolean
3ede854e-c753-40eb-84cb-b48008f14fd4 Text|String
8ec86459-bf01-4409-baee-174d0d2b13d0 Data|Generic Data
203a91c3-287a-43b6-a9c5-ebb96240a650 Colour
15b7afe5-d0d0-43e1-b894-34fcfe3be384 Domain
fa36c19d-b108-440c-b33d-a0a4642b45cc Domain²
90744326-eb53-4a0e-b7ef-4b45f5473d6e Domain²
476c0cf8-bc3c-4f1c-a61a-6e91e1f8b91e Complex
81dfff08-0c83-4f1b-a358-14791d642d9e Time
bd4a8a18-a3cc-40ba-965b-3be91fee563b Matrix
06953bda-1d37-4d58-9b38-4b3c74e54c8f File Path
56c9c942-791f-4eeb-a4f0-82b93f1c0909 Data Path|Path
faf6e3bb-4c84-4cbf-bd88-6d6a0db5667a Guid
7fa15783-70da-485c-98c0-a099e6988c3e Culture
288cfe66-f3dc-4c9a-bb96-ef81f47fe724 Shader|Material
fbac3e32-f100-4292-8692-77240a42fd1a Point
16ef3e75-e315-4899-b531-d3166b42dac9 Vector
4f8984c4-7c7a-4d69-b0a2-183cbb330d20 Plane
8529dbdf-9b6f-42e9-8e1f-c7a2bde56a70 Line
04d3eace-deaa-475e-9e69-8f804d687998 Circular Arc|Arc
d1028c72-ff86-4057-9eb0-36c687a4d98c Circle
abf9c670-5462-4cd8-acb3-f1ab0256dbf3 Rectangle
d5967b9f-e8ee-436b-a8ad-29fdcecf32d5 Curve
deaf8653-5528-4286-807c-3de8b8dad781 Surface
919e146f-30ae-4aae-be34-4d72f555e7da Brep
1e936df3-0eea-4246-8549-514cb8862b7a Mesh
e02b3da5-543a-46ac-a867-0ba6b0a524de Mesh Face
fa20fe95-5775-417b-92ff-b77c13cbf40c Mesh Point
89cd1a12-0007-4581-99ba-66578665e610 SubD
c9482db6-bea9-448d-98ff-fed6d69a8efc Box
6db039c4-cad1-4549-bd45-e31cb0f71692 Twisted Box
ac2bc2cb-70fb-4dd5-9c78-7e1ea97fe278 Geometry
b341e2e5-c4b3-49a3-b3a4-b4e6e2054516 Geometry Pipeline
f91778ca-2700-42fc-8ee6-74049a2292b5 Geometry Cache
b0851fc0-ab55-47d8-bdda-cc6306a40176 Group
28f40e48-e739-4211-91bd-f4aefa5965f8 Transform
3175e3eb-1ae0-4d0b-9395-53fd3e8f8a28 Field
87391af3-35fe-4a40-b001-2bd4547ccd45 Location
c3407fda-b505-4686-9165-38fe7a9274cf Mesher Settings
"""

# --------------------------------------------------------------------------------------------------------- libraries
# GHALibraries of the definitions above
SCRIPT_LIBRARY = UUID("066d0a87-236f-4eae-a0f4-9e42f5327962")
HOPS_LIBRARY = UUID("82cb7266-a8bc-4d3e-99f6-b91504c7117f")
LIBRARIES = {SCRIPT_LIBRARY: "RhinoCodePluginGH", HOPS_LIBRARY: "Hops"}

# -------------------------------------------------------------------------------------------------------- type hints
# componentize_cpy.py and componentize_ipy.py of compas-actions.ghpython_components, checked on the 197 user objects of
# compas, ladybug-grasshopper and honeybee-grasshopper-core
HINTS = {
    "none": UUID("6a184b65-baa3-42d1-a548-3915b401de53"),
    "ghdoc": UUID("1c282eeb-dd16-439f-94e4-7d92b542fe8b"),
    "float": UUID("9d51e32e-c038-4352-9554-f4137ca91b9a"),
    "str": UUID("3aceb454-6dbd-4c5b-9b6b-e71f8c1cdf88"),
    "bool": UUID("d60527f5-b5af-4ef6-8970-5f96fe412559"),
    "int": UUID("48d01794-d3d8-4aef-990e-127168822244"),
    "complex": UUID("309690df-6229-4774-91bb-b1c9c0bfa54d"),
    "datetime": UUID("09bcf900-fe83-4efa-8d32-33d89f7a3e66"),
    "guid": UUID("5325b8e1-51d7-4d36-837a-d98394626c35"),
    "color": UUID("24b1d1a3-ab79-498c-9e44-c5b14607c4d3"),
    "point": UUID("e1937b56-b1da-4c12-8bd8-e34ee81746ef"),
    "vector": UUID("15a50725-e3d3-4075-9f7c-142ba5f40747"),
    "plane": UUID("3897522d-58e9-4d60-b38c-978ddacfedd8"),
    "interval": UUID("589748aa-e558-4dd9-976f-78e3ab91fc77"),
    "uvinterval": UUID("74c906f3-db02-4cea-bd58-de375cb5ae73"),
    "box": UUID("f29cb021-de79-4e63-9f04-fc8e0df5f8b6"),
    "transform": UUID("c4b38e4c-21ff-415f-a0d1-406d282428dd"),
    "line": UUID("f802a8cd-e699-4a94-97ea-83b5406271de"),
    "circle": UUID("3c5409a1-3293-4181-a6fa-c24c37fc0c32"),
    "arc": UUID("9c80ec18-b48c-41b0-bc6e-cd93d9c916aa"),
    "polyline": UUID("66fa617b-e3e8-4480-9f1e-2c0688c1d21b"),
    "rectangle": UUID("83da014b-a550-4bf5-89ff-16e54225bd5d"),
    "curve": UUID("9ba89ec2-5315-435f-a621-b66c5fa2f301"),
    "mesh": UUID("794a1f9d-21d5-4379-b987-9e8bbf433912"),
    "surface": UUID("f4070a37-c822-410f-9057-100d2e22a22d"),
    "subd": UUID("20f4ca9c-6c90-4fd6-ba8a-5bf9ca79db08"),
    "brep": UUID("2ceb0405-fdfe-403d-a4d6-8786da45fb9d"),
    "geometrybase": UUID("c37956f4-d39c-49c7-af71-1e87f8031b26"),
    "pointcloud": UUID("d73c9fb0-365d-458f-9fb5-f4141399311f"),
}
# the hints of GhPython (Rhino 5 to 7) and of IronPython scripts: four differ, one is missing
HINTS_IRONPYTHON = {name: guid for name, guid in HINTS.items() if name != "pointcloud"} | {
    "none": UUID("35915213-5534-4277-81b8-1bdc9e7383d2"),
    "ghdoc": UUID("87f87f55-5b71-41f4-8aea-21d494016f81"),
    "float": UUID("39fbc626-7a01-46ab-a18e-ec1c0c41685b"),
    "str": UUID("37261734-eec7-4f50-b6a8-b8d1f3c4396b"),
}
# the .NET type behind a hint, as `ConverterData` of Rhino 8 definitions has it (assembly, type)
CONVERTERS = {
    "none": ("System.Private.CoreLib", "System.Object"),
    "ghdoc": ("System.Private.CoreLib", "System.Object"),
    "float": ("System.Private.CoreLib", "System.Double"),
    "int": ("System.Private.CoreLib", "System.Int32"),
    "bool": ("System.Private.CoreLib", "System.Boolean"),
    "str": ("System.Private.CoreLib", "System.String"),
    "guid": ("System.Private.CoreLib", "System.Guid"),
    "complex": ("System.Runtime.Numerics", "System.Numerics.Complex"),
    "point": ("RhinoCommon", "Rhino.Geometry.Point3d"),
    "vector": ("RhinoCommon", "Rhino.Geometry.Vector3d"),
    "plane": ("RhinoCommon", "Rhino.Geometry.Plane"),
    "curve": ("RhinoCommon", "Rhino.Geometry.Curve"),
    "brep": ("RhinoCommon", "Rhino.Geometry.Brep"),
    "geometrybase": ("RhinoCommon", "Rhino.Geometry.GeometryBase"),
}

# --------------------------------------------------------------------------------------------------------- the table
# a script, a cluster or a Hops component goes by whatever its author calls it
RENAMED = {SCRIPT, PYTHON3_SCRIPT, IRONPYTHON_SCRIPT, CSHARP_SCRIPT, GHPYTHON_SCRIPT, CLUSTER, HOPS}
RENAMED |= {UUID("a9a8ebd2-fff5-4c44-a8f5-739736d129ba"), UUID("079bd9bd-54a0-41d4-98af-db999015f63d")}


def _table(*texts: str) -> dict[UUID, tuple[str, ...]]:
    lines = (line.split(" ", 1) for text in texts for line in text.split("\n") if line)
    return {
        UUID(guid): tuple(re.split(r"(?<! )\|(?!Many)", names)) for guid, names in lines
    }  # "Curve | Curve", "One|Many"


NAMES: dict[UUID, tuple[str, ...]] = {
    SCRIPT: ("Script",),
    PYTHON3_SCRIPT: ("Python 3 Script",),
    IRONPYTHON_SCRIPT: ("IronPython 2 Script",),
    CSHARP_SCRIPT: ("C# Script",),
    GHPYTHON_SCRIPT: ("GhPython Script",),
    SCRIPT_PARAMETER: ("Script Variable",),
    GHPYTHON_INPUT: ("GhPython Input",),
    NUMBER_SLIDER: ("Number Slider",),
    BOOLEAN_TOGGLE: ("Boolean Toggle",),
    BUTTON: ("Button",),
    PANEL: ("Panel",),
    VALUE_LIST: ("Value List",),
    GROUP: ("Group",),
    SCRIBBLE: ("Scribble",),
    RELAY: ("Relay",),
    CLUSTER: ("Cluster",),
    HOPS: ("Hops",),
    TIMER: ("Timer", "Trigger"),
    PARAM_VIEWER: ("Param Viewer",),
    GRAPH_MAPPER: ("Graph Mapper",),
    DIGIT_SCROLLER: ("Digit Scroller",),
    CONTROL_KNOB: ("Control Knob",),
    GENE_POOL: ("Gene Pool",),
} | _table(_SPECIAL, _PARAMETERS, native_guids.ALL, native_guids_more.MORE)
"""Component and parameter ids with the names files have for them, the present one first."""
PARAMETERS: dict[str, UUID] = {names[0]: guid for guid, names in reversed(_table(_PARAMETERS).items())}
"""The id of a floating parameter by its present name."""
RENAMED |= set(PARAMETERS.values())  # one taken out of a component has the name of its input

_HINT_NAMES = {guid: name for hints in (HINTS, HINTS_IRONPYTHON) for name, guid in hints.items()}


def name(guid: UUID) -> str | None:
    """The present name of a component or parameter, or None for an id that is not in the table."""
    return NAMES.get(guid, (None,))[0]


def hint(guid: UUID) -> str | None:
    """The name of a type hint of either Python, or None for an id that is not in the table."""
    return _HINT_NAMES.get(guid)
