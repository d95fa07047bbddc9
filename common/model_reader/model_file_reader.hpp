// Reads a model from a file of a ModelFolder: with Assimp, but for .ply (ply_reader.hpp). Thread:
// one. Calls block on the disk.
#pragma once
#include <string>

#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/scene_model.hpp"
#include "common/models/model_bytes.hpp"

namespace runstone {

/// Reads the file of the folder. Only the parser of the format is used, whatever the content of the
/// file. Throws std::bad_alloc if memory runs out. The error is one line that does not name the file:
/// "refers to "../secret.bin", which is outside its folder".
Result<ReadModel, std::string> read_model_in(const ModelFolder& folder, const SceneRules& rules);

}  // namespace runstone
