#include "common/model_reader/gltf_head.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace runstone {

GltfHead gltf_head(const OpenedFile& file) {
  GltfHead out;
  std::array<std::uint8_t, kGlbHeadBytes> head{};
  const std::size_t got = file.read(head.data(), head.size(), 0);
  std::uint64_t begin = 0, bytes = file.bytes();
  if (got == head.size() && std::memcmp(head.data(), "glTF", 4) == 0) {
    out.is_binary = true;
    begin = kGlbHeadBytes;
    bytes = std::uint64_t{head[12]} | std::uint64_t{head[13]} << 8 | std::uint64_t{head[14]} << 16 |
            std::uint64_t{head[15]} << 24;
    bytes = std::min<std::uint64_t>(bytes, file.bytes() - begin);
  }
  out.json.resize(static_cast<std::size_t>(bytes));
  out.json.resize(file.read(out.json.data(), out.json.size(), begin));
  out.end = begin + out.json.size();
  return out;
}

}  // namespace runstone
