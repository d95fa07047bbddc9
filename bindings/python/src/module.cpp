// The module runstone._runstone of Python. The package runstone gives its names to users.
#include "common/core/version.hpp"
#include "python_build.hpp"
#include "python_chunk.hpp"
#include "python_client.hpp"
#include "python_edit.hpp"
#include "python_mesh.hpp"
#include "python_world.hpp"

PYBIND11_MODULE(_runstone, module) {
  using namespace runstone::python;
  module.doc() = "Chunks of voxels as runs, edits, meshes, worlds and the client of Runstone.";
  module.attr("__version__") = std::string(runstone::version());
  py::register_exception<RunstoneError>(module, "Error").attr("__doc__") =
      "A world that cannot be read, a file that cannot be written, or what a server refuses.";
  define_edits(module);
  define_mesh(module);
  define_chunk(module);
  define_world(module);
  define_build(module);
  define_client(module);
}
