// What there is to measure on, by name: the seeded worlds, a Luanti world, and the 37 scenarios of the
// thesis.
#pragma once
#include <set>
#include <string>
#include <vector>

#include "common/core/result.hpp"
#include "tests/bench/worlds/voxel_world.hpp"

namespace runstone::bench {

/// The volumes of one world at one edge.
struct MeasuredWorld {
  std::string name;
  std::shared_ptr<const VisibilityTable> visibility;
  std::vector<Volume> volumes;
  std::vector<std::string> parts;  // a name for each
  std::string missing;             // why there are none, or not all; empty if all is well
};

std::set<std::string> measured_world_names();
/// Of those the ones that look like places people build in.
std::set<std::string> landscape_names();

class MeasuredWorlds {
 public:
  /// The worlds of these names, all if there are none, in a fixed order. Fails if the Luanti world is among
  /// them and cannot be read.
  static Result<MeasuredWorlds, std::string> open(const std::vector<std::string>& names,
                                                  const std::string& luanti_folder);

  std::size_t size() const { return names_.size(); }
  const std::string& name(std::size_t world) const { return names_[world]; }
  /// Null for the scenarios.
  const VoxelWorld* voxels(std::size_t world) const;
  MeasuredWorld at_edge(std::size_t world, unsigned edge) const;

 private:
  std::vector<std::string> names_;
  std::vector<VoxelWorld> worlds_;
};

}  // namespace runstone::bench
