"""User objects: a component as the .ghuser file that Grasshopper puts on its panel.

Two flavours of one bundle: "rhino8", a Python 3 script for Rhino 8 and 9 (script schema 3, as Rhino 8.13 writes it),
and "rhino7", a GhPython script for Rhino 6 and 7. Layout: the user objects of compas and ladybug-grasshopper.
"""

from __future__ import annotations

from uuid import UUID, uuid5

from hookean_canvas.archive import Chunk, Type, guids, to_bytes
from hookean_canvas.components.bundles import Bundle, Parameter
from hookean_canvas.components.inline import Flavour, inlined
from hookean_canvas.definitions import containers

BASES: dict[Flavour, UUID] = {"rhino8": guids.PYTHON3_SCRIPT, "rhino7": guids.GHPYTHON_SCRIPT}
"""The component of Grasshopper that runs the script."""


def user_object(bundle: Bundle, flavour: Flavour = "rhino8") -> Chunk:
    """The archive of a .ghuser file; write it with `archive.write`. InputError as `inlined`."""
    chunk = Chunk("UserObject")
    chunk.put("BaseID", Type.GUID, BASES[flavour])
    chunk.put("Category", Type.STRING, bundle.category).put("SubCategory", Type.STRING, bundle.subcategory)
    chunk.put("Name", Type.STRING, bundle.name).put("NickName", Type.STRING, bundle.nickname)
    chunk.put("Description", Type.STRING, bundle.description).put("Exposure", Type.INT32, bundle.exposure)
    chunk.put("Icon", Type.BYTEARRAY, bundle.icon).put("InstanceGuid", Type.GUID, identity(bundle, flavour))
    if flavour == "rhino8":
        chunk.put("ToolTip", Type.STRING, bundle.description)
    inner = _python3(bundle) if flavour == "rhino8" else _ghpython(bundle)
    return chunk.put("Object", Type.BYTEARRAY, to_bytes(inner))


def identity(bundle: Bundle, flavour: Flavour) -> UUID:
    """The id of the user object; the flavours differ, so that one Grasshopper can hold both."""
    return bundle.guid if flavour == "rhino8" else uuid5(bundle.guid, flavour)


def file_name(bundle: Bundle) -> str:
    """The name of its file, distinct from other plug-ins' in a shared folder."""
    return f"Hookean_{bundle.folder}.ghuser"


def slots(bundle: Bundle) -> tuple[list[tuple[UUID, containers.Slot]], list[tuple[UUID, containers.Slot]]]:
    """Inputs and outputs as a Rhino 8 script has them, with ids of their own."""

    def made(side: str, parameters: tuple[Parameter, ...]) -> list[tuple[UUID, containers.Slot]]:
        return [
            (
                _parameter_id(bundle, "rhino8", side, p),
                containers.Slot(p.name, p.description, p.access, p.hint, p.optional, p.mapping),
            )
            for p in parameters
        ]

    return made("input", bundle.inputs), made("output", bundle.outputs)


def _python3(bundle: Bundle) -> Chunk:
    """The component as Rhino 8 and 9 store it."""
    inputs, outputs = slots(bundle)
    code = inlined(bundle.code, "rhino8")
    id_ = uuid5(bundle.guid, "component")
    chunk = containers.script(id_, bundle.name, bundle.nickname, bundle.description, code, inputs, outputs)
    chunk.name = "UserObject"
    return chunk.put("IconOverride", Type.DRAWING_BITMAP, bundle.icon)


def _ghpython(bundle: Bundle) -> Chunk:
    """The component as Rhino 7 stores it."""
    chunk = Chunk("UserObject").put("CodeInput", Type.STRING, inlined(bundle.code, "rhino7"))
    chunk.put("Name", Type.STRING, bundle.name).put("NickName", Type.STRING, bundle.nickname)
    chunk.put("Description", Type.STRING, bundle.description).put("IconDisplay", Type.INT32, bundle.icon_display)
    for flag, on in (("HideInput", True), ("HideOutput", True), ("IsAdvancedMode", False), ("MarshalOutGuids", True)):
        chunk.put(flag, Type.BOOL, on)
    data = chunk.add("ParameterData")
    for side, kind, parameters in (
        ("Input", guids.GHPYTHON_INPUT, bundle.inputs),
        ("Output", guids.GHPYTHON_OUTPUT, bundle.outputs),
    ):
        data.put(f"{side}Count", Type.INT32, len(parameters))
        for i, parameter in enumerate(parameters):
            data.put(f"{side}Id", Type.GUID, kind, i)
            entry = data.add(f"{side}Param", i)
            entry.put("InstanceGuid", Type.GUID, _parameter_id(bundle, "rhino7", side.lower(), parameter))
            _ghpython_parameter(entry, parameter, side == "Input")
    return chunk


def _ghpython_parameter(chunk: Chunk, parameter: Parameter, is_input: bool) -> None:
    chunk.put("Name", Type.STRING, parameter.name).put("NickName", Type.STRING, parameter.name)
    chunk.put("Description", Type.STRING, parameter.description).put("SourceCount", Type.INT32, 0)
    chunk.put("Optional", Type.BOOL, parameter.optional if is_input else False)
    chunk.put("ReverseData", Type.BOOL, parameter.reverse).put("SimplifyData", Type.BOOL, parameter.simplify)
    if parameter.mapping:
        chunk.put("Mapping", Type.INT32, parameter.mapping)
    if is_input:
        chunk.put("AllowTreeAccess", Type.BOOL, True).put("ShowTypeHints", Type.BOOL, True)
        chunk.put("ScriptParamAccess", Type.INT32, parameter.access).put("WireDisplay", Type.INT32, parameter.wire)
        chunk.put("TypeHintID", Type.GUID, guids.HINTS_IRONPYTHON[parameter.hint])


def _parameter_id(bundle: Bundle, flavour: str, side: str, parameter: Parameter) -> UUID:
    return uuid5(bundle.guid, f"{flavour} {side} {parameter.name}")
