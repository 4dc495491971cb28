"""Union and difference of solids, each result taken only if the kernel vouches for it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from OCP.BRepAlgoAPI import BRepAlgoAPI_Cut, BRepAlgoAPI_Fuse
from OCP.BRepBuilderAPI import BRepBuilderAPI_Copy
from OCP.BRepCheck import BRepCheck_Analyzer
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.ShapeUpgrade import ShapeUpgrade_UnifySameDomain
from OCP.Standard import Standard_Failure
from OCP.TopAbs import TopAbs_FACE, TopAbs_SHELL, TopAbs_SOLID
from OCP.TopExp import TopExp
from OCP.TopTools import TopTools_IndexedMapOfShape, TopTools_ListOfShape

from linkwright.designs.language.errors import BuildError

from .holes import Tool

#: Surfaces further apart than this are not joined at the second try [mm, rad].
_CAREFUL = 1e-9


def sub_shapes(shape: Any, kind: Any) -> list[Any]:
    """Distinct sub-shapes of a kind, in the kernel's map order."""
    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, kind, found)
    return [found.FindKey(i) for i in range(1, found.Extent() + 1)]


def compute_volume(shape: Any) -> float:
    """Volume by the kernel's integration [mm3]; negative if the shell is inside out."""
    props = GProp_GProps()
    BRepGProp.VolumeProperties_s(shape, props)
    return props.Mass()


def fuse(shapes: Sequence[Any], where: str) -> Any:
    """The union of solids."""
    if len(shapes) == 1:
        return shapes[0]
    operation = BRepAlgoAPI_Fuse()
    _run(operation, shapes[:1], shapes[1:], "union", where)
    return operation.Shape()


def cut(shape: Any, tools: Sequence[Tool], where: str) -> Any:
    """The solid without its tools.

    Raises:
        BuildError: a tool leaves no face: it misses the part, or another hole swallows it.
    """
    if not tools:
        return shape
    operation = BRepAlgoAPI_Cut()
    _run(operation, [shape], [tool.shape for tool in tools], "cut", where)
    for tool in tools:
        if all(operation.IsDeleted(face) for face in sub_shapes(tool.shape, TopAbs_FACE)):
            raise BuildError(where, f"{tool.name} cuts nothing: it misses the part, or a wider cut swallows it")
    return operation.Shape()


def _run(operation: Any, arguments: Sequence[Any], tools: Sequence[Any], name: str, where: str) -> None:
    first, second = TopTools_ListOfShape(), TopTools_ListOfShape()
    for shape in arguments:
        first.Append(shape)
    for shape in tools:
        second.Append(shape)
    operation.SetArguments(first)
    operation.SetTools(second)
    operation.Build()
    if not operation.IsDone() or operation.Shape().IsNull():
        raise BuildError(where, f"the kernel could not compute the {name} of its {len(arguments) + len(tools)} pieces")


def unify(shape: Any) -> Any:
    """The shape with neighbouring faces of one surface joined, so that each bore is one cylinder.

    The kernel's merger now and then spoils a good shape: it joins faces that only touch, or gives up on curves. What
    it makes counts only if it is valid and has not changed the volume; else a more careful try does, in the end the
    shape as it was, whose faces are many but right.
    """
    volume = compute_volume(shape)
    for with_edges, tolerance in ((True, None), (True, _CAREFUL), (False, _CAREFUL)):
        # On a copy: a failed try leaves its argument spoilt.
        copy = BRepBuilderAPI_Copy(shape).Shape()
        merger = ShapeUpgrade_UnifySameDomain(copy, with_edges, True, False)
        if tolerance is not None:
            merger.SetLinearTolerance(tolerance)
            merger.SetAngularTolerance(tolerance)
        try:
            merger.Build()
        except Standard_Failure:
            continue
        merged = merger.Shape()
        if abs(compute_volume(merged) - volume) <= 1e-9 * abs(volume) and BRepCheck_Analyzer(merged).IsValid():
            return merged
    return shape


def sole_solid(shape: Any, volume: tuple[float, float], what: str, where: str) -> Any:
    """The one solid in a result, checked against all that can be known about it.

    Args:
        shape: a result of the kernel.
        volume: lower and upper bound [mm3].
        what: the step, for messages.
        where: names the part.

    Raises:
        BuildError: no solid or several, a closed cavity, an invalid or inverted shell, a volume out of bounds.
    """
    solids = sub_shapes(shape, TopAbs_SOLID)
    if len(solids) != 1:
        sizes = ", ".join(f"{compute_volume(s):.4g}" for s in solids[:6])
        raise BuildError(
            where, f"{what} give {len(solids)} pieces" + (f" ({sizes} mm3)" if solids else "") + "; it must be one"
        )
    solid = solids[0]
    if len(sub_shapes(solid, TopAbs_SHELL)) != 1:
        raise BuildError(
            where, f"{what} leave a closed cavity, which no tool can make; a hole's mouth lies inside the part"
        )
    if not BRepCheck_Analyzer(solid).IsValid():
        raise BuildError(
            where, f"{what} give a solid that the kernel itself calls invalid; look for faces that nearly touch"
        )
    found, (low, high) = compute_volume(solid), volume
    if not low <= found <= high or found <= 0.0:
        raise BuildError(
            where, f"{what} give a volume of {found:.6g} mm3; the numbers allow {low:.6g} to {high:.6g} mm3"
        )
    return solid
