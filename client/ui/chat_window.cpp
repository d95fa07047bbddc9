#include "client/ui/chat_window.hpp"

#include <imgui_internal.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <utility>

#include "client/ui/scroll_keys.hpp"
#include "client/ui/ui_draw.hpp"

namespace runstone {
namespace {

ImU32 chat_colour(ChatTone tone) {
  switch (tone) {
    case ChatTone::player:
      return IM_COL32(240, 244, 248, 255);
    case ChatTone::server:
      return IM_COL32(255, 220, 130, 255);
    case ChatTone::refused:
      return IM_COL32(255, 160, 110, 255);
    case ChatTone::answer:
      return IM_COL32(160, 210, 255, 255);
  }
  return IM_COL32_WHITE;
}

float chat_width(double scale) {
  return std::min(static_cast<float>(560 * scale), ImGui::GetIO().DisplaySize.x * 0.7F);
}

void place_chat(double bottom, double scale) {
  const auto left = static_cast<float>(10 * scale);
  ImGui::SetNextWindowPos({left, static_cast<float>(bottom)}, ImGuiCond_Always, {0, 1});
}

void wrapped_text(const ShownLine& entry, double alpha) {
  ImVec4 colour = ImGui::ColorConvertU32ToFloat4(chat_colour(entry.tone));
  colour.w = static_cast<float>(alpha);
  ImGui::PushStyleColor(ImGuiCol_Text, colour);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(entry.text.data(), entry.text.data() + entry.text.size());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

}  // namespace

struct ChatFieldCallback {
  static int run(ImGuiInputTextCallbackData* data) {
    auto& chat = *static_cast<ChatWindow*>(data->UserData);
    if (data->EventFlag == ImGuiInputTextFlags_CallbackCompletion) {
      const ChatCompletion::Line line = chat.completion_.complete(
          {std::string(data->Buf, static_cast<std::size_t>(data->BufTextLen)),
           static_cast<std::size_t>(data->CursorPos)});
      data->DeleteChars(0, data->BufTextLen);
      data->InsertChars(0, line.text.data(), line.text.data() + line.text.size());
      data->CursorPos = static_cast<int>(line.cursor);
      return 0;
    }
    if (data->EventFlag != ImGuiInputTextFlags_CallbackHistory) return 0;
    if (chat.typed_at_ == chat.typed_.size()) chat.draft_ = data->Buf;
    const std::string& line = chat.typed_line(data->EventKey == ImGuiKey_UpArrow ? -1 : 1);
    data->DeleteChars(0, data->BufTextLen);
    data->InsertChars(0, line.data(), line.data() + line.size());
    return 0;
  }
};

void ChatWindow::hear(ShownLine entry) {
  lines_.push_back({std::move(entry), 0});
  if (lines_.size() > kEntriesMax) lines_.pop_front();
  has_new_line_ = true;
}

std::size_t ChatWindow::withdraw(const std::vector<ChatLineId>& lines) {
  return std::erase_if(lines_, [&](const Line& line) {
    const ChatLineId& id = line.entry.id;
    return !id.name.empty() && std::ranges::find(lines, id) != lines.end();
  });
}

void ChatWindow::open(std::string text) {
  if (std::exchange(is_open_, true)) return;
  field_ = std::move(text);
  draft_.clear();
  typed_at_ = typed_.size();
  takes_focus_ = has_new_line_ = true;
}

void ChatWindow::close() { is_open_ = false; }

void ChatWindow::advance(double seconds) {
  for (Line& line : lines_) line.age += seconds;
}

bool ChatWindow::shows_newest() const {
  return !is_open_ && !lines_.empty() && lines_.back().age < kShownSeconds + kFadeSeconds;
}

bool ChatWindow::is_fading() const {
  return shows_newest() && std::any_of(lines_.begin(), lines_.end(), [](const Line& line) {
           return line.age > kShownSeconds && line.age < kShownSeconds + kFadeSeconds;
         });
}

std::optional<std::string> ChatWindow::build(double bottom, double scale) {
  if (is_open_) return build_open(bottom, scale);
  build_newest(bottom, scale);
  return std::nullopt;
}

void ChatWindow::build_newest(double bottom, double scale) const {
  if (!shows_newest()) return;
  place_chat(bottom, scale);
  const float width = chat_width(scale);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, ImGui::GetIO().DisplaySize.y * 0.5F});
  ImGui::SetNextWindowBgAlpha(0.35F);
  ImGui::Begin("chat lines", nullptr, kShowOnly);
  const std::size_t first = lines_.size() - std::min(lines_.size(), kNewestShown);
  const auto hidden =
      std::count_if(lines_.begin(), lines_.begin() + static_cast<std::ptrdiff_t>(first),
                    [](const Line& line) { return line.age < kShownSeconds; });
  if (hidden != 0)
    wrapped_text({std::to_string(hidden) + " more above: open the chat, then page up or the wheel"},
                 0.7);
  for (std::size_t i = first; i < lines_.size(); ++i) {
    const double left = kShownSeconds + kFadeSeconds - lines_[i].age;
    if (left > 0) wrapped_text(lines_[i].entry, std::clamp(left / kFadeSeconds, 0.0, 1.0));
  }
  ImGui::End();
}

std::optional<std::string> ChatWindow::build_open(double bottom, double scale) {
  std::optional<std::string> typed;
  place_chat(bottom, scale);
  ImGui::SetNextWindowSize({chat_width(scale), ImGui::GetIO().DisplaySize.y * 0.45F});
  ImGui::Begin(
      "chat", nullptr,
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav);
  const float field_height = ImGui::GetFrameHeightWithSpacing();
  ImGui::BeginChild("lines", {0, -field_height});
  for (const Line& line : lines_) wrapped_text(line.entry, 1);
  scroll_by_pages(pressed_step(ImGuiKey_PageDown, ImGuiKey_PageUp));
  if (std::exchange(has_new_line_, false)) ImGui::SetScrollHereY(1);
  ImGui::EndChild();
  ImGui::SetNextItemWidth(-1);
  if (takes_focus_) ImGui::SetKeyboardFocusHere();
  constexpr ImGuiInputTextFlags kFlags = ImGuiInputTextFlags_EnterReturnsTrue |
                                         ImGuiInputTextFlags_CallbackHistory |
                                         ImGuiInputTextFlags_CallbackCompletion;
  const bool is_entered =
      ImGui::InputTextWithHint("##line", "a line, or /command   (tab completes, page up scrolls)",
                               &field_, kFlags, &ChatFieldCallback::run, this);
  // The field takes the keyboard in the frame after the request, and selects its text. A slash that
  // opened the window must not be selected, because the next character would replace it.
  if (ImGui::IsItemActive() && std::exchange(takes_focus_, false)) {
    if (ImGuiInputTextState* const state = ImGui::GetInputTextState(ImGui::GetItemID()))
      state->ClearSelection(), state->CursorClamp(), state->Stb.cursor = state->CurLenW;
  }
  ImGui::End();
  if (!is_entered) return std::nullopt;
  close();
  if (field_.find_first_not_of(' ') == std::string::npos) return std::nullopt;
  if (typed_.empty() || typed_.back() != field_) typed_.push_back(field_);
  if (typed_.size() > kTypedMax) typed_.pop_front();
  return field_;
}

const std::string& ChatWindow::typed_line(int step) {
  if (step < 0 && typed_at_ > 0) --typed_at_;
  if (step > 0 && typed_at_ < typed_.size()) ++typed_at_;
  return typed_at_ == typed_.size() ? draft_ : typed_[typed_at_];
}

}  // namespace runstone
