"""hookean: particle-spring form finding. Describe a Scene, relax it, read the forces.

    from hookean import Scene, relax

    scene = Scene.read({"forces": [{"kind": "springs", "lines": [[[0, 0, 0], [1, 0, 0]]]}]})  # or JSON text
    result = relax(scene)
    print(result.message, result.force("springs")["force"])

`relax` brings a Scene to equilibrium and returns a Result with its Status. `simulate` yields the Frames of a scene in
motion; a Simulation is stepped, patched (Patch), saved and loaded; a Script and a Stream lead either through time. Bad
input raises InputError, one sentence with its place. What a scene is made of are classes, too, each force by its name:

    from hookean import Anchors, Scene, Settings, Springs

    cable = Springs(name="cable", lines=[[[0, 0, 0], [1, 0, 0]]], stiffness=1000)
    scene = Scene(forces=[cable], anchors=[Anchors(points=[[0, 0, 0]])], settings=Settings(tolerance=1e-8))

docs/scene.md describes every field, docs/forces.md every force.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from hookean.errors import InputError as InputError

if TYPE_CHECKING:
    from hookean.analysis.buckling import Buckling as Buckling
    from hookean.analysis.buckling import buckling as buckling
    from hookean.analysis.freezing import Frozen as Frozen
    from hookean.analysis.freezing import freeze as freeze
    from hookean.analysis.frequencies import Frequencies as Frequencies
    from hookean.analysis.frequencies import frequencies as frequencies
    from hookean.analysis.load_cases import LoadCases as LoadCases
    from hookean.analysis.load_cases import load_cases as load_cases
    from hookean.analysis.load_path import LoadPath as LoadPath
    from hookean.analysis.load_path import load_path as load_path
    from hookean.analysis.mechanisms import Mechanisms as Mechanisms
    from hookean.analysis.mechanisms import mechanisms as mechanisms
    from hookean.analysis.surfaces import Surface as Surface
    from hookean.analysis.surfaces import surface as surface
    from hookean.designing.answer import Design as Design
    from hookean.designing.exploring import Exploration as Exploration
    from hookean.designing.exploring import explore as explore
    from hookean.designing.problem import Problem as Problem
    from hookean.designing.search import design as design
    from hookean.designing.sensitivity import Sensitivity as Sensitivity
    from hookean.designing.sensitivity import sensitivity as sensitivity
    from hookean.files.save import open as open
    from hookean.files.save import save as save
    from hookean.forces.align_faces import AlignFaces as AlignFaces
    from hookean.forces.anchor_spring import AnchorSpring as AnchorSpring
    from hookean.forces.angle import Angle as Angle
    from hookean.forces.angle_snap import AngleSnap as AngleSnap
    from hookean.forces.area_weight import AreaWeight as AreaWeight
    from hookean.forces.base import Force as Force
    from hookean.forces.beam import Beam as Beam
    from hookean.forces.bend import Bend as Bend
    from hookean.forces.box_collide import BoxCollide as BoxCollide
    from hookean.forces.circle_image import CircleImage as CircleImage
    from hookean.forces.clamp_angle import ClampAngle as ClampAngle
    from hookean.forces.clamp_length import ClampLength as ClampLength
    from hookean.forces.co_circular import CoCircular as CoCircular
    from hookean.forces.co_linear import CoLinear as CoLinear
    from hookean.forces.co_planar import CoPlanar as CoPlanar
    from hookean.forces.co_spherical import CoSpherical as CoSpherical
    from hookean.forces.coincident import Coincident as Coincident
    from hookean.forces.collide import Collide as Collide
    from hookean.forces.collide_2d import Collide2d as Collide2d
    from hookean.forces.collide_curve import CollideCurve as CollideCurve
    from hookean.forces.collide_lines import CollideLines as CollideLines
    from hookean.forces.collide_solid import CollideSolid as CollideSolid
    from hookean.forces.concentric import Concentric as Concentric
    from hookean.forces.conical import Conical as Conical
    from hookean.forces.constant_tension import ConstantTension as ConstantTension
    from hookean.forces.cyclic_quad import CyclicQuad as CyclicQuad
    from hookean.forces.developable import Developable as Developable
    from hookean.forces.direction import Direction as Direction
    from hookean.forces.equal_angle import EqualAngle as EqualAngle
    from hookean.forces.equal_length import EqualLength as EqualLength
    from hookean.forces.floor import Floor as Floor
    from hookean.forces.gas import Gas as Gas
    from hookean.forces.geodesic_strip import GeodesicStrip as GeodesicStrip
    from hookean.forces.hinge import Hinge as Hinge
    from hookean.forces.hydrostatic import Hydrostatic as Hydrostatic
    from hookean.forces.impulse import Impulse as Impulse
    from hookean.forces.isothermic import Isothermic as Isothermic
    from hookean.forces.length_ratio import LengthRatio as LengthRatio
    from hookean.forces.length_snap import LengthSnap as LengthSnap
    from hookean.forces.level_set import LevelSet as LevelSet
    from hookean.forces.line_weight import LineWeight as LineWeight
    from hookean.forces.magnet_snap import MagnetSnap as MagnetSnap
    from hookean.forces.membrane import Membrane as Membrane
    from hookean.forces.mirror import Mirror as Mirror
    from hookean.forces.no_fold_through import NoFoldThrough as NoFoldThrough
    from hookean.forces.planarize import Planarize as Planarize
    from hookean.forces.polygon_area import PolygonArea as PolygonArea
    from hookean.forces.power_law import PowerLaw as PowerLaw
    from hookean.forces.pressure import Pressure as Pressure
    from hookean.forces.projected_force import ProjectedForce as ProjectedForce
    from hookean.forces.pull_to_curve import PullToCurve as PullToCurve
    from hookean.forces.pull_to_line import PullToLine as PullToLine
    from hookean.forces.pull_to_mesh import PullToMesh as PullToMesh
    from hookean.forces.pull_to_plane import PullToPlane as PullToPlane
    from hookean.forces.pull_to_surface import PullToSurface as PullToSurface
    from hookean.forces.rigid_body import RigidBody as RigidBody
    from hookean.forces.rigid_collide import RigidCollide as RigidCollide
    from hookean.forces.self_weight import SelfWeight as SelfWeight
    from hookean.forces.shell import Shell as Shell
    from hookean.forces.sliding_cable import SlidingCable as SlidingCable
    from hookean.forces.smooth import Smooth as Smooth
    from hookean.forces.soapfilm import SoapFilm as SoapFilm
    from hookean.forces.soft_collide import SoftCollide as SoftCollide
    from hookean.forces.solid_plane_collide import SolidPlaneCollide as SolidPlaneCollide
    from hookean.forces.springs import Springs as Springs
    from hookean.forces.support import Support as Support
    from hookean.forces.tangent_incircles import TangentIncircles as TangentIncircles
    from hookean.forces.tangential_smooth import TangentialSmooth as TangentialSmooth
    from hookean.forces.thrust import Thrust as Thrust
    from hookean.forces.transform_lock import TransformLock as TransformLock
    from hookean.forces.translation_lock import TranslationLock as TranslationLock
    from hookean.forces.unary import Unary as Unary
    from hookean.forces.volume import Volume as Volume
    from hookean.forces.vortex import Vortex as Vortex
    from hookean.forces.wind import Wind as Wind
    from hookean.forces.wind_pressure import WindPressure as WindPressure
    from hookean.pictures.picture import picture as picture
    from hookean.pictures.picture import render as render
    from hookean.running.frame import Frame as Frame
    from hookean.running.frames import simulate as simulate
    from hookean.running.live import relax_live as relax_live
    from hookean.running.patch import Move as Move
    from hookean.running.patch import Patch as Patch
    from hookean.running.result import Result as Result
    from hookean.running.result import Status as Status
    from hookean.running.run import relax as relax
    from hookean.running.script import Script as Script
    from hookean.running.showing import View as View
    from hookean.running.showing import show as show
    from hookean.running.simulation import Simulation as Simulation
    from hookean.running.stream import Stream as Stream
    from hookean.scene.families import family as family
    from hookean.scene.load_cases import ElasticCloth as ElasticCloth
    from hookean.scene.load_cases import ElasticLine as ElasticLine
    from hookean.scene.load_cases import LoadCase as LoadCase
    from hookean.scene.load_cases import Stages as Stages
    from hookean.scene.report import Report as Report
    from hookean.scene.scene import Anchor as Anchor
    from hookean.scene.scene import Anchors as Anchors
    from hookean.scene.scene import Geometry as Geometry
    from hookean.scene.scene import MeshData as MeshData
    from hookean.scene.scene import Scene as Scene
    from hookean.scene.scene import Settings as Settings
    from hookean.values.materials import Material as Material
    from hookean.values.sections import Section as Section
    from hookean.values.units import Units as Units
    from hookean.workshop.cables import Cables as Cables
    from hookean.workshop.cables import cables as cables
    from hookean.workshop.patterns import Patterns as Patterns
    from hookean.workshop.patterns import cutting_patterns as cutting_patterns

__version__ = "0.1.0"

_HOMES = {
    "AlignFaces": "forces.align_faces",
    "AnchorSpring": "forces.anchor_spring",
    "Angle": "forces.angle",
    "AngleSnap": "forces.angle_snap",
    "AreaWeight": "forces.area_weight",
    "Beam": "forces.beam",
    "Bend": "forces.bend",
    "BoxCollide": "forces.box_collide",
    "CircleImage": "forces.circle_image",
    "ClampAngle": "forces.clamp_angle",
    "ClampLength": "forces.clamp_length",
    "CoCircular": "forces.co_circular",
    "CoLinear": "forces.co_linear",
    "CoPlanar": "forces.co_planar",
    "CoSpherical": "forces.co_spherical",
    "Coincident": "forces.coincident",
    "Collide": "forces.collide",
    "Collide2d": "forces.collide_2d",
    "CollideCurve": "forces.collide_curve",
    "CollideLines": "forces.collide_lines",
    "CollideSolid": "forces.collide_solid",
    "Concentric": "forces.concentric",
    "Conical": "forces.conical",
    "ConstantTension": "forces.constant_tension",
    "CyclicQuad": "forces.cyclic_quad",
    "Developable": "forces.developable",
    "Direction": "forces.direction",
    "EqualAngle": "forces.equal_angle",
    "EqualLength": "forces.equal_length",
    "Floor": "forces.floor",
    "Force": "forces.base",
    "Gas": "forces.gas",
    "GeodesicStrip": "forces.geodesic_strip",
    "Hinge": "forces.hinge",
    "Hydrostatic": "forces.hydrostatic",
    "Impulse": "forces.impulse",
    "Isothermic": "forces.isothermic",
    "LengthRatio": "forces.length_ratio",
    "LengthSnap": "forces.length_snap",
    "LevelSet": "forces.level_set",
    "LineWeight": "forces.line_weight",
    "MagnetSnap": "forces.magnet_snap",
    "Membrane": "forces.membrane",
    "Mirror": "forces.mirror",
    "NoFoldThrough": "forces.no_fold_through",
    "Planarize": "forces.planarize",
    "PolygonArea": "forces.polygon_area",
    "PowerLaw": "forces.power_law",
    "Pressure": "forces.pressure",
    "ProjectedForce": "forces.projected_force",
    "PullToCurve": "forces.pull_to_curve",
    "PullToLine": "forces.pull_to_line",
    "PullToMesh": "forces.pull_to_mesh",
    "PullToPlane": "forces.pull_to_plane",
    "PullToSurface": "forces.pull_to_surface",
    "RigidBody": "forces.rigid_body",
    "RigidCollide": "forces.rigid_collide",
    "SelfWeight": "forces.self_weight",
    "Shell": "forces.shell",
    "SlidingCable": "forces.sliding_cable",
    "Smooth": "forces.smooth",
    "SoapFilm": "forces.soapfilm",
    "SoftCollide": "forces.soft_collide",
    "SolidPlaneCollide": "forces.solid_plane_collide",
    "Springs": "forces.springs",
    "Support": "forces.support",
    "TangentIncircles": "forces.tangent_incircles",
    "TangentialSmooth": "forces.tangential_smooth",
    "Thrust": "forces.thrust",
    "TransformLock": "forces.transform_lock",
    "TranslationLock": "forces.translation_lock",
    "Unary": "forces.unary",
    "Volume": "forces.volume",
    "Vortex": "forces.vortex",
    "Wind": "forces.wind",
    "WindPressure": "forces.wind_pressure",
    "Scene": "scene.scene",
    "Anchor": "scene.scene",
    "Anchors": "scene.scene",
    "Geometry": "scene.scene",
    "Material": "values.materials",
    "MeshData": "scene.scene",
    "Section": "values.sections",
    "Settings": "scene.scene",
    "Units": "values.units",
    "Report": "scene.report",
    "Result": "running.result",
    "Status": "running.result",
    "Frame": "running.frame",
    "View": "running.showing",
    "show": "running.showing",
    "Simulation": "running.simulation",
    "Move": "running.patch",
    "Patch": "running.patch",
    "Script": "running.script",
    "Stream": "running.stream",
    "Problem": "designing.problem",
    "Design": "designing.answer",
    "design": "designing.search",
    "Exploration": "designing.exploring",
    "explore": "designing.exploring",
    "Sensitivity": "designing.sensitivity",
    "sensitivity": "designing.sensitivity",
    "Cables": "workshop.cables",
    "cables": "workshop.cables",
    "Patterns": "workshop.patterns",
    "cutting_patterns": "workshop.patterns",
    "ElasticCloth": "scene.load_cases",
    "family": "scene.families",
    "ElasticLine": "scene.load_cases",
    "Frozen": "analysis.freezing",
    "freeze": "analysis.freezing",
    "LoadCase": "scene.load_cases",
    "LoadCases": "analysis.load_cases",
    "load_cases": "analysis.load_cases",
    "Stages": "scene.load_cases",
    "Buckling": "analysis.buckling",
    "buckling": "analysis.buckling",
    "Frequencies": "analysis.frequencies",
    "frequencies": "analysis.frequencies",
    "LoadPath": "analysis.load_path",
    "load_path": "analysis.load_path",
    "Mechanisms": "analysis.mechanisms",
    "mechanisms": "analysis.mechanisms",
    "Surface": "analysis.surfaces",
    "surface": "analysis.surfaces",
    "open": "files.save",
    "picture": "pictures.picture",
    "relax": "running.run",
    "relax_live": "running.live",
    "render": "pictures.picture",
    "save": "files.save",
    "simulate": "running.frames",
}

__all__ = [
    "AlignFaces",
    "Anchor",
    "AnchorSpring",
    "Anchors",
    "Angle",
    "AngleSnap",
    "AreaWeight",
    "Beam",
    "Bend",
    "BoxCollide",
    "Buckling",
    "Cables",
    "CircleImage",
    "ClampAngle",
    "ClampLength",
    "CoCircular",
    "CoLinear",
    "CoPlanar",
    "CoSpherical",
    "Coincident",
    "Collide",
    "Collide2d",
    "CollideCurve",
    "CollideLines",
    "CollideSolid",
    "Concentric",
    "Conical",
    "ConstantTension",
    "CyclicQuad",
    "Design",
    "Developable",
    "Direction",
    "ElasticCloth",
    "ElasticLine",
    "EqualAngle",
    "EqualLength",
    "Exploration",
    "Floor",
    "Force",
    "Frame",
    "Frequencies",
    "Frozen",
    "Gas",
    "GeodesicStrip",
    "Geometry",
    "Hinge",
    "Hydrostatic",
    "Impulse",
    "InputError",
    "Isothermic",
    "LengthRatio",
    "LengthSnap",
    "LevelSet",
    "LineWeight",
    "LoadCase",
    "LoadCases",
    "LoadPath",
    "MagnetSnap",
    "Material",
    "Mechanisms",
    "Membrane",
    "MeshData",
    "Mirror",
    "Move",
    "NoFoldThrough",
    "Patch",
    "Patterns",
    "Planarize",
    "PolygonArea",
    "PowerLaw",
    "Pressure",
    "Problem",
    "ProjectedForce",
    "PullToCurve",
    "PullToLine",
    "PullToMesh",
    "PullToPlane",
    "PullToSurface",
    "Report",
    "Result",
    "RigidBody",
    "RigidCollide",
    "Scene",
    "Script",
    "Section",
    "SelfWeight",
    "Sensitivity",
    "Settings",
    "Shell",
    "Simulation",
    "SlidingCable",
    "Smooth",
    "SoapFilm",
    "SoftCollide",
    "SolidPlaneCollide",
    "Springs",
    "Stages",
    "Status",
    "Stream",
    "Support",
    "Surface",
    "TangentIncircles",
    "TangentialSmooth",
    "Thrust",
    "TransformLock",
    "TranslationLock",
    "Unary",
    "Units",
    "View",
    "Volume",
    "Vortex",
    "Wind",
    "WindPressure",
    "buckling",
    "cables",
    "cutting_patterns",
    "design",
    "explore",
    "family",
    "freeze",
    "frequencies",
    "load_cases",
    "load_path",
    "mechanisms",
    "open",
    "picture",
    "relax",
    "relax_live",
    "render",
    "save",
    "sensitivity",
    "show",
    "simulate",
    "surface",
]


if not TYPE_CHECKING:  # type checkers know the names above, and no others

    def __getattr__(name: str) -> Any:
        # loaded when first used: `import hookean` alone costs nothing
        if name in _HOMES:
            return getattr(importlib.import_module(f"hookean.{_HOMES[name]}"), name)
        raise AttributeError(f"module 'hookean' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__doc__", "__version__"])
