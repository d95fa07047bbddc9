// The extensions of glTF that a file requires. Assimp ignores them: it reads wrong numbers from a file
// that is compressed in a way that it does not know. Thread: one.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"

namespace runstone {

/// Returns the names in the array "extensionsRequired" of a .gltf, at most 64. Cost: O(bytes).
std::vector<std::string> required_extensions(std::string_view json);

/// The required extensions of a file that need work before Assimp reads the file.
struct Extensions {
  /// The file requires KHR_mesh_quantization. Assimp does not read it; plain_gltf() does.
  bool is_quantised = false;
};

/// Fails with one line that does not name the file if the .gltf or .glb requires an extension that is
/// not read. Blocks on the disk. Memory: the JSON of the file.
Result<Extensions, std::string> check_extensions(const OpenedFile& file);

}  // namespace runstone
