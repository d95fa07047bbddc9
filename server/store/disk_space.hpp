// DiskSpace: whether the disk of a world has room for more edits.
#pragma once
#include <cstdint>

namespace runstone {

enum class DiskSpace : std::uint8_t {
  enough,
  low,  // less is free than the reserve: queued edits are written, new ones are rejected
  full  // a write found no room: it is repeated, and new edits are rejected
};

}  // namespace runstone
