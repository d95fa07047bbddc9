// The answers to an addition of materials and to shapes that are given.
#pragma once
#include <cstddef>
#include <optional>
#include <string>

#include "common/core/ids.hpp"

namespace runstone {

/// Where added materials are.
struct AddedAt {
  Sequence seq = 0;    // of the last record
  Material first = 0;  // id of the first one
};

/// Why materials were not added, as a sentence.
struct MaterialsRefusal {
  std::string what;
  std::optional<std::size_t> row;  // number of the bad row, if one is to blame
};

}  // namespace runstone
