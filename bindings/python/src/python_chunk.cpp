#include "python_chunk.hpp"

#include <optional>
#include <utility>
#include <vector>

#include "common/core/thread_scratch.hpp"
#include "common/edits/apply/checked_edits.hpp"
#include "common/runs/dense.hpp"
#include "common/runs/reorder.hpp"
#include "protocol/chunks/chunk_codec.hpp"
#include "python_edit.hpp"
#include "python_mesh.hpp"

namespace runstone::python {
namespace {

using ChunkObject = std::shared_ptr<PythonChunk>;

Extent chunk_extent_of(const Triple& sides) {
  for (const std::int64_t side : sides) {
    if (side < static_cast<std::int64_t>(kSideMin) || side > static_cast<std::int64_t>(kSideMax))
      refuse("a chunk has 8 to 128 voxels a side, got " + text_of(sides));
  }
  return {static_cast<std::uint8_t>(sides[0]), static_cast<std::uint8_t>(sides[1]),
          static_cast<std::uint8_t>(sides[2])};
}

ChunkObject from_numpy(const py::array& array, const std::optional<std::string>& order) {
  const VoxelGrid grid = voxel_grid(array);
  const Extent extent = chunk_extent_of({static_cast<std::int64_t>(grid.sides[0]),
                                         static_cast<std::int64_t>(grid.sides[1]),
                                         static_cast<std::int64_t>(grid.sides[2])});
  const std::optional<AxisOrder> wanted =
      order ? std::optional(axis_order_of(*order)) : std::nullopt;
  count_dense_expansion();
  auto chunk = from_dense(extent, grid.order, std::span(grid.data(), extent.volume()));
  if (!chunk) refuse("array", chunk.error(), "voxel");
  if (!wanted) return make_chunk(in_cheapest_order(*std::move(chunk)));
  return make_chunk(*wanted == grid.order ? *std::move(chunk) : reorder(*chunk, *wanted));
}

/// Returns an array that shows `count` elements of the object's memory.
py::array shown(const py::dtype& type, std::size_t count, std::size_t stride, const void* first,
                const py::object& owner) {
  return read_only(py::array(type, std::vector<py::ssize_t>{static_cast<py::ssize_t>(count)},
                             std::vector<py::ssize_t>{static_cast<py::ssize_t>(stride)}, first,
                             owner));
}

py::array runs_of(const py::object& self) {
  const auto chunk = self.cast<Self<PythonChunk>>();
  const RunList& list = chunk->voxels.runs;
  if (list.is_narrow()) {
    return list.visit([&](auto runs) -> py::array {
      if constexpr (std::is_same_v<decltype(runs), NarrowRuns>) {
        return shown(py::dtype::of<PackedRun>(), runs.size(), sizeof(PackedRun),
                     runs.packed().data(), self);
      }
      return {};
    });
  }
  py::array_t<Run> copy(static_cast<py::ssize_t>(list.size()));
  for (std::size_t i = 0; i < list.size(); ++i) copy.mutable_data()[i] = list[i];
  return read_only(std::move(copy));
}

py::array run_ends(const py::object& self) {
  return self.cast<Self<PythonChunk>>()->voxels.runs.visit([&](auto runs) {
    if constexpr (std::is_same_v<decltype(runs), NarrowRuns>) {
      return shown(py::dtype::of<std::uint16_t>(), runs.size(), sizeof(PackedRun),
                   &runs.packed()[0].end, self);
    } else {
      return shown(py::dtype::of<std::uint32_t>(), runs.size(), sizeof(std::uint32_t),
                   runs.ends().data(), self);
    }
  });
}

py::array run_materials(const py::object& self) {
  return self.cast<Self<PythonChunk>>()->voxels.runs.visit([&](auto runs) {
    if constexpr (std::is_same_v<decltype(runs), NarrowRuns>) {
      return shown(py::dtype::of<Material>(), runs.size(), sizeof(PackedRun),
                   &runs.packed()[0].material, self);
    } else {
      return shown(py::dtype::of<Material>(), runs.size(), sizeof(Material),
                   runs.materials().data(), self);
    }
  });
}

py::bytes encoded(const Self<PythonChunk>& self, const std::string& encoding) {
  for (const ChunkEncoding known :
       {ChunkEncoding::raw, ChunkEncoding::packed, ChunkEncoding::coded}) {
    if (encoding == name_of(known)) return bytes_of(encode_chunk(self->voxels, known));
  }
  refuse("an encoding is \"raw\", \"packed\" or \"coded\", got \"" + encoding + "\"");
}

ChunkObject decoded(const py::bytes& bytes) {
  auto chunk = decode_chunk(view_of(bytes));
  if (!chunk) refuse("bytes of a chunk", chunk.error());
  return make_chunk(*std::move(chunk));
}

std::vector<EditDescriptor> edits_of(const py::object& edits) {
  if (py::isinstance<PythonEdit>(edits)) return {edits.cast<Self<PythonEdit>>()->edit};
  std::vector<EditDescriptor> out;
  if (!py::isinstance<py::iterable>(edits))
    refuse("expected an edit or a sequence of edits, got " + std::string(py::repr(edits)));
  for (const py::handle edit : edits) {
    if (!py::isinstance<PythonEdit>(edit))
      refuse("expected a sequence of edits, got " + std::string(py::repr(edit)) + " in it");
    out.push_back(edit.cast<Self<PythonEdit>>()->edit);
  }
  return out;
}

ChunkObject applied(const Self<PythonChunk>& self, const py::object& edits, const Triple& key) {
  const std::vector<EditDescriptor> stack = edits_of(edits);
  const auto sides = self->voxels.extent.sides();
  Triple origin{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (key[axis] < -kWorldLimit || key[axis] > kWorldLimit)
      refuse("the chunk " + text_of(key) + " is outside the world");
    origin[axis] = key[axis] * sides[axis];
  }
  const VoxelPos first = position_of(origin);
  auto out = std::make_shared<PythonChunk>(*self);
  const auto done = [&] {
    const py::gil_scoped_release released;
    auto result = with_scratch<ApplyScratch>([&](ApplyScratch& scratch) {
      return try_apply_stack(out->voxels, out->digest, first, stack, scratch);
    });
    out->voxels.runs.shrink_to_fit();
    return result;
  }();
  if (!done) refuse("edits", done.error(), "edit");
  return out;
}

/// Returns true if both chunks have equal voxels, in any axis order.
bool are_equal(const Self<PythonChunk>& a, const Self<PythonChunk>& b) {
  if (a->voxels.extent != b->voxels.extent || a->digest != b->digest) return false;
  if (a->voxels.order == b->voxels.order) return a->voxels == b->voxels;
  return a->voxels == reorder(b->voxels, a->voxels.order);
}

Material voxel_at(const Self<PythonChunk>& self, const Triple& at) {
  const auto sides = self->voxels.extent.sides();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (at[axis] < 0 || at[axis] >= sides[axis])
      throw py::index_error("the voxel " + text_of(at) + " is outside the chunk");
  }
  return material_at(self->voxels,
                     {static_cast<std::uint8_t>(at[0]), static_cast<std::uint8_t>(at[1]),
                      static_cast<std::uint8_t>(at[2])});
}

std::string chunk_text(const Self<PythonChunk>& self) {
  const Extent& e = self->voxels.extent;
  return "<runstone.Chunk of " + std::to_string(e.x) + " x " + std::to_string(e.y) + " x " +
         std::to_string(e.z) + " voxels, " + std::to_string(self->voxels.runs.size()) +
         " runs in the order " + word_of(self->voxels.order) + ">";
}

}  // namespace

ChunkObject make_chunk(RunChunk voxels) {
  const Digest digest = digest_of(voxels);
  return std::make_shared<PythonChunk>(PythonChunk{std::move(voxels), digest});
}

void define_chunk(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(PackedRun, end, material);
  PYBIND11_NUMPY_DTYPE(Run, end, material);
  py::class_<PythonChunk, ChunkObject>(
      module, "Chunk",
      "A cuboid of voxels, kept as runs of one material. Chunks never change.\n\n"
      "Arrays of voxels have the axes x, y (up), z and the dtype uint16: a voxel is the number of "
      "its material, and 0 is empty. A chunk has 8 to 128 voxels a side.")
      .def_static("from_numpy", &from_numpy, py::arg("array"), py::arg("order") = py::none(),
                  "Return the chunk of an array of uint16 with three axes of 8 to 128.\n\n"
                  "order is the axis order of the runs, fastest axis first, such as \"xyz\". "
                  "Without it the order with the fewest runs is taken.\n"
                  "Raise ValueError for another dtype or shape.")
      .def_static(
          "uniform",
          [](const Triple& shape, std::int64_t material) {
            return make_chunk(uniform_chunk(chunk_extent_of(shape), material_of(material)));
          },
          py::arg("shape"), py::arg("material") = 0, "Return a chunk of one material.")
      .def_static("decode", &decoded, py::arg("bytes"),
                  "Return the chunk of encoded bytes, in any encoding (docs/protocol.md).\n\n"
                  "Raise ValueError for bytes that are no chunk.")
      .def("encode", &encoded, py::arg("encoding") = "packed",
           "Return the bytes of the chunk. The encoding is \"raw\", \"packed\" or \"coded\" "
           "(docs/protocol.md).")
      .def(
          "to_numpy", [](const Self<PythonChunk>& self) { return array_of(self->voxels); },
          "Return a new array of the voxels.")
      .def("runs", &runs_of,
           "Return the runs as an array with the fields end and material.\n\n"
           "A run covers the voxels from the end of the run before it to its own end, in the axis "
           "order of the chunk. The array cannot be written. It shows the memory of the chunk if "
           "the chunk has at most 65535 voxels, and is a copy otherwise.")
      .def_property_readonly("run_ends", &run_ends,
                             "The ends of the runs, as an array that shows the memory of the "
                             "chunk: uint16 up to 65535 voxels, uint32 otherwise.")
      .def_property_readonly("run_materials", &run_materials,
                             "The materials of the runs, as an array of uint16 that shows the "
                             "memory of the chunk.")
      .def_property_readonly(
          "shape",
          [](const Self<PythonChunk>& self) {
            const Extent& e = self->voxels.extent;
            return py::make_tuple(e.x, e.y, e.z);
          },
          "The sides (x, y, z) in voxels.")
      .def_property_readonly(
          "order", [](const Self<PythonChunk>& self) { return word_of(self->voxels.order); },
          "The axis order of the runs, fastest axis first.")
      .def(
          "reorder",
          [](const Self<PythonChunk>& self, const std::optional<std::string>& order) {
            if (!order) return make_chunk(in_cheapest_order(self->voxels));
            return make_chunk(reorder(self->voxels, axis_order_of(*order)));
          },
          py::arg("order") = py::none(),
          "Return the same voxels in another axis order. Without an order the one with the fewest "
          "runs is taken.")
      .def_property_readonly(
          "run_count", [](const Self<PythonChunk>& self) { return self->voxels.runs.size(); },
          "The number of runs.")
      .def_property_readonly(
          "digest", [](const Self<PythonChunk>& self) { return to_hex(self->digest); },
          "The digest of the voxels as 32 hexadecimal digits. It does not depend on the axis "
          "order.")
      .def("apply", &applied, py::arg("edits"), py::arg("key") = Triple{0, 0, 0},
           "Return the chunk after an edit, or after a sequence of edits, the first one first.\n\n"
           "key is the place (x, y, z) of the chunk in the grid of chunks: its lowest voxel is at "
           "key times shape. Edits that miss the chunk do nothing.")
      .def(
          "mesh",
          [](const Self<PythonChunk>& self, const std::optional<PythonNeighbours>& neighbours,
             const std::optional<std::vector<std::int64_t>>& visibility) {
            return make_mesh(*self, neighbours, visibility);
          },
          py::arg("neighbours") = py::none(), py::arg("visibility") = py::none(),
          "Return the mesh of the chunk.\n\n"
          "neighbours are the six chunks around it or None, in the order -x, +x, -y, +y, -z, +z. "
          "Where there is none, its voxels count as empty.\n"
          "visibility has a number for each material: 0 empty, 1 opaque, 2 transparent. Materials "
          "behind its end are opaque.")
      .def("__getitem__", &voxel_at, py::arg("at"),
           "Return the material at (x, y, z), counted from the lowest corner of the chunk.")
      .def("__eq__", &are_equal, py::is_operator())
      .def("__hash__",
           [](const Self<PythonChunk>& self) { return py::hash(py::str(to_hex(self->digest))); })
      .def("__repr__", &chunk_text)
      .def(py::pickle([](const Self<PythonChunk>& self) { return encoded(self, "packed"); },
                      [](const py::bytes& bytes) { return decoded(bytes); }));
}

}  // namespace runstone::python
