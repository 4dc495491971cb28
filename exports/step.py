"""The CAD file: the assembly with names, colours and nesting by group, and each made part on its own."""

from __future__ import annotations

import importlib.metadata
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.designs.language.errors import ReleaseError
from linkwright.designs.language.materials import material
from linkwright.generator.assembly import AssembledBody, Assembly

from .products import Product, ProductKey, product_key, products_of
from .step_canonical import StepHeader, canonical_step

if TYPE_CHECKING:
    from OCP.TDF import TDF_Label
    from OCP.TopLoc import TopLoc_Location

#: AP214 is what every CAD program reads; it carries names, colours and nesting.
_SCHEMA = "AP214IS"


def write_assembly_step(assembly: Assembly, Ts_base_body: np.ndarray, path: Path) -> None:
    """Write the whole assembly at given body poses: design, group, body, part; equal parts are one product.

    Args:
        assembly: what to write.
        Ts_base_body: poses of the bodies in the order of the assembly, shape (n_bodies, 4, 4) [mm].
        path: file to write, in millimetres.

    Raises:
        ReleaseError: the kernel's writer refused.
    """
    design = assembly.design
    document = _Document()
    products = products_of(assembly)
    labels = {key: document.add_product(product) for key, product in products.items()}
    root = document.add_assembly(root_name(assembly))
    groups: dict[str, TDF_Label] = {}
    for placed, T_base_body in zip(assembly.bodies, Ts_base_body, strict=True):
        group = placed.body.group
        if group and group not in groups:
            groups[group] = document.add_assembly(group)
        body = _add_body(document, placed, labels)
        document.add_instance(groups[group] if group else root, body, placed.body.name, T_base_body)
    for name, label in groups.items():
        document.add_instance(root, label, name, np.eye(4))
    document.write(path, _header(design.name, f"{design.name}: assembly in its home pose, design {design.hash}"))


def write_part_step(product: Product, path: Path, design_hash: str) -> None:
    """Write one part in its own frame, in millimetres.

    Raises:
        ReleaseError: the kernel's writer refused.
    """
    document = _Document()
    document.add_product(product)
    document.write(path, _header(product.name, f"{product.name}, {product.part.material}, design {design_hash}"))


def root_name(assembly: Assembly) -> str:
    """Name of the topmost product: the design's, told apart from what hangs directly below it."""
    name = assembly.design.name
    below = {body.body.group or body.body.name for body in assembly.bodies}
    return f"{name}_assembly" if name in below else name


def location(T: np.ndarray) -> TopLoc_Location:
    """A rigid pose, shape (4, 4) [mm], as the kernel's location."""
    from OCP.gp import gp_Trsf
    from OCP.TopLoc import TopLoc_Location

    trsf = gp_Trsf()
    trsf.SetValues(*(float(v) for v in np.asarray(T)[:3].ravel()))
    return TopLoc_Location(trsf)


def _add_body(document: _Document, placed: AssembledBody, labels: dict[ProductKey, TDF_Label]) -> TDF_Label:
    body = document.add_assembly(placed.body.name)
    for part in placed.parts:
        label = labels[product_key(part.part, part.solid)]
        document.add_instance(body, label, part.part.name, part.T_body_part)
    return body


def _header(name: str, description: str) -> StepHeader:
    return StepHeader(
        name=name, description=description, system=f"linkwright {importlib.metadata.version('linkwright')}"
    )


class _Document:
    """An XCAF document: products, assemblies of them, names and colours."""

    def __init__(self) -> None:
        from OCP.TCollection import TCollection_ExtendedString
        from OCP.TDocStd import TDocStd_Document
        from OCP.XCAFDoc import XCAFDoc_DocumentTool

        self._document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(self._document.Main())
        self._colours = XCAFDoc_DocumentTool.ColorTool_s(self._document.Main())
        self._shapes.SetAutoNaming_s(False)

    def add_product(self, product: Product) -> TDF_Label:
        label = self._shapes.AddShape(product.solid.shape, False)
        self._name(label, product.name)
        self._paint(label, material(product.part.material).colour)
        return label

    def add_assembly(self, name: str) -> TDF_Label:
        from OCP.BRep import BRep_Builder
        from OCP.TopoDS import TopoDS_Compound

        compound = TopoDS_Compound()
        BRep_Builder().MakeCompound(compound)
        label = self._shapes.AddShape(compound, True)
        self._name(label, name)
        return label

    def add_instance(self, parent: TDF_Label, child: TDF_Label, name: str, T: np.ndarray) -> None:
        self._name(self._shapes.AddComponent(parent, child, location(T)), name)

    def write(self, path: Path, header: StepHeader) -> None:
        """Transfer, write next to the kernel's own idea of a file, and put it into canonical order."""
        from OCP.IFSelect import IFSelect_RetDone
        from OCP.STEPCAFControl import STEPCAFControl_Writer
        from OCP.STEPControl import STEPControl_AsIs

        self._shapes.UpdateAssemblies()
        quiet_kernel()
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        _set_static({"write.step.schema": _SCHEMA, "write.step.unit": "MM", "write.step.product.name": header.name})
        if not writer.Transfer(self._document, STEPControl_AsIs):
            raise ReleaseError(f"{header.name}: the CAD kernel could not turn the assembly into STEP")
        with tempfile.TemporaryDirectory() as folder:
            raw = Path(folder) / "raw.step"
            if writer.Write(str(raw)) != IFSelect_RetDone:
                raise ReleaseError(f"{header.name}: the CAD kernel could not write its STEP file into {folder}")
            text = raw.read_text(encoding="latin-1")
        path.write_text(canonical_step(text, header), encoding="ascii", newline="\n")

    def _name(self, label: TDF_Label, name: str) -> None:
        from OCP.TCollection import TCollection_ExtendedString
        from OCP.TDataStd import TDataStd_Name

        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))

    def _paint(self, label: TDF_Label, colour: tuple[float, float, float]) -> None:
        from OCP.Quantity import Quantity_Color, Quantity_TOC_sRGB
        from OCP.XCAFDoc import XCAFDoc_ColorSurf

        self._colours.SetColor(label, Quantity_Color(*colour, Quantity_TOC_sRGB), XCAFDoc_ColorSurf)


def quiet_kernel() -> None:
    """Keep the kernel's transfer statistics out of the terminal; failures still come through as return codes."""
    from OCP.Message import Message, Message_Gravity

    for printer in _printers(Message.DefaultMessenger_s()):
        printer.SetTraceLevel(Message_Gravity.Message_Fail)


def _printers(messenger: Any) -> Iterable[Any]:
    return messenger.Printers()


def _set_static(values: dict[str, str]) -> None:
    """Set the kernel's process-wide writer options each time: another library may have changed them."""
    from OCP.Interface import Interface_Static

    for key, value in values.items():
        if not Interface_Static.SetCVal_s(key, value):
            raise ReleaseError(f"the CAD kernel does not know the STEP option {key} = {value}")
