#include "client/ui/caption.hpp"

#include "client/ui/ui_draw.hpp"

namespace runstone {

std::shared_ptr<const OverlayFrame> caption_frame(UiContext& context, const Caption& caption,
                                                  std::array<int, 2> size) {
  const auto gap = static_cast<float>(8 * context.scale());
  const auto build = [&] {
    ImGui::SetNextWindowPos({gap, gap});
    ImGui::SetNextWindowBgAlpha(0.72F);
    ImGui::Begin("##caption", nullptr, kShowOnly);
    ImGui::TextColored({1, 0.86F, 0.45F, 1}, "%s", caption.title.c_str());
    for (const std::string& line : caption.lines)
      ImGui::TextUnformatted(line.data(), line.data() + line.size());
    ImGui::End();
  };
  // ImGui measures a new text in one frame and shows the window in its size in the next one.
  context.make_hidden_frame(size, build);
  context.make_hidden_frame(size, build);
  return context.make_frame(size, 0, build);
}

}  // namespace runstone
