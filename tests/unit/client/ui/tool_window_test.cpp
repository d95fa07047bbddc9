#include "client/ui/tool_window.hpp"

#include <imgui.h>
#include <imgui_internal.h>

#include <catch2/catch.hpp>
#include <optional>

#include "client/ui/hud.hpp"

using namespace runstone;

namespace {

/// A display in which all of the tool window fits, whatever is open.
constexpr std::array<int, 2> kToolsSize = {1280, 2000};

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
  static ImGuiWindow& window() { return *ImGui::FindWindowByName("Tools"); }
  /// Returns the abscissa of a place in the window, `offset` pixels right of its left border.
  static double x(double offset) { return window().Pos.x + offset; }
  /// Returns the ordinate of the lower border of the window.
  static double below() { return window().Pos.y + window().Size.y; }
  /// Returns the ordinate of a place below the list of tools and above the fields of the tool.
  static double below_list() {
    return ImGui::TableFindByID(window().GetID("tools"))->OuterRect.Max.y +
           ImGui::GetStyle().ItemSpacing.y;
  }
  /// Returns the distance of two rows of fields.
  static double row() { return ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.y; }
  /// Returns the ordinate of the middle of the row with this number, from below; 0 is the last one.
  static double row_from_below(int number) {
    return below() - ImGui::GetStyle().WindowPadding.y - ImGui::GetFrameHeight() / 2 -
           number * row();
  }
  /// Clicks from above to the lower border of the window until a command of this type comes.
  /// Returns the command and keeps its place.
  template <class T>
  std::optional<T> find(double x, double from_y) {
    for (found_y = from_y; found_y < below(); found_y += kStep) {
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
  static constexpr double kStep = 5;  // less than the height of a row
};

// Distances from the left border of the window. In the first every row has something to click.
constexpr double kRow = 30, kSliderLow = 11, kSliderMiddle = 110, kSecondChoice = 120, kApply = 175,
                 kByVoxels = 16, kHollow = 75, kByMetres = 130, kSizeField = 220;

/// The headers of the parts from below, while all of them are closed.
constexpr int kSelectionRow = 0, kTimeRow = 1, kPlacesRow = 3;

}  // namespace

TEST_CASE_METHOD(ToolWindowBench, "the tool window lists all tools, and a click chooses one",
                 "[client_ui]") {
  std::vector<std::string> names;
  for (double y = window().Pos.y + ImGui::GetFrameHeight(); names.size() < box.tools().size();) {
    const auto chosen = find<ToolChoice>(x(kRow), y);
    REQUIRE(chosen);
    if (names.empty() || names.back() != chosen->name) names.push_back(chosen->name);
    y = found_y + kStep;
  }
  for (std::size_t i = 0; i < names.size(); ++i) CHECK(names[i] == box.tools()[i]->name());
  CHECK(box.tool().name() == "array");
}

TEST_CASE_METHOD(ToolWindowBench, "a slider sets the number of a tool, within its range",
                 "[client_ui]") {
  REQUIRE(box.choose("sphere").has_value());
  frames();
  const auto changed = find<ParameterChange>(x(kSliderMiddle), below_list());
  REQUIRE(changed);
  CHECK(changed->name == "radius");
  CHECK(changed->value > 20);
  CHECK(changed->value < 64);
  click(x(kSliderLow), found_y);
  CHECK(box.tool().parameters()[0].value == box.tool().parameters()[0].low);
  const auto mask = find<ParameterChange>(x(kSecondChoice), found_y + row());
  REQUIRE(mask);
  CHECK(mask->name == "mask");
}

TEST_CASE_METHOD(ToolWindowBench, "places are typed as numbers while their part is open",
                 "[client_ui]") {
  REQUIRE(box.choose("box").has_value());
  frames();
  REQUIRE(find<PlacesChange>(x(kRow), row_from_below(kPlacesRow)));
  const double header_y = found_y;
  REQUIRE(box.typed_places());
  CHECK(box.typed_places()->places == std::vector<VoxelPos>{{4, 5, 6}, {4, 5, 6}});
  // A double click chooses the text of the first number.
  const double row_y = header_y + row();
  hud.feed({CursorEvent{x(kRow), row_y, 0, 0}, ButtonEvent{MouseButton::left, true},
            ButtonEvent{MouseButton::left, false}, ButtonEvent{MouseButton::left, true},
            ButtonEvent{MouseButton::left, false}});
  frames();
  CHECK(hud.focus().types);
  type("-17");
  CHECK(box.typed_places()->places[0] == VoxelPos{-17, 5, 6});
  REQUIRE(find<TypedApply>(x(kApply), row_y + 1.5 * row()));
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
  REQUIRE(find<PlacesChange>(x(kRow), row_from_below(kPlacesRow)));
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
  // Below the header are two rows of fields, and then its buttons.
  const double header_y = row_from_below(kSelectionRow);
  click(x(kRow), header_y);
  const auto copied = find<SelectionCommand>(x(kRow), header_y + 2.5 * row());
  REQUIRE(copied);
  CHECK(copied->kind == SelectionCommand::Kind::copy);
  CHECK(copied->is_solid);
}

TEST_CASE_METHOD(ToolWindowBench,
                 "a slider sets the time of day, and a button gives the world's back",
                 "[client_ui]") {
  state.time_of_day = 0.25;
  state.has_own_time = true;
  const double header_y = row_from_below(kTimeRow);
  click(x(kRow), header_y);
  click(x(kSliderMiddle), header_y + row());
  REQUIRE_FALSE(times.empty());
  REQUIRE(times.back().has_value());
  CHECK(*times.back() > 0.2);
  CHECK(*times.back() < 0.8);
  times.clear();
  click(x(kRow), header_y + 2 * row());
  REQUIRE_FALSE(times.empty());
  CHECK_FALSE(times.back().has_value());
}

TEST_CASE_METHOD(ToolWindowBench, "a path is typed from which the clipboard is loaded",
                 "[client_ui]") {
  state.has_files = true;
  frames();
  // The field of the path and its buttons are the last rows of the part of the selection.
  click(x(kRow), row_from_below(kSelectionRow));
  frames();
  const double buttons_y = row_from_below(0), field_y = row_from_below(1);
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
  click(x(kRow), row_from_below(0));
  CHECK(stops == 0);
  state.file.share = 0.5;
  state.file.can_stop = true;
  frames();
  click(x(kRow), row_from_below(0));
  CHECK(stops == 1);
}

TEST_CASE_METHOD(ToolWindowBench, "of a model the window asks how it becomes voxels",
                 "[client_ui]") {
  state.has_files = true;
  frames();
  click(x(kRow), row_from_below(kSelectionRow));
  frames();
  const double plain = window().Size.y;
  click(x(kRow), row_from_below(1));
  type("statue.stl");
  frames();
  CHECK(window().Size.y > plain);
  click(x(kRow), row_from_below(0));
  REQUIRE(files.size() == 1);
  CHECK(files[0].file == "statue.stl");
  CHECK(files[0].model == ModelChoices());
  // From below: the button, the row of the surface, that of the inside, and that of the size.
  const double inside_y = row_from_below(2), size_y = row_from_below(3);
  click(x(kHollow), inside_y);
  click(x(kByMetres), size_y);
  click(x(kRow), row_from_below(0));
  REQUIRE(files.size() == 2);
  CHECK_FALSE(files[1].model.is_solid);
  CHECK(files[1].model.voxels_per_metre == 1.0);
  // A dropped file gets the same choices.
  const ClipboardOfFile dropped = hud.panels().tools().file().drop("/tmp/other.glb");
  CHECK(dropped.file == "/tmp/other.glb");
  CHECK(dropped.model == files[1].model);
  frames();
  click(x(kRow), row_from_below(0));
  CHECK(files.back().file == "/tmp/other.glb");
  // A size out of its range has words, and the button is dead.
  click(x(kByVoxels), size_y);
  click(x(kSizeField), size_y);
  type("5000");
  const auto count = files.size();
  click(x(kRow), row_from_below(0));
  CHECK(files.size() == count);
  // A model that is dropped then has the usual choices.
  CHECK(hud.panels().tools().file().drop("/tmp/third.glb").model == ModelChoices());
}
