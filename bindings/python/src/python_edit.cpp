#include "python_edit.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/edits/clipboard/clipboard_builder.hpp"
#include "common/edits/descriptor/edit_geometry.hpp"
#include "common/edits/descriptor/edit_kind_name.hpp"

namespace runstone::python {
namespace {

/// More chunks than this are not listed.
constexpr std::uint64_t kTouchedChunksMax = 1 << 20;

// One class for each class of Python, all of them with the descriptor alone.
struct PythonSetVoxel : PythonEdit {};
struct PythonFillBox : PythonEdit {};
struct PythonFillSphere : PythonEdit {};
struct PythonFillStroke : PythonEdit {};
struct PythonPaste : PythonEdit {};

template <class T>
T checked(EditDescriptor edit) {
  if (const auto valid = validate(edit); !valid)
    refuse(name_of(kind_of(edit)), valid.error(), "point");
  T out;
  out.edit = std::move(edit);
  return out;
}

Mask mask_of(const py::object& mask) {
  if (py::isinstance<py::str>(mask)) {
    const auto word = mask.cast<std::string>();
    if (word == "everything") return {MaskKind::everything, kEmpty};
    if (word == "empty") return {MaskKind::only_empty, kEmpty};
    if (word == "solid") return {MaskKind::only_solid, kEmpty};
  } else if (py::hasattr(mask, "__index__")) {
    return {MaskKind::only_material, material_of(whole_number(mask, "a mask"))};
  }
  refuse("a mask is \"everything\", \"empty\", \"solid\" or the number of a material, got " +
         std::string(py::repr(mask)));
}

py::object mask_object(const Mask& mask) {
  switch (mask.kind) {
    case MaskKind::everything:
      return py::str("everything");
    case MaskKind::only_empty:
      return py::str("empty");
    case MaskKind::only_solid:
      return py::str("solid");
    case MaskKind::only_material:
      return py::int_(mask.material);
  }
  return py::none();
}

std::uint16_t radius_of(std::int64_t radius) {
  if (radius < 0 || radius > kEditRadiusMax) {
    refuse("a radius is a number from 0 to " + std::to_string(kEditRadiusMax) + ", got " +
           std::to_string(radius));
  }
  return static_cast<std::uint16_t>(radius);
}

/// Returns a corner of a half-open box, which may lie one voxel beyond the world.
VoxelPos corner_of(const Triple& at) {
  for (const std::int64_t number : at) {
    if (number < -kWorldLimit || number > kWorldLimit)
      refuse("the corner " + text_of(at) + " is outside the world");
  }
  return {static_cast<std::int32_t>(at[0]), static_cast<std::int32_t>(at[1]),
          static_cast<std::int32_t>(at[2])};
}

PythonFillStroke make_stroke(const std::vector<Triple>& points, std::int64_t radius,
                             std::int64_t material, const py::object& mask) {
  FillStroke stroke;
  for (const Triple& point : points) stroke.points.push_back(position_of(point));
  stroke.radius = radius_of(radius);
  return checked<PythonFillStroke>({std::move(stroke), mask_of(mask), material_of(material)});
}

std::shared_ptr<const Clipboard> clipboard_of(const py::array& cells,
                                              const std::optional<py::array>& touched) {
  const VoxelGrid grid = voxel_grid(cells);
  const std::array<std::int64_t, 3> shape = {static_cast<std::int64_t>(grid.sides[0]),
                                             static_cast<std::int64_t>(grid.sides[1]),
                                             static_cast<std::int64_t>(grid.sides[2])};
  for (const std::int64_t side : shape) {
    if (side < 1 || side > static_cast<std::int64_t>(kSideMax))
      refuse("the cells of a paste have 1 to 128 voxels a side, got " + text_of(shape));
  }
  using BoolArray = py::array_t<bool, py::array::c_style>;
  std::optional<BoolArray> kept;
  if (touched) {
    if (!py::isinstance<py::array_t<bool>>(*touched))
      refuse("touched has the dtype bool, got " + std::string(py::str(touched->dtype())));
    const bool is_equal = touched->ndim() == 3 && touched->shape(0) == shape[0] &&
                          touched->shape(1) == shape[1] && touched->shape(2) == shape[2];
    if (!is_equal) refuse("touched has another shape than the cells " + text_of(shape));
    // The elements are read in the order of the cells.
    const py::object plain = grid.order == AxisOrder::zyx
                                 ? touched->attr("copy")("C")
                                 : touched->attr("transpose")().attr("copy")("C");
    kept = py::reinterpret_borrow<BoolArray>(plain);
  }
  const Extent extent{static_cast<std::uint8_t>(shape[0]), static_cast<std::uint8_t>(shape[1]),
                      static_cast<std::uint8_t>(shape[2])};
  ClipboardBuilder builder(extent, grid.order);
  for (std::uint32_t i = 0; i < extent.volume(); ++i) {
    const bool is_touched = !kept || kept->data()[i];
    builder.append(1, is_touched ? std::optional(grid.data()[i]) : std::nullopt);
  }
  auto clipboard = builder.finish();
  if (!clipboard) refuse("cells of a paste", clipboard.error(), "cell");
  return *std::move(clipboard);
}

Orientation orientation_of(std::int64_t turns, const std::string& mirror) {
  Orientation out = Orientation{}.rotated_about_y(static_cast<int>(turns % 4));
  for (const char axis : mirror) {
    if (axis < 'x' || axis > 'z')
      refuse("mirror names axes of the world, such as \"x\" or \"xz\", got \"" + mirror + "\"");
    out = out.mirrored(static_cast<Axis>(axis - 'x'));
  }
  return out;
}

py::list chunk_list(const Self<PythonEdit>& self, std::int64_t edge) {
  if (edge != 16 && edge != 32 && edge != 64 && edge != 128)
    refuse("the edge of a chunk of a world is 16, 32, 64 or 128, got " + std::to_string(edge));
  const auto chunk_edge = static_cast<std::int32_t>(edge);
  if (touched_chunks_bound(self->edit, chunk_edge) > kTouchedChunksMax) {
    refuse("the edit may touch more than " + std::to_string(kTouchedChunksMax) +
           " chunks; a greater edge has fewer");
  }
  const std::vector<ChunkCoord> chunks = [&] {
    const py::gil_scoped_release released;
    return touched_chunks(self->edit, chunk_edge);
  }();
  py::list out;
  for (const ChunkCoord& at : chunks) out.append(py::make_tuple(at.x, at.y, at.z));
  return out;
}

std::string repr_of(const Self<PythonEdit>& self) {
  const VoxelBox box = bounding_box(self->edit);
  std::string text = std::string("<runstone.Edit ") + name_of(kind_of(self->edit));
  if (box.empty()) return text + ">";
  const auto corner = [](VoxelPos at) { return text_of({at.x, at.y, at.z}); };
  text += " " + corner(box.min) + " to " + corner(box.max);
  if (!std::holds_alternative<Paste>(self->edit.shape))
    text += ", material " + std::to_string(self->edit.material);
  return text + ">";
}

void define_base(py::module_& module) {
  py::class_<PythonEdit, std::shared_ptr<PythonEdit>>(
      module, "Edit",
      "An edit: a shape, a mask and a material. Edits never change.\n\n"
      "FillBox and the other classes make edits. docs/edit-log.md defines what "
      "each of them does.")
      .def_property_readonly(
          "kind", [](const Self<PythonEdit>& self) { return name_of(kind_of(self->edit)); },
          "The kind: voxel, box, sphere, stroke or paste. Records of a log may also have kinds "
          "without voxels, such as rights.")
      .def_property_readonly(
          "box", [](const Self<PythonEdit>& self) { return box_object(bounding_box(self->edit)); },
          "The smallest box that holds the shape, as ((x, y, z), (x, y, z)). The second corner is "
          "not in the box. None if the edit has no place.")
      .def_property_readonly(
          "material", [](const Self<PythonEdit>& self) { return self->edit.material; },
          "The material that is written. 0 removes voxels. 0 for a paste, whose cells have their "
          "own materials.")
      .def_property_readonly(
          "mask", [](const Self<PythonEdit>& self) { return mask_object(self->edit.mask); },
          "The voxels that may be overwritten: \"everything\", \"empty\", \"solid\" or the number "
          "of a material.")
      .def_property_readonly(
          "voxel_count", [](const Self<PythonEdit>& self) { return counted_voxels(self->edit); },
          "The number of voxels of the shape. For a stroke it is an upper bound.")
      .def(
          "chunks", &chunk_list, py::arg("edge"),
          "Return the chunks that the shape touches, as a list of (x, y, z) in ascending order.\n\n"
          "edge is the edge of the world's chunks: 16, 32, 64 or 128.\n"
          "Raise ValueError if the edit may touch more than 1048576 chunks.")
      .def(
          "encode", [](const Self<PythonEdit>& self) { return bytes_of(encode(self->edit)); },
          "Return the canonical bytes of the edit (docs/edit-log.md).")
      .def_static(
          "decode",
          [](const py::bytes& bytes) {
            const auto edit = decode_descriptor(view_of(bytes));
            if (!edit) refuse("bytes of an edit", edit.error());
            return object_of(*edit);
          },
          py::arg("bytes"),
          "Return the edit of canonical bytes. Raise ValueError for all other bytes.")
      .def(
          "__eq__",
          [](const Self<PythonEdit>& a, const Self<PythonEdit>& b) { return a->edit == b->edit; },
          py::is_operator())
      .def("__hash__",
           [](const Self<PythonEdit>& self) { return py::hash(bytes_of(encode(self->edit))); })
      .def("__repr__", &repr_of);
}

}  // namespace

py::object object_of(const EditDescriptor& edit) {
  switch (kind_of(edit)) {
    case EditKind::set_voxel:
      return py::cast(PythonSetVoxel{{edit}});
    case EditKind::fill_box:
      return py::cast(PythonFillBox{{edit}});
    case EditKind::fill_sphere:
      return py::cast(PythonFillSphere{{edit}});
    case EditKind::fill_stroke:
      return py::cast(PythonFillStroke{{edit}});
    case EditKind::paste:
      return py::cast(PythonPaste{{edit}});
    default:
      return py::cast(PythonEdit{edit});
  }
}

py::object box_object(const VoxelBox& box) {
  if (box.empty()) return py::none();
  return py::make_tuple(tuple_of(box.min), tuple_of(box.max));
}

void define_edits(py::module_& module) {
  define_base(module);
  const char* const any = "everything";
  py::class_<PythonSetVoxel, PythonEdit, std::shared_ptr<PythonSetVoxel>>(module, "SetVoxel",
                                                                          "An edit of one voxel.")
      .def(py::init([](const Triple& at, std::int64_t material, const py::object& mask) {
             return checked<PythonSetVoxel>(
                 {SetVoxel{position_of(at)}, mask_of(mask), material_of(material)});
           }),
           py::arg("at"), py::arg("material"), py::arg("mask") = any,
           "Set the voxel at (x, y, z) to a material.");
  py::class_<PythonFillBox, PythonEdit, std::shared_ptr<PythonFillBox>>(
      module, "FillBox", "An edit of all voxels of a box.")
      .def(py::init([](const Triple& min, const Triple& max, std::int64_t material,
                       const py::object& mask) {
             return checked<PythonFillBox>(
                 {FillBox{{corner_of(min), corner_of(max)}}, mask_of(mask), material_of(material)});
           }),
           py::arg("min"), py::arg("max"), py::arg("material"), py::arg("mask") = any,
           "Fill the box from the corner min to the corner max, which is not in the box.\n\n"
           "Each side has 1 to 4096 voxels.");
  py::class_<PythonFillSphere, PythonEdit, std::shared_ptr<PythonFillSphere>>(
      module, "FillSphere", "An edit of a sphere.")
      .def(
          py::init([](const Triple& centre, std::int64_t radius, std::int64_t material,
                      const py::object& mask) {
            return checked<PythonFillSphere>({FillSphere{position_of(centre), radius_of(radius)},
                                              mask_of(mask), material_of(material)});
          }),
          py::arg("centre"), py::arg("radius"), py::arg("material"), py::arg("mask") = any,
          "Fill the voxels whose squared distance from the centre is at most radius**2 + radius.\n\n"
          "The radius is 0 to 512.");
  py::class_<PythonFillStroke, PythonEdit, std::shared_ptr<PythonFillStroke>>(
      module, "FillStroke", "An edit of a sphere that is drawn along a line.")
      .def(py::init(&make_stroke), py::arg("points"), py::arg("radius"), py::arg("material"),
           py::arg("mask") = any,
           "Fill the voxels whose squared distance from the line through the points is at most "
           "radius**2 + radius.\n\n"
           "There are 2 to 256 points, and consecutive ones differ by at most 1024 along each "
           "axis. The radius is 1 to 512.");
  py::class_<PythonPaste, PythonEdit, std::shared_ptr<PythonPaste>>(
      module, "Paste", "An edit that writes an array of cells.")
      .def(py::init([](const Triple& at, const py::array& cells,
                       const std::optional<py::array>& touched, std::int64_t turns,
                       const std::string& mirror, const py::object& mask) {
             return checked<PythonPaste>({Paste{position_of(at), clipboard_of(cells, touched),
                                                orientation_of(turns, mirror)},
                                          mask_of(mask), kEmpty});
           }),
           py::arg("at"), py::arg("cells"), py::arg("touched") = py::none(), py::arg("turns") = 0,
           py::arg("mirror") = "", py::arg("mask") = any,
           "Write an array of materials with its lowest corner at (x, y, z).\n\n"
           "cells is an array of uint16 with the axes x, y, z and 1 to 128 voxels a side.\n"
           "touched is an array of bool of the same shape: where it is False, the world keeps its "
           "voxel. Without it every cell is written, empty ones too.\n"
           "turns are quarter turns about the y axis, which turn +z to +x. mirror names the axes "
           "of the world along which the turned cells are reversed, such as \"x\".\n"
           "The encoded cells may have 48 KiB.")
      .def_property_readonly(
          "orientation",
          [](const Self<PythonPaste>& self) {
            return std::get_if<Paste>(&self->edit.shape)->orientation.to_byte();
          },
          "The orientation as it is stored, 0 to 47 (docs/edit-log.md).");
}

}  // namespace runstone::python
