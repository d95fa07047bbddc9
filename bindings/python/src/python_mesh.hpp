// PythonMesh: the object runstone.Mesh: the quads of a chunk. It never changes.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "common/mesh/chunk_mesh.hpp"
#include "python_chunk.hpp"
#include "python_values.hpp"

namespace runstone::python {

struct PythonMesh {
  ChunkMesh mesh;
};

/// The six chunks around a chunk by Direction, of which any may be missing.
using PythonNeighbours = std::vector<std::shared_ptr<PythonChunk>>;

/// Makes the mesh of the chunk. `visibility` has a number for each material, as its enumeration;
/// materials behind its end are opaque. Throws a ValueError if there are not six neighbours, if one
/// has other sides than the chunk where they touch, or for an unknown visibility.
std::shared_ptr<PythonMesh> make_mesh(const PythonChunk& chunk,
                                      const std::optional<PythonNeighbours>& neighbours,
                                      const std::optional<std::vector<std::int64_t>>& visibility);

/// Adds the classes Mesh and Vertices to the module.
void define_mesh(py::module_& module);

}  // namespace runstone::python
