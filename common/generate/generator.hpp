// Generator: makes base chunks from a seed, as runs, without a grid. Worlds are unbounded in x and
// z and bounded in y. A world's `meta` pins name, version and parameters of its generator. Equal
// pins give equal voxels on every compiler, build type and machine. A change of the output is a new
// version.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// The fields that pin a generator. `parameters` is canonical TOML of that generator alone, and
/// empty for its defaults. to_toml() in generator_parameters.hpp writes it.
struct GeneratorPin {
  std::string name;  // "empty", "flat", "landscape", "terrain", "scenario"
  std::uint32_t version = 1;
  std::uint64_t seed = 0;
  std::string parameters;
  friend bool operator==(const GeneratorPin&, const GeneratorPin&) = default;
};

class Generator {
 public:
  virtual ~Generator() = default;
  /// Returns the chunk whose first voxel is `origin`. It is canonical and in the order that suits
  /// the generator; callers that keep the chunk rotate it with in_cheapest_order(). Thread: any.
  virtual RunChunk generate(VoxelPos origin, Extent extent) const = 0;
  /// Returns a tile without making the chunks below it: a cube of `edge` voxels a side, each of
  /// them 2^level chunk voxels wide, whose first chunk voxel is `origin`. It is canonical. It
  /// approximates the tile that follows from the chunks: heights and materials of the surface are
  /// close, and enclosed voxels may have any opaque material. It is exact where the tile is empty.
  /// Returns nullopt if the generator has no such form for this place: then only the chunks give
  /// the tile. Requires `edge` 16, 32, 64 or 128, level at most 8, and an origin that is a multiple
  /// of edge * 2^level. Cost: up to three times that of generate() for the same edge.
  /// Thread: any.
  virtual std::optional<RunChunk> coarse(VoxelPos origin, std::int32_t edge,
                                         std::uint8_t level) const;
  /// Return the vertical range outside of which chunks are uniform: empty or of one material.
  virtual std::int32_t y_min() const = 0;
  virtual std::int32_t y_max() const = 0;  // one past
  /// Returns the highest non-empty voxel of a column + 1, where a player may stand. It makes no
  /// chunk.
  virtual std::int32_t surface_y(std::int32_t x, std::int32_t z) const = 0;
  /// Returns the voxel in which the eyes of a new player should be, if the generator knows a good
  /// place, otherwise nullopt. Cost: about 0.1 s.
  virtual std::optional<VoxelPos> spawn() const { return std::nullopt; }
};

/// Makes the pinned generator. `materials` need not outlive it: rules are copied. Fails
///   - with not_found or bad_version for a generator that this build lacks;
///   - with bad_value for parameters that it cannot read;
///   - with not_found for parameters that name a material which the table lacks.
Result<std::unique_ptr<Generator>> make_generator(const GeneratorPin& pin,
                                                  const MaterialTable& materials);

/// Returns the coarse form of a world that is empty outside of `bounds`: the empty tile if the tile
/// lies outside, otherwise nullopt. The arguments are those of Generator::coarse().
std::optional<RunChunk> coarse_outside(const VoxelBox& bounds, VoxelPos origin, std::int32_t edge,
                                       std::uint8_t level);

}  // namespace runstone
