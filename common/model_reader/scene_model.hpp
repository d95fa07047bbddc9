// Makes a model of a scene that Assimp read: nodes, instances and materials become triangles with
// colours. Thread: one. Cost: O(nodes + triangles).
#pragma once
#include <cstddef>
#include <string>

#include "common/core/result.hpp"
#include "common/model_reader/model_folder.hpp"
#include "common/model_reader/reader_notices.hpp"
#include "common/models/model.hpp"
#include "common/models/model_format.hpp"

struct aiScene;

namespace runstone {

struct SceneRules {
  ModelFormat format = ModelFormat::obj;
  ModelUp up = ModelUp::y;
  std::size_t triangles_max = kModelTrianglesMax;
  /// The materials of an .obj are in a file that is missing, so their colours are unknown.
  bool lacks_materials = false;
};

/// Returns the model of a scene. The meshes of the scene are freed as soon as they are copied. Fails if
/// the scene has neither triangle nor point, has more of them than allowed, or a texture that is too
/// large. The error is one line.
/// - Transforms of nodes are applied, each instance is a copy, and mirrored ones are turned, so that
///   triangles stay counter-clockwise from outside.
/// - Triangles and points with coordinates that are not finite are left out, with a notice.
/// - Points and lines beside triangles, animations, bones and morph targets are left out, with a
///   notice.
Result<Model, std::string> model_of_scene(aiScene& scene, const SceneRules& rules,
                                          const ModelFolder& folder, ReaderNotices& notices);

}  // namespace runstone
