#include "client/ui/ui_context.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <catch2/catch.hpp>
#include <fstream>
#include <iterator>
#include <string>

#include "client/input/input_event.hpp"

using namespace runstone;

namespace {

constexpr std::array<int, 2> kSize = {640, 480};

KeyEvent key(Key which, bool is_pressed) {
  KeyEvent event;
  event.place = event.key = which;
  event.is_pressed = is_pressed;
  return event;
}

}  // namespace

TEST_CASE("an overlay frame has sound indices and an atlas with glyphs", "[client_ui]") {
  UiContext context;
  const auto build = [] {
    ImGui::Begin("window");
    ImGui::TextUnformatted("Ünïcode Ж α →");
    ImGui::End();
  };
  context.make_frame(kSize, 0.016, build);  // a window is shown when its size is known
  const auto frame = context.make_frame(kSize, 0.016, build);
  REQUIRE(frame != nullptr);
  CHECK(frame->width == 640);
  REQUIRE_FALSE(frame->commands.empty());
  for (const OverlayCommand& command : frame->commands) {
    REQUIRE(command.index_count % 3 == 0);
    REQUIRE(command.first_index + command.index_count <= frame->indices.size());
    for (std::uint32_t i = 0; i < command.index_count; ++i)
      REQUIRE(command.first_vertex + frame->indices[command.first_index + i] <
              frame->vertices.size());
  }
  REQUIRE(frame->atlas != nullptr);
  const auto pixels = static_cast<std::size_t>(frame->atlas->width * frame->atlas->height);
  CHECK(frame->atlas->coverage.size() == pixels);
  const auto again = context.make_frame(kSize, 0.016, [] {});
  CHECK(again->atlas == frame->atlas);
  CHECK(again->vertices.empty());
}

TEST_CASE("a press and a release that come together still click", "[client_ui]") {
  UiContext context;
  int clicks = 0;
  const auto build = [&clicks] {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({200, 100});
    ImGui::Begin("w", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::SetCursorPos({0, 0});
    clicks += ImGui::Button("b", {200, 100}) ? 1 : 0;
    ImGui::End();
  };
  context.make_frame(kSize, 0.016, build);
  context.feed({CursorEvent{50, 50, 0, 0}, ButtonEvent{MouseButton::left, true},
                ButtonEvent{MouseButton::left, false}});
  context.make_frame(kSize, 0.016, build);
  CHECK(clicks == 1);
  CHECK(context.over_window());
  context.feed({CursorEvent{500, 400, 0, 0}});
  context.make_frame(kSize, 0.016, build);
  CHECK_FALSE(context.over_window());
}

TEST_CASE("a window takes the mouse where it is, also before the cursor is there", "[client_ui]") {
  UiContext context;
  bool is_open = true;
  const auto build = [&is_open] {
    if (!is_open) return;
    ImGui::SetNextWindowPos({100, 50});
    ImGui::SetNextWindowSize({200, 100});
    ImGui::Begin("w", nullptr, ImGuiWindowFlags_NoDecoration);
    ImGui::End();
    ImGui::SetNextWindowPos({400, 50});
    ImGui::Begin("shows only", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs);
    ImGui::TextUnformatted("text");
    ImGui::End();
  };
  for (int i = 0; i < 2; ++i) context.make_frame(kSize, 0.016, build);
  CHECK(context.has_window_at(101, 51));
  CHECK(context.has_window_at(299, 149));
  CHECK_FALSE(context.has_window_at(99, 51));
  CHECK_FALSE(context.has_window_at(301, 149));
  CHECK_FALSE(context.has_window_at(405, 55));
  is_open = false;
  context.make_frame(kSize, 0.016, build);
  CHECK_FALSE(context.has_window_at(101, 51));
}

TEST_CASE("a font that is given is used", "[client_ui]") {
  std::ifstream in("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf", std::ios::binary);
  const Bytes font{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (font.empty()) {
    WARN("skipped: not installed");
    return;
  }
  UiContext given(1, ByteView(font)), none(1, ByteView());
  const auto atlas_of = [](UiContext& context) {
    return context.make_frame(kSize, 0.016, [] {})->atlas;
  };
  UiContext read;
  CHECK(atlas_of(given)->coverage == atlas_of(read)->coverage);
  CHECK(atlas_of(none)->coverage != atlas_of(read)->coverage);
}

TEST_CASE("a batch of keys and characters types in its order", "[client_ui]") {
  UiContext context;
  std::string text;
  bool has_focus = false, entered = false;
  const auto build = [&] {
    ImGui::Begin("w");
    if (!has_focus) ImGui::SetKeyboardFocusHere();
    has_focus = true;
    entered = ImGui::InputText("t", &text, ImGuiInputTextFlags_EnterReturnsTrue) || entered;
    ImGui::End();
  };
  for (int i = 0; i < 3; ++i) context.make_frame(kSize, 0.016, build);
  CHECK(context.types());
  context.feed({key(Key::a, true), CharacterEvent{U'a'}, key(Key::a, false), key(Key::b, true),
                CharacterEvent{U'b'}, key(Key::b, false), CharacterEvent{U'é'},
                key(Key::backspace, true), key(Key::backspace, false), key(Key::backspace, true),
                key(Key::backspace, false), key(Key::enter, true), key(Key::enter, false)});
  context.make_frame(kSize, 0.016, build);
  CHECK(text == "a");
  CHECK(entered);
}
