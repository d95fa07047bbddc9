// GltfHead: the JSON of a .gltf or .glb, and where its bytes end.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>

#include "common/model_reader/model_folder.hpp"

namespace runstone {

/// The bytes of a .glb before its JSON: the heads of the file and of its first chunk.
inline constexpr std::size_t kGlbHeadBytes = 20;

struct GltfHead {
  std::string json;        // any bytes
  bool is_binary = false;  // true: a .glb, whatever the file is called
  std::uint64_t end = 0;   // offset in the file of the first byte behind the JSON
};

/// Reads the head of a file. Blocks on the disk. Memory: the JSON.
GltfHead gltf_head(const OpenedFile& file);

}  // namespace runstone
