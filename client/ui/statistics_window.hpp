// The window of measurements (F3): frames, chunks, memory, traffic and the latency of edits.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "client/input/key_map.hpp"
#include "client/render/inspection.hpp"

namespace runstone {

inline constexpr std::size_t kStageCount = 7;

/// One edit on its path to the screen: the milliseconds from its submit to the end of each stage.
struct EditWay {
  bool is_local = false;
  std::array<double, kStageCount> end_ms{};  // negative: the edit has no such stage
};

/// Bytes of one class of messages.
struct ClassTraffic {
  const char* name = "";    // a static text
  std::uint64_t bytes = 0;  // since the start
  double bytes_per_second = 0;
};

struct StatisticsState {
  std::string renderer;         // name of the OpenGL context
  std::vector<float> frame_ms;  // time to draw each of the last frames, the newest one last
  double frames_per_second = 0;
  std::uint32_t chunks_drawn = 0, chunks_culled = 0;
  std::uint64_t quads_drawn = 0;
  std::uint64_t chunk_bytes = 0, edit_bytes = 0, mesh_bytes = 0, gpu_bytes = 0;
  std::uint64_t texture_bytes = 0, bytes_max = 0;
  std::size_t tiles = 0;
  unsigned tile_levels = 0;  // of the view
  std::uint32_t tile_parts_drawn = 0;
  std::uint64_t far_bytes = 0, far_bytes_max = 0;  // of tiles and their meshes
  double reach = 0;                                // how far ground is seen, voxels
  std::uint64_t mesh_jobs = 0;
  std::optional<double> mesh_whole_us, mesh_layers_us;  // medians
  std::array<ClassTraffic, 4> traffic{};
  std::optional<double> ping_ms;
  std::size_t pending_edits = 0;  // local edits that the server has not answered
  std::size_t open_edits = 0;     // edits that are not on the screen yet
  std::uint64_t digests_checked = 0, digests_differed = 0;
  std::vector<EditWay> edits;                     // the last ones, the newest one last
  std::array<const char*, kStageCount> stages{};  // names, static texts
};

/// Makes the window with ImGui. Clears `is_open` if the user closed it. Changes `modes` if the user
/// did.
void build_statistics(const StatisticsState& state, const KeyMap& keys, double scale,
                      InspectionModes& modes, bool& is_open);

}  // namespace runstone
