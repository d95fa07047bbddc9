// The extensions of glTF that a file requires. Assimp does not look at them, and would make rubbish of a
// file that is compressed in a way that it does not know. Thread: one.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"

namespace runstone {

/// Returns the names in the array "extensionsRequired" of a .gltf, at most 64. Cost: O(bytes).
std::vector<std::string> required_extensions(std::string_view json);

/// What the extensions of a file ask of its reader.
struct Extensions {
  bool is_quantised =
      false;  // KHR_mesh_quantization, which Assimp does not read: plain_gltf() does
};

/// Fails with one line that does not name the file if the .gltf or .glb requires an extension that is
/// not read. Blocks on the disk. Memory: the JSON of the file.
Result<Extensions, std::string> check_extensions(const OpenedFile& file);

}  // namespace runstone
