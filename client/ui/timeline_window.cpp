#include "client/ui/timeline_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "client/ui/log_words.hpp"
#include "client/ui/timeline_band.hpp"
#include "client/ui/ui_draw.hpp"
#include "common/core/utc_text.hpp"

namespace runstone {
namespace {

/// How fast the log is played: the time that all of it takes.
struct PlaySpeed {
  const char* label;
  double log_seconds;
};
constexpr std::array<PlaySpeed, 5> kSpeeds = {
    {{"in 10 s", 10}, {"in 30 s", 30}, {"in 1 min", 60}, {"in 3 min", 180}, {"in 10 min", 600}}};

}  // namespace

std::optional<ShowMoment> TimelineWindow::build(const TimelineState& state, double scale) {
  if (!is_open_) {
    play_.stop();
    return std::nullopt;
  }
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(static_cast<float>(760 * scale), size.x * 0.92F);
  ImGui::SetNextWindowPos({size.x / 2, static_cast<float>(36 * scale)}, ImGuiCond_Appearing,
                          {0.5F, 0});
  ImGui::SetNextWindowSize({width, 0});
  ImGui::Begin("Timeline", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  std::optional<ShowMoment> out;
  const auto newest = static_cast<double>(state.newest);
  double at = play_.is_playing()
                  ? play_.at()
                  : dragged_.value_or(state.is_past ? static_cast<double>(state.shown) : newest);
  const auto move_to = [&](double seq) {
    const auto whole = static_cast<Sequence>(std::llround(std::clamp(seq, 0.0, newest)));
    out = ShowMoment{whole, whole == state.newest};
  };
  constexpr double kFirst = 0;
  const std::string label = at >= newest ? "live" : fmt::format("after edit {:.0f}", at);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::SliderScalar("##moment", ImGuiDataType_Double, &at, &kFirst, &newest, label.c_str())) {
    dragged_ = at;
    play_.stop();
  }
  // A moment is requested when the one before is here, and the last one when the slider is let go.
  if (dragged_ && !state.is_loading) {
    const auto wanted = static_cast<Sequence>(std::llround(*dragged_));
    const Sequence shown = state.is_past ? state.shown : state.newest;
    if (wanted != shown && wanted != requested_) {
      move_to(*dragged_);
      requested_ = wanted;
    }
    if (!ImGui::IsItemActive()) {
      dragged_.reset();
      requested_.reset();
    }
  }
  const double step = std::max(1.0, std::round(newest / 100));
  const double from = state.is_past ? static_cast<double>(state.shown) : newest;
  if (ImGui::Button("-1 %")) move_to(from - step);
  ImGui::SameLine();
  if (ImGui::Button("-1")) move_to(from - 1);
  ImGui::SameLine();
  if (ImGui::Button("+1")) move_to(from + 1);
  ImGui::SameLine();
  if (ImGui::Button("+1 %")) move_to(from + step);
  ImGui::SameLine();
  if (ImGui::Button("live")) move_to(newest);
  ImGui::SameLine();
  const bool is_pressed = build_play();
  ImGui::TextDisabled("%s%s", state.moment.c_str(), state.is_loading ? "  loading ..." : "");
  if (const auto clicked = build_band(state, scale)) move_to(static_cast<double>(*clicked));
  build_legend(state);
  if (const auto chosen = build_recent(state)) move_to(static_cast<double>(*chosen));
  ImGui::End();
  if (out) play_.stop();
  const bool is_toggled = std::exchange(is_play_toggled_, false) || is_pressed;
  if (const auto played = play(state, is_toggled)) move_to(static_cast<double>(*played));
  return out;
}

bool TimelineWindow::build_play() {
  // The label has the same width in both states.
  const float width = ImGui::CalcTextSize("Pause").x + 2 * ImGui::GetStyle().FramePadding.x;
  const bool is_pressed =
      ImGui::Button(play_.is_playing() ? "Pause###play" : "Play###play", {width, 0});
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 6.5F);
  if (ImGui::BeginCombo("##speed", kSpeeds[speed_].label)) {
    for (std::size_t i = 0; i < kSpeeds.size(); ++i) {
      if (ImGui::Selectable(kSpeeds[i].label, i == speed_)) speed_ = i;
    }
    ImGui::EndCombo();
  }
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("the time that the whole log takes");
  ImGui::SameLine();
  return is_pressed;
}

std::optional<Sequence> TimelineWindow::play(const TimelineState& state, bool is_toggled) {
  constexpr double kSecondsMax = 0.5;  // of one frame
  if (is_toggled && play_.is_playing()) {
    play_.stop();
  } else if (is_toggled) {
    dragged_.reset();
    play_.start(state.is_past ? state.shown : 0);
  }
  return play_.step(state.newest, state.is_past ? state.shown : state.newest, state.is_loading,
                    std::min<double>(ImGui::GetIO().DeltaTime, kSecondsMax),
                    kSpeeds[speed_].log_seconds);
}

std::optional<Sequence> TimelineWindow::build_recent(const TimelineState& state) {
  if (state.recent.empty()) return std::nullopt;
  std::optional<Sequence> chosen;
  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_RowBg;
  if (!ImGui::BeginTable("recent", 4, kFlags)) return std::nullopt;
  for (auto mark = state.recent.rbegin(); mark != state.recent.rend(); ++mark) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string label = fmt::format("{}##{}", mark->seq, mark->seq);
    if (ImGui::Selectable(label.c_str(), mark->seq == state.shown,
                          ImGuiSelectableFlags_SpanAllColumns))
      chosen = mark->seq;
    ImGui::TableNextColumn();
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(author_colour(mark->author)), "%s",
                       state.name_of(mark->author).c_str());
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(record_words(mark->kind, mark->cause).c_str());
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", utc_text(mark->utc_us).c_str());
  }
  ImGui::EndTable();
  return chosen;
}

}  // namespace runstone
