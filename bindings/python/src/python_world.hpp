// The objects runstone.World, LogRecord and Material: a world on disk, read only.
#pragma once
#include <string>

#include "common/core/material_row.hpp"
#include "python_values.hpp"

namespace runstone::python {

/// A material of a world, or of an array that becomes a file.
struct PythonMaterial {
  std::int64_t id = 0;
  std::string name;
  MaterialColour colour{128, 128, 128, 255};
  Visibility visibility = Visibility::opaque;
};

/// Adds the classes to the module. Requires the classes of define_chunk().
void define_world(py::module_& module);

}  // namespace runstone::python
