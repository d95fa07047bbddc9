// write_build(): an array of voxels as a file of another program.
#pragma once
#include "python_values.hpp"

namespace runstone::python {

/// Adds the function to the module. Requires the classes of define_world().
void define_build(py::module_& module);

}  // namespace runstone::python
