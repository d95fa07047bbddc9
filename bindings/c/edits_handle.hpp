// The object behind runstone_edits: edits in the order in which they are applied.
#pragma once
#include <cstddef>
#include <vector>

#include "bindings/c/handle.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"

struct runstone_edits : runstone::c_interface::Handle<0x74696465> {
  std::vector<runstone::EditDescriptor> list;
};

namespace runstone::c_interface {

/// Returns an edit of a list. Refuses what live() refuses, and an index that is too large.
inline const EditDescriptor& edit_at(const runstone_edits* edits, std::size_t index) {
  const auto& list = live(edits, "edits").list;
  if (index >= list.size())
    refuse(RUNSTONE_BAD_ARGUMENT, "index", "is not below the number of edits");
  return list[index];
}

}  // namespace runstone::c_interface
