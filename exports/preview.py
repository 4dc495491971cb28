"""The picture of a release: the assembly in its home pose, drawn without a screen."""

from __future__ import annotations

import ctypes
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.designs.language.errors import ReleaseError
from linkwright.designs.language.materials import material
from linkwright.generator.assembly import Assembly
from linkwright.generator.mesh import Mesh

from .shade import enlarged, shade

SIZE = (1600, 1200)
#: Drawn larger and averaged down: smoother than the driver's own anti-aliasing and the same on every driver.
_SUPERSAMPLING = 2
#: From the front left, a little above: every leg of a mechanism on a round base is seen from another side.
_VIEW = np.array([0.62, -0.66, 0.42])
_VIEW_ANGLE_DEG = 22.0
_MARGIN = 1.06
#: Edges between faces that meet at less than this are tangent; drawing them would clutter fillets.
_EDGE_ANGLE = np.deg2rad(20.0)
#: How far surfaces look around themselves for what takes their light, as a share of the assembly's size.
_SHADE_SHARE = 0.06
#: Shade is soft: it is computed for blocks of so many pixels each way.
_SHADE_PIXELS = 2
_EDGE_COLOUR = (0.10, 0.11, 0.13)
#: Paper and floor alike, and the floor takes no light: it is seen only where the assembly shades it.
_PAPER = (0.955, 0.963, 0.973)


@dataclass(frozen=True, slots=True)
class _Looks:
    """What is drawn of one solid: its faces shaded each on its own, and its sharp edges as pairs of `vertices`."""

    points: np.ndarray
    normals: np.ndarray
    triangles: np.ndarray
    vertices: np.ndarray
    edges: np.ndarray


def write_preview(assembly: Assembly, Ts_base_body: np.ndarray, path: Path) -> None:
    """Draw the assembly at given body poses into a PNG.

    Args:
        assembly: what to draw.
        Ts_base_body: poses of the bodies in the order of the assembly, shape (n_bodies, 4, 4) [mm].
        path: file to write.

    Raises:
        ReleaseError: this machine cannot draw without a screen; says what to install.
    """
    pixels = render(assembly, Ts_base_body)
    _write_png(pixels, path)


def render(assembly: Assembly, Ts_base_body: np.ndarray) -> np.ndarray:
    """The picture as pixels, shape (height, width, 3) uint8, first row on top."""
    # Loaded first, or the objects below come up without a way to draw themselves.
    import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
    from vtkmodules.vtkRenderingCore import vtkRenderer

    renderer = vtkRenderer()
    renderer.SetBackground(_PAPER)
    looks: dict[str, tuple[Any, Any]] = {}
    clouds: list[np.ndarray] = []
    for placed, T_base_body in zip(assembly.bodies, Ts_base_body, strict=True):
        for part in placed.parts:
            T = T_base_body @ part.T_body_part
            if part.solid.key not in looks:
                looks[part.solid.key] = _mappers(looks_of(part.solid.mesh))
            for actor in _actors(*looks[part.solid.key], material(part.part.material).colour, T):
                renderer.AddActor(actor)
            clouds.append(part.solid.mesh.vertices @ T[:3, :3].T + T[:3, 3])
    if not clouds:
        raise ReleaseError(f"{assembly.design.name}: there is nothing to draw: the assembly has no parts")
    cloud = np.concatenate(clouds)
    size = float(np.linalg.norm(cloud.max(axis=0) - cloud.min(axis=0)))
    renderer.AddActor(_floor(cloud, size))
    _light(renderer)
    _aim(renderer, cloud)
    pixels, depths = _grab(renderer)
    half_width = np.tan(np.deg2rad(_VIEW_ANGLE_DEG) / 2.0) * SIZE[0] / SIZE[1]
    coarse = _SUPERSAMPLING * _SHADE_PIXELS
    light = enlarged(shade(depths[::coarse, ::coarse], half_width, _SHADE_SHARE * size), _SHADE_PIXELS)
    return np.round(_averaged(pixels, _SUPERSAMPLING) * light[..., None]).astype(np.uint8)


def looks_of(mesh: Mesh) -> _Looks:
    """Points split where B-rep faces meet, so that each face is shaded smoothly and meets its neighbour sharply."""
    corners = np.stack([np.repeat(mesh.faces, 3), mesh.triangles.reshape(-1)], axis=1)
    own, index = np.unique(corners, axis=0, return_inverse=True)
    triangles = index.reshape(-1, 3)
    points = mesh.vertices[own[:, 1]]
    flat = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]], points[triangles[:, 2]] - points[triangles[:, 0]]
    )
    normals = np.zeros_like(points)
    for corner in range(3):
        np.add.at(normals, triangles[:, corner], flat)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    return _Looks(points, normals, triangles, mesh.vertices, _sharp_edges(mesh))


def _sharp_edges(mesh: Mesh) -> np.ndarray:
    """Pairs of vertices, shape (n, 2), between triangles of different faces that meet at an angle."""
    t = mesh.triangles.astype(np.int64)
    flat = np.cross(mesh.vertices[t[:, 1]] - mesh.vertices[t[:, 0]], mesh.vertices[t[:, 2]] - mesh.vertices[t[:, 0]])
    flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-300)
    edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(t)), 3)
    order = np.lexsort((owner, edges[:, 1], edges[:, 0]))
    edges, owner = edges[order].reshape(-1, 2, 2), owner[order].reshape(-1, 2)
    one, other = owner[:, 0], owner[:, 1]
    between = mesh.faces[one] != mesh.faces[other]
    bent = np.einsum("ni,ni->n", flat[one], flat[other]) < np.cos(_EDGE_ANGLE)
    return edges[between & bent, 0]


def _mappers(looks: _Looks) -> tuple[Any, Any]:
    """What puts the faces and the edges of one solid on the screen; shared by all its instances."""
    from vtkmodules.vtkRenderingCore import vtkPolyDataMapper

    faces = vtkPolyDataMapper()
    faces.SetInputData(_poly_data(looks.points, triangles=looks.triangles, normals=looks.normals))
    # Edges lie in the faces: push the faces back a little, or they would show in dashes.
    faces.SetResolveCoincidentTopologyToPolygonOffset()
    faces.SetRelativeCoincidentTopologyPolygonOffsetParameters(1.0, 1.0)
    edges = vtkPolyDataMapper()
    used, index = np.unique(looks.edges, return_inverse=True)
    edges.SetInputData(_poly_data(looks.vertices[used], lines=index.reshape(-1, 2)))
    return faces, edges


def _poly_data(
    points: np.ndarray,
    *,
    triangles: np.ndarray | None = None,
    lines: np.ndarray | None = None,
    normals: np.ndarray | None = None,
) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints
    from vtkmodules.vtkCommonDataModel import vtkPolyData

    data, where = vtkPolyData(), vtkPoints()
    where.SetData(numpy_to_vtk(np.ascontiguousarray(points, dtype=np.float64), deep=True))
    data.SetPoints(where)
    if triangles is not None:
        data.SetPolys(_cells(triangles))
    if lines is not None:
        data.SetLines(_cells(lines))
    if normals is not None:
        data.GetPointData().SetNormals(numpy_to_vtk(np.ascontiguousarray(normals, dtype=np.float32), deep=True))
    return data


def _cells(corners: np.ndarray) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray

    cells, n = vtkCellArray(), corners.shape[1]
    offsets = np.arange(0, corners.size + 1, n, dtype=np.int64)
    flat = np.ascontiguousarray(corners.reshape(-1), dtype=np.int64)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets, deep=True), numpy_to_vtkIdTypeArray(flat, deep=True))
    return cells


def _actors(faces: Any, edges: Any, colour: tuple[float, float, float], T: np.ndarray) -> Iterator[Any]:
    from vtkmodules.vtkCommonMath import vtkMatrix4x4
    from vtkmodules.vtkRenderingCore import vtkActor

    matrix = vtkMatrix4x4()
    matrix.DeepCopy([float(v) for v in T.ravel()])
    body = vtkActor()
    body.SetMapper(faces)
    body.SetUserMatrix(matrix)
    surface = body.GetProperty()
    surface.SetColor(*colour)
    surface.SetAmbient(0.25)
    surface.SetDiffuse(0.75)
    surface.SetSpecular(0.25)
    surface.SetSpecularPower(25.0)
    yield body
    outline = vtkActor()
    outline.SetMapper(edges)
    outline.SetUserMatrix(matrix)
    outline.GetProperty().SetColor(*_EDGE_COLOUR)
    outline.GetProperty().SetLineWidth(1.2 * _SUPERSAMPLING)
    outline.GetProperty().LightingOff()
    yield outline


def _floor(cloud: np.ndarray, size: float) -> Any:
    """A disc under the assembly: it stands on something, and its shade shows where."""
    from vtkmodules.vtkFiltersSources import vtkDiskSource
    from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

    disc = vtkDiskSource()
    disc.SetInnerRadius(0.0)
    disc.SetOuterRadius(2.0 * size)
    disc.SetCircumferentialResolution(60)
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(disc.GetOutputPort())
    actor = vtkActor()
    actor.SetMapper(mapper)
    lower, upper = cloud.min(axis=0), cloud.max(axis=0)
    middle = 0.5 * (lower + upper)
    actor.SetPosition(middle[0], middle[1], lower[2] - 1e-3 * size)
    actor.GetProperty().SetColor(*_PAPER)
    actor.GetProperty().LightingOff()
    return actor


def _light(renderer: Any) -> None:
    """A key light from the upper left, a fill from the right and a weak one from the front, fixed to the camera."""
    from vtkmodules.vtkRenderingCore import vtkLight

    renderer.AutomaticLightCreationOff()
    for position, strength in (((-0.7, 1.0, 0.9), 0.75), ((1.0, 0.1, 0.8), 0.5), ((-0.3, -0.1, 1.0), 0.25)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(position)
        light.SetFocalPoint(0.0, 0.0, 0.0)
        light.SetIntensity(strength)
        renderer.AddLight(light)


def _aim(renderer: Any, cloud: np.ndarray) -> None:
    """Put the camera where the points just fill the picture."""
    eye = _VIEW / np.linalg.norm(_VIEW)
    right = np.cross([0.0, 0.0, 1.0], eye)
    right /= np.linalg.norm(right)
    up = np.cross(eye, right)
    half = np.tan(np.deg2rad(_VIEW_ANGLE_DEG) / 2.0) / _MARGIN
    across, over, near = cloud @ right, cloud @ up, cloud @ eye
    # A point at height y and nearness d fits if |y - y_0| <= half (distance - d): two planes per side of the picture.
    spans = []
    for along, slope in ((across, half * SIZE[0] / SIZE[1]), (over, half)):
        high, low = np.max(along + slope * near), np.min(along - slope * near)
        spans.append((0.5 * (high + low), 0.5 * (high - low) / slope))
    distance = max(spans[0][1], spans[1][1])
    middle = spans[0][0] * right + spans[1][0] * up
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(*middle)
    camera.SetPosition(*(middle + distance * eye))
    camera.SetViewUp(0.0, 0.0, 1.0)
    camera.SetViewAngle(_VIEW_ANGLE_DEG)
    # The floor reaches farther than the points; what lies beyond twice the distance is paper anyway.
    camera.SetClippingRange(0.5 * (distance - np.max(near - middle @ eye)), 2.0 * distance)


def _grab(renderer: Any) -> tuple[np.ndarray, np.ndarray]:
    """Draw off screen: pixels (height, width, 3) uint8 and distances from the eye [mm], rows from top to bottom."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonCore import vtkFloatArray, vtkUnsignedCharArray

    width, height = (side * _SUPERSAMPLING for side in SIZE)
    window = _window()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(width, height)
    window.AddRenderer(renderer)
    window.Render()
    colours, steps = vtkUnsignedCharArray(), vtkFloatArray()
    window.GetPixelData(0, 0, width - 1, height - 1, 0, colours, 0)
    window.GetZbufferData(0, 0, width - 1, height - 1, steps)
    near, far = renderer.GetActiveCamera().GetClippingRange()
    window.Finalize()
    pixels = vtk_to_numpy(colours).reshape(height, width, 3)[::-1]
    z = vtk_to_numpy(steps).reshape(height, width)[::-1].astype(np.float64)
    depths = np.where(z < 1.0, near * far / (far - z * (far - near)), np.inf)
    return pixels.copy(), depths


def _window() -> Any:
    """A window without a screen: EGL on Linux, the system's own elsewhere."""
    if not sys.platform.startswith("linux"):
        from vtkmodules.vtkRenderingCore import vtkRenderWindow

        return vtkRenderWindow()
    check_egl()
    from vtkmodules.vtkRenderingOpenGL2 import vtkEGLRenderWindow

    return vtkEGLRenderWindow()


def check_egl(library: str = "libEGL.so.1") -> None:
    """Make sure that the machine can draw without a screen, before the graphics library finds out the hard way.

    Raises:
        ReleaseError: names the system package.
    """
    try:
        ctypes.CDLL(library)
    except OSError as error:
        raise ReleaseError(
            f"preview.png cannot be drawn: {library} is missing; install it (Debian: apt-get install libegl1 libgl1)"
            " or set outputs.preview = false"
        ) from error


def _averaged(pixels: np.ndarray, n: int) -> np.ndarray:
    total = sum(pixels[i::n, j::n].astype(np.uint16) for i in range(n) for j in range(n))
    return np.asarray(total, dtype=np.float32) / np.float32(n * n)


def _write_png(pixels: np.ndarray, path: Path) -> None:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData
    from vtkmodules.vtkIOImage import vtkPNGWriter

    height, width, _ = pixels.shape
    image, writer = vtkImageData(), vtkPNGWriter()
    image.SetDimensions(width, height, 1)
    image.GetPointData().SetScalars(numpy_to_vtk(np.ascontiguousarray(pixels[::-1]).reshape(-1, 3), deep=True))
    writer.SetFileName(str(path))
    writer.SetInputData(image)
    writer.Write()
    if writer.GetErrorCode():
        raise ReleaseError(f"{path.name} cannot be written into {path.parent}")
