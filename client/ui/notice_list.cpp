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
  ImDrawList& list = *ImGui::GetBackgroundDrawList();
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const auto padding = static_cast<float>(4 * scale);
  float y = static_cast<float>(bottom) - line;
  for (auto n = notices_.rbegin(); n != notices_.rend(); ++n, y -= line) {
    const std::string text =
        n->count == 1 ? n->text : n->text + " (" + std::to_string(n->count) + " times)";
    const double alpha = std::clamp((kShownSeconds + kFadeSeconds - n->age) / kFadeSeconds, 0., 1.);
    const float width = width_of(text);
    const float x = (ImGui::GetIO().DisplaySize.x - width) / 2;
    list.AddRectFilled({x - padding, y - 1}, {x + width + padding, y + line - 3},
                       IM_COL32(10, 12, 16, static_cast<int>(150 * alpha)), padding);
    const ImU32 colour = n->kind == NoticeKind::warning ? IM_COL32(255, 190, 110, 255)
                                                        : IM_COL32(235, 240, 245, 255);
    shadowed_text(list, {x, y}, colour, text, alpha);
  }
}

}  // namespace runstone
