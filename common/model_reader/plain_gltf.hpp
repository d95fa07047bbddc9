// PlainGltf: a .gltf or .glb with the attributes of its vertices as floats, made of one that has
// them as integers (KHR_mesh_quantization). Assimp copies integers as if they were floats. The JSON
// is replaced, and names a further buffer with the floats. Everything else stays where it is.
// Thread: one.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"

namespace runstone {

/// The file that the further buffer names. It exists in memory alone.
inline constexpr std::string_view kFloatsFile = "floats.runstone";

struct PlainGltf {
  std::string head;           // what stands in place of the beginning of the file
  std::uint64_t rest_at = 0;  // the bytes of the file that follow the head, from here on
  std::string floats;         // the content of kFloatsFile
};

/// Reads a file of the folder. Fails if an accessor leaves its buffer, is sparse or damaged, if a
/// buffer cannot be read, and if the floats take more than 1 GiB. The error is one line. Throws
/// std::bad_alloc if memory runs out. Blocks on the disk. Memory: the JSON, buffers in it, and the
/// floats. Cost: O(bytes).
Result<PlainGltf, std::string> plain_gltf(const ModelFolder& folder, const OpenedFile& file);

}  // namespace runstone
