// The objects runstone.ClientEvent and _runstone.ClientCore: the client of the C++ library. The
// class runstone.Client of the package joins the core to asyncio.
#pragma once
#include "python_values.hpp"

namespace runstone::python {

/// Adds the classes to the module. Requires the classes of define_world().
void define_client(py::module_& module);

}  // namespace runstone::python
