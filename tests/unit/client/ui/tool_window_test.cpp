#include "client/ui/tool_window.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <catch2/catch.hpp>
#include <optional>

#include "client/ui/hud.hpp"

using namespace runstone;

namespace {

constexpr std::array<int, 2> kToolsSize = {1280, 1020};

/// A display with its tool window open, and a tool box that obeys it.
struct ToolWindowBench {
  ToolWindowBench() {
    state.materials = &default_material_table();
    state.slots = {1, 2, 3, 4, 5, 6, 7, 8, 9};
    state.is_connected = true;
    state.tools = &box;
    state.sight = VoxelPos{4, 5, 6};
    state.aimed_at = 1;
    hud.act(Action::tools);
    frames();
  }
  void frames() {
    for (int i = 0; i < 4; ++i) frame();
  }
  void frame() {
    static_cast<void>(hud.make_frame(state, size, 0.016));
    for (UiAction& action : hud.take_actions()) {
      if (const auto* file = std::get_if<ClipboardOfFile>(&action)) {
        files.push_back(*file);
        continue;
      }
      if (std::holds_alternative<FileStop>(action)) {
        ++stops;
        continue;
      }
      if (const auto* time = std::get_if<SetTime>(&action)) {
        times.push_back(time->share);
        continue;
      }
      REQUIRE(std::holds_alternative<ToolCommand>(action));
      commands.push_back(std::get<ToolCommand>(std::move(action)));
      // Edits and copies need a world, which is not here.
      static_cast<void>(carry_out(box, replica, 1, commands.back()));
    }
  }
  void click(double x, double y) {
    for (const bool is_pressed : {true, false}) {
      hud.feed({CursorEvent{x, y, 0, 0}, ButtonEvent{MouseButton::left, is_pressed}});
      frames();
    }
  }
  void type(std::string_view text) {
    std::vector<InputEvent> events;
    for (const char c : text) events.emplace_back(CharacterEvent{static_cast<char32_t>(c)});
    hud.feed(events);
    frames();
  }
  /// Returns the abscissa of a place in the window, `offset` pixels right of its left border.
  static double x(double offset) { return ImGui::FindWindowByName("Tools")->Pos.x + offset; }
  /// Clicks from above to below until a command of this type comes. Returns the command and keeps
  /// its place.
  template <class T>
  std::optional<T> find(double x, double from_y, double to_y = 920) {
    for (found_y = from_y; found_y < to_y; found_y += 5) {
      commands.clear();
      click(x, found_y);
      for (const ToolCommand& command : commands) {
        if (const auto* wanted = std::get_if<T>(&command)) return *wanted;
      }
    }
    return std::nullopt;
  }

  Hud hud{KeyMap{}};
  ToolBox box;
  Replica replica;
  HudState state;
  std::vector<ToolCommand> commands;
  std::vector<ClipboardOfFile> files;
  std::vector<std::optional<double>> times;  // that were chosen
  int stops = 0;
  std::array<int, 2> size = kToolsSize;
  double found_y = 0;
};

// Distances from the left border of the window. In the first every row has something to click.
constexpr double kRow = 30, kSliderLow = 11, kSliderMiddle = 110, kSecondChoice = 120, kApply = 175,
                 kByVoxels = 16, kHollow = 75, kByMetres = 130, kSizeField = 220;

}  // namespace

TEST_CASE_METHOD(ToolWindowBench, "the tool window lists all tools, and a click chooses one",
                 "[client_ui]") {
  std::vector<std::string> names;
  for (double y = 30; names.size() < box.tools().size();) {
    const auto chosen = find<ToolChoice>(x(kRow), y);
    REQUIRE(chosen);
    if (names.empty() || names.back() != chosen->name) names.push_back(chosen->name);
    y = found_y + 5;
  }
  for (std::size_t i = 0; i < names.size(); ++i) CHECK(names[i] == box.tools()[i]->name());
  CHECK(box.tool().name() == "array");
}

TEST_CASE_METHOD(ToolWindowBench, "a slider sets the number of a tool, within its range",
                 "[client_ui]") {
  REQUIRE(box.choose("sphere").has_value());
  frames();
  const auto changed = find<ParameterChange>(x(kSliderMiddle), 454);
  REQUIRE(changed);
  CHECK(changed->name == "radius");
  CHECK(changed->value > 20);
  CHECK(changed->value < 64);
  click(x(kSliderLow), found_y);
  CHECK(box.tool().parameters()[0].value == box.tool().parameters()[0].low);
  const auto mask = find<ParameterChange>(x(kSecondChoice), found_y + 22);
  REQUIRE(mask);
  CHECK(mask->name == "mask");
}

TEST_CASE_METHOD(ToolWindowBench, "places are typed as numbers while their part is open",
                 "[client_ui]") {
  REQUIRE(box.choose("box").has_value());
  frames();
  REQUIRE(find<PlacesChange>(x(kRow), 509));
  const double header_y = found_y;
  REQUIRE(box.typed_places());
  CHECK(box.typed_places()->places == std::vector<VoxelPos>{{4, 5, 6}, {4, 5, 6}});
  // A double click chooses the text of the first number.
  const double row_y = header_y + 24;
  hud.feed({CursorEvent{x(kRow), row_y, 0, 0}, ButtonEvent{MouseButton::left, true},
            ButtonEvent{MouseButton::left, false}, ButtonEvent{MouseButton::left, true},
            ButtonEvent{MouseButton::left, false}});
  frames();
  CHECK(hud.focus().types);
  type("-17");
  CHECK(box.typed_places()->places[0] == VoxelPos{-17, 5, 6});
  REQUIRE(find<TypedApply>(x(kApply), row_y + 40));
  click(x(kRow), header_y);  // closes the part
  CHECK_FALSE(box.typed_places());
}

TEST_CASE_METHOD(ToolWindowBench, "the tool window keeps the mouse until a click beside it",
                 "[client_ui]") {
  CHECK(hud.focus().panels == 1);
  CHECK_FALSE(hud.focus().has_window);
  InputRouter router;
  router.capture();
  router.set_windows(false, 1);
  CHECK_FALSE(router.is_captured());
  router.push({ButtonEvent{MouseButton::left, true}, ButtonEvent{MouseButton::left, false}});
  hud.feed(router.route(hud.focus()).for_ui);
  CHECK(router.is_captured());
  state.is_captured = true;
  frames();
  CHECK(hud.focus().panels == 0);
  router.set_windows(false, hud.focus().panels);
  CHECK(router.is_captured());
  // The key gives the mouse to the window again, and then closes the window.
  hud.act(Action::tools);
  CHECK(hud.focus().panels == 1);
  state.is_captured = false;
  frames();
  hud.act(Action::tools);
  CHECK(hud.focus().panels == 0);
}

TEST_CASE_METHOD(ToolWindowBench, "places are not typed any more once the player builds by clicks",
                 "[client_ui]") {
  REQUIRE(box.choose("box").has_value());
  frames();
  REQUIRE(find<PlacesChange>(x(kRow), 509));
  REQUIRE(box.typed_places());
  SECTION("the window is closed") { hud.act(Action::release); }
  SECTION("the mouse is captured") { state.is_captured = true; }
  frames();
  CHECK_FALSE(box.typed_places());
}

TEST_CASE_METHOD(ToolWindowBench, "symmetry and selection are changed by their fields",
                 "[client_ui]") {
  box.select(VoxelBox{{1, 2, 3}, {4, 5, 6}});
  frames();
  // The last header is that of the selection. Its buttons follow.
  std::optional<SelectionCommand> copied;
  for (double y = 680; y > 250 && !copied; y -= 5) {
    click(x(kRow), y);
    copied = find<SelectionCommand>(x(kRow), y + 60, y + 90);
  }
  REQUIRE(copied);
  CHECK(copied->kind == SelectionCommand::Kind::copy);
  CHECK(copied->is_solid);
}

TEST_CASE_METHOD(ToolWindowBench,
                 "a slider sets the time of day, and a button gives the world's back",
                 "[client_ui]") {
  state.time_of_day = 0.25;
  state.has_own_time = true;
  for (double y = 500; y < 660 && times.empty(); y += 5) {
    found_y = y + 24;
    click(x(kRow), y);  // a header, perhaps
    click(x(kSliderMiddle), found_y);
    if (!times.empty()) break;
    click(x(kSliderMiddle), found_y);  // closes what was opened
    click(x(kRow), y);
  }
  REQUIRE_FALSE(times.empty());
  REQUIRE(times.back().has_value());
  CHECK(*times.back() > 0.2);
  CHECK(*times.back() < 0.8);
  times.clear();
  for (double y = found_y + 22; y < found_y + 60 && times.empty(); y += 5) click(x(kRow), y);
  REQUIRE_FALSE(times.empty());
  CHECK_FALSE(times.back().has_value());
}

TEST_CASE_METHOD(ToolWindowBench, "a path is typed from which the clipboard is loaded",
                 "[client_ui]") {
  const auto below = [] {
    const ImGuiWindow* const window = ImGui::FindWindowByName("Tools");
    return static_cast<double>(window->Pos.y + window->Size.y);
  };
  state.has_files = true;
  frames();
  // The last header is that of the selection; it is closed. The field and its buttons are last in it.
  click(x(kRow), below() - 15);
  frames();
  const double buttons_y = below() - 18, field_y = buttons_y - 23;
  click(x(kRow), buttons_y);
  CHECK(files.empty());  // no path
  click(x(kRow), field_y);
  type("~/castle.schem");
  click(x(kRow), buttons_y);
  REQUIRE(files.size() == 1);
  CHECK(files[0].file == "~/castle.schem");
  CHECK_FALSE(files[0].is_saved);
  const double full = below();
  state.file.text = "reading castle.schem";
  frames();
  CHECK(below() < full);  // the text takes the place of the field
  click(x(kRow), below() - 18);
  CHECK(stops == 0);
  state.file.share = 0.5;
  state.file.can_stop = true;
  frames();
  click(x(kRow), below() - 18);
  CHECK(stops == 1);
}

TEST_CASE_METHOD(ToolWindowBench, "of a model the window asks how it becomes voxels",
                 "[client_ui]") {
  const auto below = [] {
    const ImGuiWindow* const window = ImGui::FindWindowByName("Tools");
    return static_cast<double>(window->Pos.y + window->Size.y);
  };
  size = {1280, 1200};  // all of the window fits
  state.has_files = true;
  frames();
  click(x(kRow), below() - 15);
  frames();
  const double plain = ImGui::FindWindowByName("Tools")->Size.y;
  click(x(kRow), below() - 18 - 23);
  type("statue.stl");
  frames();
  CHECK(ImGui::FindWindowByName("Tools")->Size.y > plain);
  click(x(kRow), below() - 18);
  REQUIRE(files.size() == 1);
  CHECK(files[0].file == "statue.stl");
  CHECK(files[0].model == ModelChoices());
  // From below: the button, the row of the surface, that of the inside, and that of the size.
  const double inside_y = below() - 18 - 46, size_y = below() - 18 - 69;
  click(x(kHollow), inside_y);
  click(x(kByMetres), size_y);
  click(x(kRow), below() - 18);
  REQUIRE(files.size() == 2);
  CHECK_FALSE(files[1].model.is_solid);
  CHECK(files[1].model.voxels_per_metre == 1.0);
  // A dropped file gets the same choices.
  const ClipboardOfFile dropped = hud.panels().tools().file().drop("/tmp/other.glb");
  CHECK(dropped.file == "/tmp/other.glb");
  CHECK(dropped.model == files[1].model);
  frames();
  click(x(kRow), below() - 18);
  CHECK(files.back().file == "/tmp/other.glb");
  // A size out of its range has words, and the button is dead.
  click(x(kByVoxels), size_y);
  click(x(kSizeField), size_y);
  type("5000");
  const auto count = files.size();
  click(x(kRow), below() - 18);
  CHECK(files.size() == count);
  // A model that is dropped then has the usual choices.
  CHECK(hud.panels().tools().file().drop("/tmp/third.glb").model == ModelChoices());
}
