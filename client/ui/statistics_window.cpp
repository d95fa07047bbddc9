#include "client/ui/statistics_window.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "client/ui/inspection_panel.hpp"
#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

constexpr ImU32 kStageColours[kStageCount] = {
    IM_COL32(90, 140, 220, 255), IM_COL32(80, 190, 210, 255), IM_COL32(100, 200, 120, 255),
    IM_COL32(210, 200, 80, 255), IM_COL32(230, 150, 70, 255), IM_COL32(220, 100, 120, 255),
    IM_COL32(180, 120, 220, 255)};

std::string bytes_text(double bytes) {
  if (bytes < 10'000) return fmt::format("{:.0f} B", bytes);
  if (bytes < 10'000'000) return fmt::format("{:.0f} KB", bytes / 1e3);
  return fmt::format("{:.1f} MB", bytes / 1e6);
}

void text_line(const std::string& text) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
}

void frame_plot(const StatisticsState& state, double scale) {
  if (state.frame_ms.empty()) return;
  std::vector<float> sorted = state.frame_ms;
  std::sort(sorted.begin(), sorted.end());
  const auto share = [&](double part) {
    return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
  };
  text_line(fmt::format("{:.0f} frames/s, {}   draw ms: p50 {:.1f}  p99 {:.1f}  max {:.1f}",
                        state.frames_per_second, state.renderer, share(0.5), share(0.99),
                        sorted.back()));
  ImGui::PlotHistogram("##frames", state.frame_ms.data(), static_cast<int>(state.frame_ms.size()),
                       0, nullptr, 0, std::max(sorted.back(), 16.7F),
                       {static_cast<float>(420 * scale), static_cast<float>(56 * scale)});
}

void counts(const StatisticsState& state) {
  text_line(fmt::format("drawn: {} chunks of {}, {} quads", state.chunks_drawn,
                        state.chunks_drawn + state.chunks_culled, state.quads_drawn));
  text_line(fmt::format("memory: chunks {}, edits {}, meshes {}, GPU {}, textures {} of {}",
                        bytes_text(static_cast<double>(state.chunk_bytes)),
                        bytes_text(static_cast<double>(state.edit_bytes)),
                        bytes_text(static_cast<double>(state.mesh_bytes)),
                        bytes_text(static_cast<double>(state.gpu_bytes)),
                        bytes_text(static_cast<double>(state.texture_bytes)),
                        bytes_text(static_cast<double>(state.bytes_max))));
  text_line(fmt::format("far ground: {} tiles of {} levels, {} parts drawn, {} of {}; reach {:.0f}",
                        state.tiles, state.tile_levels, state.tile_parts_drawn,
                        bytes_text(static_cast<double>(state.far_bytes)),
                        bytes_text(static_cast<double>(state.far_bytes_max)), state.reach));
  const auto median = [](const std::optional<double>& us) {
    return us ? fmt::format("{:.0f} us", *us) : std::string("none");
  };
  text_line(fmt::format("meshes: {}, whole chunk {}, changed layers {} (medians)", state.mesh_jobs,
                        median(state.mesh_whole_us), median(state.mesh_layers_us)));
  text_line(fmt::format("digests: {} checked, {} differed", state.digests_checked,
                        state.digests_differed));
}

void traffic_lines(const StatisticsState& state) {
  if (ImGui::BeginTable("traffic", static_cast<int>(state.traffic.size()))) {
    for (const ClassTraffic& part : state.traffic) {
      ImGui::TableNextColumn();
      text_line(fmt::format("{} {}\n{}/s", part.name, bytes_text(static_cast<double>(part.bytes)),
                            bytes_text(part.bytes_per_second)));
    }
    ImGui::EndTable();
  }
  text_line(state.ping_ms ? fmt::format("ping {:.1f} ms", *state.ping_ms) : "no ping yet");
  ImGui::SameLine();
  text_line(fmt::format("   edits without an answer: {}   edits not on the screen: {}",
                        state.pending_edits, state.open_edits));
}

/// Draws a bar for each edit: its stages on top of each other.
void edit_plot(const StatisticsState& state, double scale) {
  double most_ms = 1;
  for (const EditWay& edit : state.edits) {
    for (const double end : edit.end_ms) most_ms = std::max(most_ms, end);
  }
  text_line(fmt::format("edits from submit to screen, newest right, {:.1f} ms high", most_ms));
  for (std::size_t s = 0; s < kStageCount; ++s) {
    if (s != 0) ImGui::SameLine();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(kStageColours[s]), "%s", state.stages[s]);
  }
  const ImVec2 size{static_cast<float>(420 * scale), static_cast<float>(80 * scale)};
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImGui::Dummy(size);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, {from.x + size.x, from.y + size.y}, IM_COL32(30, 34, 40, 255));
  const float wide = size.x / 64;
  float x = from.x + size.x - wide * static_cast<float>(state.edits.size());
  for (const EditWay& edit : state.edits) {
    double before = 0;
    for (std::size_t s = 0; s < kStageCount; ++s) {
      if (edit.end_ms[s] < before) continue;
      const auto y = [&](double ms) {
        return from.y + size.y * static_cast<float>(1 - ms / most_ms);
      };
      list.AddRectFilled({x, y(edit.end_ms[s])}, {x + wide - 1, y(before)}, kStageColours[s]);
      before = edit.end_ms[s];
    }
    if (edit.is_local)
      list.AddRectFilled({x, from.y + size.y - 2}, {x + wide - 1, from.y + size.y}, IM_COL32_WHITE);
    x += wide;
  }
  ImGui::TextDisabled("a white foot marks an edit of this client");
}

}  // namespace

void build_statistics(const StatisticsState& state, const KeyMap& keys, double scale,
                      InspectionModes& modes, bool& is_open) {
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  // It lies below the place of the timeline.
  const float width = std::min(static_cast<float>(520 * scale), size.x);
  ImGui::SetNextWindowPos({size.x - width, static_cast<float>(104 * scale)}, ImGuiCond_Appearing);
  ImGui::SetNextWindowSize({width, 0}, ImGuiCond_Appearing);
  ImGui::SetNextWindowBgAlpha(0.8F);
  ImGui::Begin("Measurements", &is_open,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  build_inspection_boxes(keys, modes);
  ImGui::Separator();
  frame_plot(state, scale);
  counts(state);
  traffic_lines(state);
  edit_plot(state, scale);
  ImGui::End();
}

}  // namespace runstone
