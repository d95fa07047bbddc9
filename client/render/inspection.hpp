// Inspection: how a frame shows the storage and the meshes of chunks, on top of the faces:
//   wireframe   the edges of quads
//   runs        the faces at which a stored run ends, in the axis order of its chunk
//   orders      the axis order of each chunk, as a tint
//   layers      the layers that were meshed again a moment ago, as a tint that fades
// It costs nothing while no mode is on. Plain data.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "common/core/coords.hpp"
#include "common/runs/axis_order.hpp"
#include "common/runs/dirty_layers.hpp"
#include "common/runs/run_chunk.hpp"

namespace runstone {

enum class InspectionMode : std::uint8_t { wireframe, runs, orders, layers };
inline constexpr std::size_t kInspectionModeCount = 4;
inline constexpr std::array<InspectionMode, kInspectionModeCount> kInspectionModes = {
    InspectionMode::wireframe, InspectionMode::runs, InspectionMode::orders,
    InspectionMode::layers};

/// Returns the name in scripts and in the interface.
constexpr std::string_view to_string(InspectionMode mode) {
  constexpr std::array<std::string_view, kInspectionModeCount> kNames = {"wireframe", "runs",
                                                                         "orders", "layers"};
  return kNames[static_cast<std::size_t>(mode)];
}
std::optional<InspectionMode> parse_inspection_mode(std::string_view name);

class InspectionModes {
 public:
  bool operator[](InspectionMode mode) const { return is_on_[static_cast<std::size_t>(mode)]; }
  void set(InspectionMode mode, bool is_on) { is_on_[static_cast<std::size_t>(mode)] = is_on; }
  bool any() const { return is_on_ != decltype(is_on_){}; }
  friend bool operator==(const InspectionModes&, const InspectionModes&) = default;

 private:
  std::array<bool, kInspectionModeCount> is_on_{};
};

/// The runs of a chunk whose runs or order are shown.
struct InspectedChunk {
  ChunkKey key;
  std::shared_ptr<const RunChunk> voxels;  // not null
  bool shows_runs = false;                 // the ends of its runs, besides its order
};

/// Layers of a chunk that were meshed again.
struct FlashedLayers {
  ChunkKey key;
  DirtyLayers layers;
  float strength = 0;  // 0 .. 1
};

struct Inspection {
  InspectionModes modes;
  std::vector<InspectedChunk> chunks;  // ascending by key; empty unless runs or orders are shown
  std::vector<FlashedLayers> flashes;  // ascending by key; empty unless layers are shown
};

/// A colour, red, green, blue, 0 to 255.
using InspectionColour = std::array<std::uint8_t, 3>;
/// The tint of an axis order. The fastest axis decides the hue: x red, y green, z blue.
constexpr InspectionColour colour_of(AxisOrder order) {
  constexpr std::array<InspectionColour, kAxisOrderCount> kColours = {{{235, 64, 52},
                                                                       {255, 150, 40},
                                                                       {60, 200, 70},
                                                                       {190, 220, 40},
                                                                       {60, 110, 255},
                                                                       {160, 80, 240}}};
  return kColours[static_cast<std::size_t>(order)];
}

/// Returns bit i % 32 of word i / 32 set if a run starts at voxel i of the chunk, in its axis
/// order. Requires a volume that is a multiple of 32. Cost: O(runs + volume / 32).
std::vector<std::uint32_t> run_start_bits(const RunChunk& chunk);

}  // namespace runstone
