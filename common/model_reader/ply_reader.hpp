// Reads a .ply. Assimp is not used for it: on a cut file in binary form its parser does not end.
// Thread: one. Calls block on the disk. Cost: O(bytes).
#pragma once
#include <string>

#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/reader_notices.hpp"
#include "common/model_reader/scene_model.hpp"
#include "common/models/model.hpp"

namespace runstone {

/// Reads vertices with their colours and texture places, faces, strips of triangles and the texture
/// that a comment names. A polygon becomes a fan of triangles. A file without faces is a cloud of
/// points. Fails with one line that does not name the file if it is damaged, or has more than rules
/// allow. Memory: the model.
Result<Model, std::string> read_ply(const ModelFolder& folder, const SceneRules& rules,
                                    ReaderNotices& notices);

}  // namespace runstone
