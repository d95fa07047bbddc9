#include "common/model_reader/scene_model.hpp"

#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/model_reader/finite_model.hpp"
#include "common/model_reader/scene_materials.hpp"

namespace runstone {
namespace {

/// A mesh at a place.
struct MeshUse {
  std::uint32_t mesh = 0;
  aiMatrix4x4 to_world;
};

std::string with_count(std::size_t count, const char* one, const char* many) {
  return std::to_string(count) + (count == 1 ? one : many);
}

class SceneCopy {
 public:
  SceneCopy(aiScene& scene, const SceneRules& rules, const ModelFolder& folder,
            ReaderNotices& notices)
      : scene_(scene),
        rules_(rules),
        notices_(notices),
        materials_(scene, rules, folder, model_, notices) {}

  Result<Model, std::string> run();

 private:
  Result<void, std::string> find_uses();
  Result<void, std::string> count();
  Result<void, std::string> choose_attributes();
  Result<void, std::string> copy(const MeshUse& use);
  void copy_vertices(const aiMesh& mesh, const MeshUse& use);
  Result<void, std::string> copy_triangles(const aiMesh& mesh, std::uint32_t first,
                                           std::optional<std::uint32_t> material, bool is_mirrored);
  void note_what_is_lost();

  aiScene& scene_;
  const SceneRules& rules_;
  ReaderNotices& notices_;
  Model model_;
  SceneMaterials materials_;
  std::vector<MeshUse> uses_;
  std::vector<std::size_t> uses_of_;       // by mesh
  std::vector<std::size_t> triangles_of_;  // by mesh
  bool is_cloud_ = false;
  bool has_materials_ = false, has_places_ = false, has_colours_ = false;
};

Result<void, std::string> SceneCopy::find_uses() {
  std::vector<std::pair<const aiNode*, aiMatrix4x4>> waiting;
  if (scene_.mRootNode != nullptr) waiting.emplace_back(scene_.mRootNode, aiMatrix4x4());
  uses_of_.assign(scene_.mNumMeshes, 0);
  while (!waiting.empty()) {
    const auto [node, above] = waiting.back();
    waiting.pop_back();
    const aiMatrix4x4 to_world = above * node->mTransformation;
    for (std::uint32_t i = 0; i < node->mNumMeshes; ++i) {
      const std::uint32_t mesh = node->mMeshes[i];
      if (mesh >= scene_.mNumMeshes || scene_.mMeshes[mesh] == nullptr)
        return failure(std::string("a node names a mesh that does not exist"));
      ++uses_of_[mesh];
      uses_.push_back({mesh, to_world});
    }
    for (std::uint32_t i = 0; i < node->mNumChildren; ++i)
      waiting.emplace_back(node->mChildren[i], to_world);
  }
  return {};
}

/// Counts triangles and vertices, and decides if the model is a cloud of points.
Result<void, std::string> SceneCopy::count() {
  std::size_t triangles = 0, vertices = 0, points = 0, others = 0;
  for (std::uint32_t i = 0; i < scene_.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene_.mMeshes[i];
    std::size_t own = 0, not_own = 0;
    for (std::uint32_t f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices == 3) ++own;
      if (mesh.mFaces[f].mNumIndices != 3) ++not_own;
    }
    triangles_of_.push_back(own);
    // At most 2^32 uses of 2^32 each.
    triangles += own * uses_of_[i];
    others += not_own * uses_of_[i];
    if (own == 0 && (mesh.mPrimitiveTypes & aiPrimitiveType_POINT) != 0)
      points += std::size_t{mesh.mNumVertices} * uses_of_[i];
    if (own != 0) vertices += std::size_t{mesh.mNumVertices} * uses_of_[i];
  }
  is_cloud_ = triangles == 0;
  if (is_cloud_ && points == 0)
    return failure(std::string("the file has no triangle and no point"));
  if (triangles > rules_.triangles_max) {
    return failure("the file has " + std::to_string(triangles) + " triangles, and at most " +
                   std::to_string(rules_.triangles_max) + " are allowed");
  }
  const std::size_t kept = is_cloud_ ? points : vertices;
  if (kept > kModelVerticesMax) {
    return failure("the file has " + std::to_string(kept) + " vertices, and at most " +
                   std::to_string(kModelVerticesMax) + " are allowed");
  }
  const std::size_t lost = is_cloud_ ? 0 : others + points;
  if (lost > 0) {
    notices_.add(with_count(lost, " point or line is left out: only triangles are kept",
                            " points and lines are left out: only triangles are kept"));
  }
  model_.positions.reserve(kept);
  model_.triangles.reserve(triangles);
  return {};
}

/// Decides which attributes the vertices of the model have: those that a copied mesh has.
Result<void, std::string> SceneCopy::choose_attributes() {
  has_materials_ = !is_cloud_ && !materials_.are_defaults();
  for (const MeshUse& use : uses_) {
    const aiMesh& mesh = *scene_.mMeshes[use.mesh];
    if ((triangles_of_[use.mesh] == 0) != is_cloud_) continue;
    has_colours_ = has_colours_ || mesh.HasVertexColors(0);
    if (!has_materials_) continue;
    const auto material = materials_.number_of(mesh.mMaterialIndex);
    if (!material) return failure(material.error());
    has_places_ =
        has_places_ || (model_.materials[*material].texture.has_value() &&
                        mesh.HasTextureCoords(materials_.place_set_of(mesh.mMaterialIndex)));
  }
  if (has_places_) model_.texture_places.reserve(model_.positions.capacity());
  if (has_colours_) model_.colours.reserve(model_.positions.capacity());
  if (has_materials_) model_.material_of.reserve(model_.triangles.capacity());
  return {};
}

void SceneCopy::copy_vertices(const aiMesh& mesh, const MeshUse& use) {
  const bool is_linear = rules_.format == ModelFormat::gltf || rules_.format == ModelFormat::glb;
  const std::uint32_t set = materials_.place_set_of(mesh.mMaterialIndex);
  const aiVector3D* const places =
      has_places_ && mesh.HasTextureCoords(set) ? mesh.mTextureCoords[set] : nullptr;
  const aiColor4D* const colours = mesh.HasVertexColors(0) ? mesh.mColors[0] : nullptr;
  // Assimp gives colours of three numbers the alpha 0.
  const bool has_alpha =
      colours != nullptr &&
      std::any_of(colours, colours + mesh.mNumVertices, [](const aiColor4D& c) { return c.a > 0; });
  for (std::uint32_t v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D at = use.to_world * mesh.mVertices[v];
    model_.positions.push_back(turned(at.x, at.y, at.z, rules_.up));
    if (has_places_) {
      std::array<float, 2> place{0, 0};
      if (places != nullptr) place = {places[v].x, places[v].y};
      model_.texture_places.push_back(place);
    }
    if (has_colours_) {
      ModelColour colour{255, 255, 255, 255};
      if (colours != nullptr) {
        const aiColor4D& c = colours[v];
        const auto byte = is_linear ? srgb_byte : unit_byte;
        colour = {byte(c.r), byte(c.g), byte(c.b), has_alpha ? unit_byte(c.a) : std::uint8_t{255}};
      }
      model_.colours.push_back(colour);
    }
  }
}

Result<void, std::string> SceneCopy::copy_triangles(const aiMesh& mesh, std::uint32_t first,
                                                    std::optional<std::uint32_t> material,
                                                    bool is_mirrored) {
  for (std::uint32_t f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices != 3) continue;
    std::array<std::uint32_t, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      if (face.mIndices[k] >= mesh.mNumVertices)
        return failure(std::string("a triangle names a vertex that does not exist"));
      corners[k] = first + face.mIndices[k];
    }
    if (is_mirrored) std::swap(corners[1], corners[2]);
    model_.triangles.push_back(corners);
    if (material) model_.material_of.push_back(*material);
  }
  return {};
}

Result<void, std::string> SceneCopy::copy(const MeshUse& use) {
  aiMesh*& mesh = scene_.mMeshes[use.mesh];
  const bool is_wanted = is_cloud_ ? (mesh->mPrimitiveTypes & aiPrimitiveType_POINT) != 0
                                   : triangles_of_[use.mesh] != 0;
  if (is_wanted && mesh->mNumVertices > 0) {
    std::optional<std::uint32_t> material;
    if (has_materials_) {
      const auto number = materials_.number_of(mesh->mMaterialIndex);
      if (!number) return failure(number.error());
      material = *number;
    }
    const auto first = static_cast<std::uint32_t>(model_.positions.size());
    copy_vertices(*mesh, use);
    const bool is_mirrored = use.to_world.Determinant() < 0;
    if (const auto copied = copy_triangles(*mesh, first, material, is_mirrored); !copied)
      return copied;
  }
  if (--uses_of_[use.mesh] == 0) {
    delete mesh;
    mesh = nullptr;
  }
  return {};
}

void SceneCopy::note_what_is_lost() {
  if (scene_.mNumAnimations > 0)
    notices_.add("animations are left out: the model stands as the file places it");
}

Result<Model, std::string> SceneCopy::run() {
  if (const auto found = find_uses(); !found) return failure(found.error());
  bool has_bones = false, has_morphs = false;
  for (std::uint32_t i = 0; i < scene_.mNumMeshes; ++i) {
    has_bones = has_bones || scene_.mMeshes[i]->HasBones();
    has_morphs = has_morphs || scene_.mMeshes[i]->mNumAnimMeshes > 0;
  }
  if (has_bones) notices_.add("bones are left out: the model stands in its pose of rest");
  if (has_morphs) notices_.add("morph targets are left out");
  if (const auto counted = count(); !counted) return failure(counted.error());
  if (const auto chosen = choose_attributes(); !chosen) return failure(chosen.error());
  for (const MeshUse& use : uses_) {
    if (const auto copied = copy(use); !copied) return failure(copied.error());
  }
  note_what_is_lost();
  if (!leave_out_not_finite(model_, notices_))
    return failure(std::string("the places in the file are no finite numbers"));
  if (rules_.format == ModelFormat::gltf || rules_.format == ModelFormat::glb)
    model_.metres_per_unit = 1;
  if (const auto valid = validate(model_); !valid) return failure(std::string(valid.error().what));
  return std::move(model_);
}

}  // namespace

Result<Model, std::string> model_of_scene(aiScene& scene, const SceneRules& rules,
                                          const ModelFolder& folder, ReaderNotices& notices) {
  return SceneCopy(scene, rules, folder, notices).run();
}

}  // namespace runstone
