// Generator: makes base chunks from a seed, as runs, never through a grid. Worlds are unbounded in x and z
// and bounded in y. A world's `meta` pins generator name, version and parameters: equal pins give equal
// voxels on every compiler, build type and machine, for ever; a change of output is a new version.
#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "common/core/coords.hpp"
#include "common/core/result.hpp"
#include "common/materials/material_table.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

/// What pins a generator. `parameters` is canonical TOML of that generator alone (empty for its defaults);
/// see generator_parameters.hpp, whose to_toml() writes it.
struct GeneratorPin {
  std::string name;  // "empty", "flat", "terrain", "scenario"
  std::uint32_t version = 1;
  std::uint64_t seed = 0;
  std::string parameters;
  friend bool operator==(const GeneratorPin&, const GeneratorPin&) = default;
};

class Generator {
 public:
  virtual ~Generator() = default;
  /// Voxels of the chunk whose first voxel is `origin`, canonical, in the order that suits the generator
  /// (callers that keep the chunk rotate it with in_cheapest_order). Any thread.
  virtual RunChunk generate(VoxelPos origin, Extent extent) const = 0;
  /// Vertical range outside of which everything is empty or one material: chunks there are uniform.
  virtual std::int32_t y_min() const = 0;
  virtual std::int32_t y_max() const = 0;  // one past
  /// Highest non-empty voxel of a column + 1: where a player may stand. Cheap (no chunk is made).
  virtual std::int32_t surface_y(std::int32_t x, std::int32_t z) const = 0;
};

/// Makes the pinned generator; fails with not_found or bad_version for pins this build lacks (it then refuses
/// to generate), with bad_value for parameters it cannot read, with not_found for parameters that name a
/// material the table lacks. The table must outlive nothing: rules are copied.
Result<std::unique_ptr<Generator>> make_generator(const GeneratorPin& pin,
                                                  const MaterialTable& materials);

}  // namespace runstone
