// LibraryRow: what the world strand keeps of a build of the library: who added it, and its size.
#pragma once
#include <cstdint>

#include "common/core/ids.hpp"

namespace runstone {

struct LibraryRow {
  Sequence number = 0;  // of the build: the sequence of the record that added it
  AuthorId author = 0;  // who added it; 0: the console
  std::uint64_t file_bytes = 0;
  friend bool operator==(const LibraryRow&, const LibraryRow&) = default;
};

}  // namespace runstone
