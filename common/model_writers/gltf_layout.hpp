// GltfLayout: the counts of a glTF model, from which its JSON and the places in its buffer follow.
// The buffer has, level by level and region by region, the vertices of all parts and then their
// indices. A part is a primitive with three accessors: positions, normals, indices.
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/core/coords.hpp"
#include "common/mesh/quad_corners.hpp"
#include "common/model_writers/model_levels.hpp"
#include "common/model_writers/model_output.hpp"
#include "common/model_writers/model_writing.hpp"

namespace runstone {

struct GltfPart {
  std::uint16_t number = 0;  // cell number of the finest level
  std::uint32_t vertices = 0, indices = 0;
  Corner min{}, max{};  // of the places of its vertices, in sixteenths of a voxel
  /// Returns the bytes of an index. 65,535 is no index of a u16.
  std::uint32_t index_bytes() const { return vertices <= 65'535 ? 2 : 4; }
  /// Returns the bytes of all indices, with those that fill up the last four.
  std::uint64_t indices_bytes() const {
    return (std::uint64_t{indices} * index_bytes() + 3) / 4 * 4;
  }
};

struct GltfRegion {
  VoxelPos origin;  // in cells of its level
  std::size_t first_part = 0, part_count = 0;
  /// True: the places of a quantised model are sixteenths of a voxel. False: they are voxels.
  bool is_fine = false;
  std::uint64_t vertices_bytes = 0, indices_bytes = 0;
};

/// The bytes of a vertex, and where its normal begins.
struct GltfVertex {
  std::uint32_t bytes = 24, normal_at = 12;
};
constexpr GltfVertex gltf_vertex(bool is_quantised, bool is_fine) {
  if (!is_quantised) return {24, 12};
  return is_fine ? GltfVertex{12, 8} : GltfVertex{8, 4};
}

struct GltfLayout {
  /// Counts what the levels give. Fails with bad_value if the finest one gives no face, and as
  /// ModelWalk::check() does.
  static Result<GltfLayout> of(ModelLevels& levels, bool is_quantised);

  std::vector<GltfRegion> regions;      // of all levels, the finest first
  std::vector<std::size_t> level_ends;  // by level: the end of its regions
  std::vector<GltfPart> parts;
  std::uint64_t buffer_bytes = 0;
};

/// Writes the JSON of a model up to the buffer: what follows are the members of its object, then
/// "}]}".
void write_gltf_json(const WrittenBuild& source, const ModelWriting& writing,
                     const GltfLayout& layout, ModelOutput& out);

/// Writes the part of the buffer that a region takes. Each call writes a multiple of four bytes.
void write_gltf_region(const RegionModel& region, bool is_quantised, ModelOutput& out);

}  // namespace runstone
