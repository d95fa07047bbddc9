// PythonEdit: the objects runstone.Edit and its classes, one for each kind of edit with voxels. They
// never change.
#pragma once
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "python_values.hpp"

namespace runstone::python {

struct PythonEdit {
  EditDescriptor edit;  // valid
};

/// Returns the object of the class that fits the kind of the edit. A kind without voxels has the
/// class Edit.
py::object object_of(const EditDescriptor& edit);

/// Returns a box as two positions, its lowest corner and the corner beyond its highest one, or None
/// if it is empty.
py::object box_object(const VoxelBox& box);

/// Adds the classes to the module.
void define_edits(py::module_& module);

}  // namespace runstone::python
