// The worlds to measure on, by name: the seeded worlds, a Luanti world, and the thesis' 37
// scenarios.
#pragma once
#include <functional>
#include <iosfwd>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "bench/worlds/voxel_world.hpp"
#include "common/core/result.hpp"

namespace runstone::bench {

/// The volumes of one world at one edge.
struct MeasuredWorld {
  std::string name;
  std::shared_ptr<const VisibilityTable> visibility;
  std::vector<Volume> volumes;
  std::vector<std::string> parts;  // a name for each volume
  std::string missing;             // why volumes are missing; empty if none are
};

std::set<std::string> measured_world_names();
/// Returns the names of the worlds that look like places people build in.
std::set<std::string> landscape_names();

class MeasuredWorlds {
 public:
  /// Opens the worlds of these names in a fixed order; all worlds if there are no names. Fails if
  /// the Luanti world is among them and cannot be read.
  static Result<MeasuredWorlds, std::string> open(const std::vector<std::string>& names,
                                                  const std::string& luanti_folder);

  std::size_t size() const { return names_.size(); }
  const std::string& name(std::size_t world) const { return names_[world]; }
  /// Returns null for the scenarios.
  const VoxelWorld* voxels(std::size_t world) const;
  MeasuredWorld at_edge(std::size_t world, unsigned edge) const;

  /// Measures a world, given by its number and its volumes at one edge.
  using Measure =
      std::function<void(std::size_t number, const MeasuredWorld& world, unsigned edge)>;
  /// Calls `measure` for each world at each edge, and prints a line of progress after each call.
  /// Appends a line to `skipped` for each world and edge with missing volumes.
  void measure_each(std::span<const unsigned> edges, const Measure& measure,
                    std::vector<std::string>& skipped, std::ostream& progress) const;

 private:
  std::vector<std::string> names_;
  std::vector<VoxelWorld> worlds_;
};

}  // namespace runstone::bench
