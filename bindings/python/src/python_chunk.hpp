// PythonChunk: the object runstone.Chunk. It never changes, so the arrays that show its runs stay
// valid as long as they live, and threads of Python may share it.
#pragma once
#include <memory>

#include "common/core/digest.hpp"
#include "python_values.hpp"

namespace runstone::python {

struct PythonChunk {
  RunChunk voxels;
  Digest digest;  // of the voxels
};

/// Makes a chunk of valid runs, with their digest.
std::shared_ptr<PythonChunk> make_chunk(RunChunk voxels);

/// Adds the class Chunk to the module. Requires the classes of define_edits() and define_mesh().
void define_chunk(py::module_& module);

}  // namespace runstone::python
