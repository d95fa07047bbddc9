#include "python_mesh.hpp"

#include <cstring>
#include <span>
#include <utility>

#include "common/core/thread_scratch.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/mesh/rdm/checked_mesh.hpp"

namespace runstone::python {

/// A quad as an element of an array of numpy.
struct QuadRow {
  std::uint8_t x = 0, y = 0, z = 0, width = 0, height = 0, direction = 0;
  std::uint16_t material = 0;
};

namespace {

/// The corners and triangles of a mesh.
struct PythonVertices {
  py::array_t<float> positions, normals;
  py::array_t<std::uint16_t> materials;
  py::array_t<std::uint32_t> triangles;
};

py::array quad_rows(std::initializer_list<std::span<const Quad>> passes) {
  std::size_t count = 0;
  for (const auto& pass : passes) count += pass.size();
  py::array_t<QuadRow> array(static_cast<py::ssize_t>(count));
  QuadRow* out = array.mutable_data();
  for (const auto& pass : passes) {
    for (const Quad quad : pass) {
      const QuadFields q = unpack(quad);
      *out++ = {q.x,       q.y, q.z, q.width, q.height, static_cast<std::uint8_t>(q.direction),
                q.material};
    }
  }
  return read_only(std::move(array));
}

/// Returns the packed quads of a pass without a copy.
py::array packed_quads(const py::object& self, const QuadLayers& pass) {
  static_assert(sizeof(Quad) == sizeof(std::uint64_t));
  return read_only(py::array(py::dtype::of<std::uint64_t>(),
                             std::vector<py::ssize_t>{static_cast<py::ssize_t>(pass.quads.size())},
                             std::vector<py::ssize_t>{sizeof(std::uint64_t)}, pass.quads.data(),
                             self));
}

PythonVertices vertices_of(const ChunkMesh& mesh) {
  const auto quads =
      static_cast<py::ssize_t>(mesh.opaque.quads.size() + mesh.transparent.quads.size());
  PythonVertices out{py::array_t<float>({4 * quads, py::ssize_t{3}}),
                     py::array_t<float>({4 * quads, py::ssize_t{3}}),
                     py::array_t<std::uint16_t>(4 * quads),
                     py::array_t<std::uint32_t>({2 * quads, py::ssize_t{3}})};
  float* position = out.positions.mutable_data();
  float* normal = out.normals.mutable_data();
  std::uint16_t* material = out.materials.mutable_data();
  std::uint32_t* triangle = out.triangles.mutable_data();
  std::uint32_t first = 0;
  for (const QuadLayers* pass : {&mesh.opaque, &mesh.transparent}) {
    for (const Quad quad : pass->quads) {
      const QuadFields fields = unpack(quad);
      for (const Corner& corner : quad_corners(quad)) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          *position++ = static_cast<float>(corner[axis]);
          const bool is_across = axis == static_cast<std::size_t>(axis_of(fields.direction));
          *normal++ = !is_across ? 0.0F : is_positive(fields.direction) ? 1.0F : -1.0F;
        }
        *material++ = fields.material;
      }
      for (const std::uint32_t corner : {0U, 1U, 2U, 0U, 2U, 3U}) *triangle++ = first + corner;
      first += 4;
    }
  }
  return out;
}

VisibilityTable table_of(const std::optional<std::vector<std::int64_t>>& visibility) {
  std::vector<Visibility> rows;
  if (visibility) {
    for (const std::int64_t number : *visibility) {
      if (number < 0 || number > 2) {
        refuse("a visibility is 0 (empty), 1 (opaque) or 2 (transparent), got " +
               std::to_string(number));
      }
      rows.push_back(static_cast<Visibility>(number));
    }
  }
  auto table = visibility_table(rows);
  if (!table) refuse("visibility", table.error(), "material");
  return *std::move(table);
}

}  // namespace

std::shared_ptr<PythonMesh> make_mesh(const PythonChunk& chunk,
                                      const std::optional<PythonNeighbours>& neighbours,
                                      const std::optional<std::vector<std::int64_t>>& visibility) {
  MeshNeighbours around{};
  if (neighbours) {
    if (neighbours->size() != kDirectionCount) {
      refuse("neighbours are six chunks or None, in the order -x, +x, -y, +y, -z, +z; got " +
             std::to_string(neighbours->size()));
    }
    for (std::size_t d = 0; d < kDirectionCount; ++d) {
      const auto& neighbour = (*neighbours)[d];
      around[d] = neighbour == nullptr ? nullptr : &neighbour->voxels;
    }
  }
  const VisibilityTable table = table_of(visibility);
  auto out = std::make_shared<PythonMesh>();
  const auto made = [&] {
    const py::gil_scoped_release released;
    return with_scratch<RdmScratch>([&](RdmScratch& scratch) {
      return try_mesh_rdm(chunk.voxels, around, table, scratch, out->mesh);
    });
  }();
  if (!made) refuse("mesh", made.error(), "direction");
  return out;
}

void define_mesh(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(QuadRow, x, y, z, width, height, direction, material);
  py::class_<PythonVertices, std::shared_ptr<PythonVertices>>(
      module, "Vertices", "The corners and triangles of a mesh.")
      .def_property_readonly(
          "positions", [](const Self<PythonVertices>& self) { return self->positions; },
          "Array of float32 of the shape (corners, 3): x, y, z in voxels from the lowest "
          "corner of the chunk. Each quad has four corners of its own.")
      .def_property_readonly(
          "normals", [](const Self<PythonVertices>& self) { return self->normals; },
          "Array of float32 of the shape (corners, 3).")
      .def_property_readonly(
          "materials", [](const Self<PythonVertices>& self) { return self->materials; },
          "Array of uint16: the material of each corner.")
      .def_property_readonly(
          "triangles", [](const Self<PythonVertices>& self) { return self->triangles; },
          "Array of uint32 of the shape (triangles, 3): indices of corners, "
          "counter-clockwise seen from outside.");
  py::class_<PythonMesh, std::shared_ptr<PythonMesh>>(
      module, "Mesh", "The visible faces of a chunk, joined to quads. Meshes never change.")
      .def("__len__",
           [](const Self<PythonMesh>& self) {
             return self->mesh.opaque.quads.size() + self->mesh.transparent.quads.size();
           })
      .def_property_readonly(
          "quads",
          [](const Self<PythonMesh>& self) {
            return quad_rows({self->mesh.opaque.quads, self->mesh.transparent.quads});
          },
          "All quads as an array with the fields x, y, z (the voxel of the lowest corner), width, "
          "height (1 to 128), direction (0 to 5: -x, +x, -y, +y, -z, +z) and material.\n\n"
          "The width runs along y, z, x and the height along z, x, y for directions along x, y, z. "
          "Opaque quads come first.")
      .def_property_readonly(
          "opaque",
          [](const Self<PythonMesh>& self) { return quad_rows({self->mesh.opaque.quads}); },
          "The opaque quads, in the form of quads.")
      .def_property_readonly(
          "transparent",
          [](const Self<PythonMesh>& self) { return quad_rows({self->mesh.transparent.quads}); },
          "The transparent quads, in the form of quads.")
      .def_property_readonly(
          "opaque_packed",
          [](const py::object& self) {
            return packed_quads(self, self.cast<Self<PythonMesh>>()->mesh.opaque);
          },
          "The opaque quads as they are drawn: an array of uint64 without a copy "
          "(common/mesh/quad.hpp has the bits).")
      .def_property_readonly(
          "transparent_packed",
          [](const py::object& self) {
            return packed_quads(self, self.cast<Self<PythonMesh>>()->mesh.transparent);
          },
          "The transparent quads as they are drawn, in the form of opaque_packed.")
      .def(
          "vertices", [](const Self<PythonMesh>& self) { return vertices_of(self->mesh); },
          "Return the corners and triangles of all quads. Opaque quads come first.")
      .def("__repr__", [](const Self<PythonMesh>& self) {
        return "<runstone.Mesh of " + std::to_string(self->mesh.opaque.quads.size()) +
               " opaque and " + std::to_string(self->mesh.transparent.quads.size()) +
               " transparent quads>";
      });
}

}  // namespace runstone::python
