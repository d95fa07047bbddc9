#include "client/ui/timeline_band.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "client/ui/log_words.hpp"
#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

constexpr std::size_t kLegendMax = 8;
constexpr int kDates = 5;  // below the band

std::string date_text(TimeUs utc_us) {
  return fmt::format("{:%Y-%m-%d %H:%M}",
                     fmt::gmtime(static_cast<std::time_t>(utc_us / 1'000'000)));
}

/// Draws lines over a rectangle in the colour of an author: none, lines that rise, lines that fall,
/// or lines along it. So authors with similar colours differ, too.
void hatch(ImDrawList& list, ImVec2 from, ImVec2 to, AuthorId author) {
  constexpr ImU32 kLine = IM_COL32(0, 0, 0, 150);
  constexpr float kStep = 6;
  const float height = to.y - from.y;
  const AuthorId form = author % 4;
  if (form == 0) return;
  list.PushClipRect(from, to, true);
  if (form == 3) {
    for (float y = from.y + kStep / 2; y < to.y; y += kStep)
      list.AddLine({from.x, y}, {to.x, y}, kLine);
  } else {
    const float rise = form == 1 ? height : -height;
    const float start = form == 1 ? to.y : from.y;
    for (float x = from.x - height; x < to.x; x += kStep)
      list.AddLine({x, start}, {x + height, start - rise}, kLine);
  }
  list.PopClipRect();
}

/// Returns the last mark at or before an edit. Requires marks.
const LogMark& mark_at(const std::vector<LogMark>& marks, Sequence seq) {
  const auto after = std::upper_bound(marks.begin(), marks.end(), seq,
                                      [](Sequence s, const LogMark& mark) { return s < mark.seq; });
  return after == marks.begin() ? marks.front() : *(after - 1);
}

}  // namespace

std::vector<BandSegment> band_segments(const std::vector<LogMark>& marks) {
  std::vector<BandSegment> out;
  for (const LogMark& mark : marks) {
    if (out.empty() || out.back().author != mark.author) {
      out.push_back({mark.seq, mark.seq, mark.author});
    } else {
      out.back().last = mark.seq;
    }
  }
  return out;
}

std::vector<AuthorId> band_authors(const std::vector<LogMark>& marks, std::size_t count_max) {
  std::map<AuthorId, std::size_t> counts;
  for (const LogMark& mark : marks) ++counts[mark.author];
  std::vector<AuthorId> out;
  out.reserve(counts.size());
  for (const auto& [author, count] : counts) out.push_back(author);
  std::sort(out.begin(), out.end(), [&](AuthorId a, AuthorId b) {
    return counts[a] != counts[b] ? counts[a] > counts[b] : a < b;
  });
  if (out.size() > count_max) out.resize(count_max);
  return out;
}

std::optional<Sequence> build_band(const TimelineState& state, double scale) {
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const float width = std::max(32.0F, ImGui::GetContentRegionAvail().x);
  const auto height = static_cast<float>(18 * scale);
  ImGui::InvisibleButton("band", {width, height});
  const bool is_hovered = ImGui::IsItemHovered(), is_clicked = ImGui::IsItemClicked();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(from, {from.x + width, from.y + height}, IM_COL32(30, 34, 40, 255));
  if (state.band.empty() || state.newest == 0) {
    list.AddText({from.x + 6, from.y + 1}, IM_COL32(150, 158, 166, 255),
                 state.refusal.empty() ? "asking who edited ..." : state.refusal.c_str());
    return std::nullopt;
  }
  const double pixels = width / static_cast<double>(state.newest);
  const auto x_of = [&](Sequence seq) {
    return from.x + static_cast<float>(static_cast<double>(std::min(seq, state.newest)) * pixels);
  };
  const std::vector<BandSegment> segments = band_segments(state.band);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Sequence end = i + 1 < segments.size() ? segments[i + 1].first - 1 : state.newest;
    const float left = x_of(segments[i].first - 1);
    const ImVec2 corner{left, from.y}, opposite{std::max(left + 1, x_of(end)), from.y + height};
    list.AddRectFilled(corner, opposite, author_colour(segments[i].author));
    hatch(list, corner, opposite, segments[i].author);
  }
  const float shown = x_of(state.shown);
  list.AddLine({shown, from.y - 3}, {shown, from.y + height + 3}, IM_COL32(255, 255, 255, 255), 2);
  const float dates_top = from.y + height + 2;
  float free_from = from.x;
  for (int i = 0; i < kDates; ++i) {
    const Sequence seq = state.newest * static_cast<Sequence>(i) / (kDates - 1);
    const std::string date = date_text(mark_at(state.band, seq).utc_us);
    const float at =
        std::clamp(x_of(seq) - width_of(date) / 2, from.x, from.x + width - width_of(date));
    if (at < free_from) continue;
    list.AddText({at, dates_top}, IM_COL32(165, 172, 180, 255), date.c_str());
    free_from = at + width_of(date) + 12;
  }
  ImGui::Dummy({width, ImGui::GetTextLineHeight()});
  if (!is_hovered) return std::nullopt;
  const double share = (ImGui::GetIO().MousePos.x - from.x) / width;
  const auto seq = static_cast<Sequence>(
      std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(state.newest)));
  const LogMark& mark = mark_at(state.band, seq);
  ImGui::SetTooltip("%s", fmt::format("edit {}: {}, {}, {}", mark.seq, state.name_of(mark.author),
                                      record_words(mark.kind, mark.cause), date_text(mark.utc_us))
                              .c_str());
  return is_clicked ? std::optional(seq) : std::nullopt;
}

void build_legend(const TimelineState& state) {
  bool is_first = true;
  for (const AuthorId author : band_authors(state.band, kLegendMax)) {
    const std::string name = state.name_of(author);
    const float size = ImGui::GetTextLineHeight() * 0.7F;
    // Names that do not fit begin another line.
    const float needed = size + 6 + width_of(name);
    if (!is_first) {
      ImGui::SameLine(0, 14);
      if (ImGui::GetContentRegionAvail().x < needed) ImGui::NewLine();
    }
    is_first = false;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float top = at.y + (ImGui::GetTextLineHeight() - size) / 2;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({at.x, top}, {at.x + size, top + size}, author_colour(author));
    hatch(list, {at.x, top}, {at.x + size, top + size}, author);
    ImGui::Dummy({size, size});
    ImGui::SameLine(0, 6);
    ImGui::TextUnformatted(name.c_str());
  }
}

}  // namespace runstone
