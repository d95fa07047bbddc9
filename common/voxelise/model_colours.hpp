// ModelColours: the colour of a model at the point of a triangle that is nearest to the centre of a
// voxel. Internal to this room.
#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "common/core/coords.hpp"
#include "common/models/model.hpp"
#include "common/voxelise/model_placement.hpp"

namespace runstone {

using VoxelRgb = std::array<std::uint8_t, 3>;

class ModelColours {
 public:
  /// Both must outlive the object. Requires a model that validate() accepts. Cost: O(triangles).
  ModelColours(const Model& model, const ModelPlacement& placement);

  /// Returns the one colour that the model has, or nullopt if it may have several, or parts without
  /// a surface.
  const std::optional<VoxelRgb>& only() const { return only_; }
  /// Returns the colour of a voxel on which nothing is known: that of the first triangle's
  /// material.
  VoxelRgb fallback() const;

  /// A point of a triangle as shares of its corners, and the square of its distance in units.
  struct Nearest {
    std::array<double, 3> shares{};
    double distance2 = 0;
  };
  /// Returns the point of a triangle that is nearest to the centre of a voxel. Source: Ericson,
  /// "Real-Time Collision Detection" (2005), 5.1.5.
  Nearest nearest(std::uint32_t triangle, VoxelPos voxel) const;
  /// Returns the colour of the material, times that of the texture, times that between the
  /// vertices; nullopt if the texel has alpha below 128, which is no surface. Other values of alpha
  /// are ignored.
  std::optional<VoxelRgb> at(std::uint32_t triangle, const Nearest& nearest) const;
  /// Returns true if a triangle has one colour everywhere.
  bool is_plain(std::uint32_t triangle) const;

  VoxelRgb of_point(std::uint32_t point) const;

 private:
  const ModelMaterial* material_of(std::uint32_t triangle) const {
    return model_->material_of.empty() ? nullptr
                                       : &model_->materials[model_->material_of[triangle]];
  }
  const Model* model_;
  const ModelPlacement* placement_;
  std::optional<VoxelRgb> only_;
};

}  // namespace runstone
