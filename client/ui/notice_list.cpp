#include "client/ui/notice_list.hpp"

#include <algorithm>
#include <utility>

#include "client/ui/ui_draw.hpp"

namespace runstone {

void NoticeList::add(std::string text, NoticeKind kind) {
  if (!notices_.empty() && notices_.back().text == text) {
    ++notices_.back().count;
    notices_.back().age = 0;
    return;
  }
  notices_.push_back({std::move(text), kind, 1, 0});
  if (notices_.size() > kNoticesMax) notices_.pop_front();
}

void NoticeList::advance(double seconds) {
  for (Notice& notice : notices_) notice.age += seconds;
  std::erase_if(notices_, [](const Notice& n) { return n.age >= kShownSeconds + kFadeSeconds; });
}

void NoticeList::build(double bottom, double scale) const {
  // The foreground is drawn after all windows.
  ImDrawList& list = *ImGui::GetForegroundDrawList();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto padding = static_cast<float>(4 * scale);
  const float wrap = std::max(1.0F, size.x - 4 * padding);
  float y = std::min(static_cast<float>(bottom), size.y - 2 * padding);
  for (auto n = notices_.rbegin(); n != notices_.rend(); ++n) {
    std::string text = n->kind == NoticeKind::warning ? "! " + n->text : n->text;
    if (n->count != 1) text += " (" + std::to_string(n->count) + " times)";
    const ImVec2 extent = wrapped_size(text, wrap);
    y -= extent.y + padding;
    // The newest notice is always shown. Older ones are left out where the window has no room.
    if (y < 2 * padding && n != notices_.rbegin()) return;
    y = std::max(y, 2 * padding);
    const double alpha = std::clamp((kShownSeconds + kFadeSeconds - n->age) / kFadeSeconds, 0., 1.);
    const float x = (size.x - extent.x) / 2;
    list.AddRectFilled({x - padding, y - 1}, {x + extent.x + padding, y + extent.y + 1},
                       IM_COL32(10, 12, 16, static_cast<int>(215 * alpha)), padding);
    const ImU32 colour = n->kind == NoticeKind::warning ? IM_COL32(255, 190, 110, 255)
                                                        : IM_COL32(235, 240, 245, 255);
    shadowed_text(list, {x, y}, colour, text, alpha, wrap);
  }
}

}  // namespace runstone
