#include "client/ui/tool_window.hpp"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "client/tools/build_words.hpp"
#include "client/tools/preview_words.hpp"
#include "client/ui/palette_window.hpp"
#include "client/ui/ui_draw.hpp"
#include "common/core/text.hpp"
#include "common/materials/readable_name.hpp"

namespace runstone {
namespace {

constexpr std::array<const char*, kDirectionCount> kDirections = {"-x", "+x", "-y",
                                                                  "+y", "-z", "+z"};
constexpr std::array<const char*, 5> kSymmetries = {"none", "mirrored along x", "mirrored along z",
                                                    "mirrored along x and z", "a half turn"};
/// The range of the coordinates that can be typed.
constexpr int kCoordinateMin = -kWorldLimit, kCoordinateMax = kWorldLimit - 1;
const ImVec4 kToolWarning = {1, 0.82F, 0.47F, 1};

std::array<int, 3> numbers_of(VoxelPos at) { return {at.x, at.y, at.z}; }
VoxelPos voxel_of(const std::array<int, 3>& at) { return {at[0], at[1], at[2]}; }

/// Shows three fields for a place. Returns true if the user changed it.
bool place_fields(const char* label, std::array<int, 3>& at) {
  if (!ImGui::InputInt3(label, at.data())) return false;
  for (int& v : at) v = std::clamp(v, kCoordinateMin, kCoordinateMax);
  return true;
}

/// Shows a button on the same line that takes the voxel in sight. Returns it if the user wants it.
std::optional<VoxelPos> sight_button(const HudState& state) {
  ImGui::SameLine();
  ImGui::BeginDisabled(!state.sight);
  const bool is_pressed = ImGui::SmallButton("in sight");
  ImGui::EndDisabled();
  return is_pressed ? state.sight : std::nullopt;
}

template <std::size_t kCount>
bool choice(const char* label, int& value, const std::array<const char*, kCount>& names) {
  return ImGui::Combo(label, &value, names.data(), static_cast<int>(kCount));
}

void build_parameters(const Tool& tool, std::vector<ToolCommand>& out) {
  for (const ToolParameter& parameter : tool.parameters()) {
    int value = parameter.value;
    bool is_changed = false;
    if (parameter.choices.empty()) {
      const ImGuiSliderFlags flags =
          ImGuiSliderFlags_AlwaysClamp |
          (parameter.high > 1000 ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
      const std::string format = "%d " + parameter.unit;
      is_changed = ImGui::SliderInt(parameter.name.c_str(), &value, parameter.low, parameter.high,
                                    format.c_str(), flags);
      if (ImGui::IsItemHovered()) ImGui::SetTooltip("ctrl and click: type the number");
    } else {
      for (std::size_t i = 0; i < parameter.choices.size(); ++i) {
        if (i != 0) ImGui::SameLine();
        const std::string label = parameter.choices[i] + "##" + parameter.name;
        is_changed =
            ImGui::RadioButton(label.c_str(), &value, parameter.low + static_cast<int>(i)) ||
            is_changed;
      }
      ImGui::SameLine();
      ImGui::TextDisabled("%s", parameter.name.c_str());
    }
    if (is_changed) out.emplace_back(ParameterChange{parameter.name, value});
  }
}

/// Shows words one beside the other, like buttons that cannot be pressed, in lines that are as wide
/// as the window.
void build_chips(const std::vector<std::string>& chips) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float end = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  ImGui::BeginDisabled();
  for (std::size_t i = 0; i < chips.size(); ++i) {
    const float width = ImGui::CalcTextSize(chips[i].c_str()).x + 2 * style.FramePadding.x;
    if (i != 0 && ImGui::GetItemRectMax().x + style.ItemSpacing.x + width <= end) ImGui::SameLine();
    ImGui::PushID(static_cast<int>(i));
    ImGui::SmallButton(chips[i].c_str());
    ImGui::PopID();
  }
  ImGui::EndDisabled();
}

void build_texts(const Tool& tool, std::vector<ToolCommand>& out) {
  for (const ToolText& text : tool.texts()) {
    std::string typed = text.text;
    const float name_width = ImGui::CalcTextSize(text.name.c_str()).x;
    ImGui::SetNextItemWidth(-name_width - ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::InputTextWithHint(text.name.c_str(), text.hint.c_str(), &typed))
      out.emplace_back(TextChange{text.name, std::string(cut_utf8(typed, kToolTextBytesMax))});
    if (!text.error.empty()) {
      ImGui::PushTextWrapPos();
      ImGui::TextColored(kToolWarning, "%s", text.error.c_str());
      ImGui::PopTextWrapPos();
    }
    build_chips(text.chips);
  }
}

void build_next_click(const HudState& state, std::vector<ToolCommand>& out) {
  const ToolBox& box = *state.tools;
  const EditPreview& preview = box.preview();
  const BuildPreview& builds = box.build_preview();
  bool is_shown = box.is_preview_shown();
  if (ImGui::Checkbox("preview of the next click", &is_shown))
    out.emplace_back(PreviewChange{is_shown});
  if (!is_shown) return;
  if (!state.has_preview) {
    ImGui::TextDisabled("one voxel");
  } else if (!box.preview_refusal().empty()) {
    ImGui::TextColored(kToolWarning, "%s", box.preview_refusal().c_str());
  } else if (box.tool().selects()) {
    ImGui::TextDisabled("changes no voxel");
  } else if (!box.is_preview_complete()) {
    ImGui::TextDisabled("...");
  } else {
    ImGui::TextUnformatted(preview_words(box).c_str());
  }
  if (builds.cell_voxels() > 1)
    ImGui::TextDisabled("shown in cells of %d voxels", int{builds.cell_voxels()});
  if (preview.missing_chunks() != 0) {
    ImGui::TextColored(kToolWarning, "%zu chunks of it are not loaded", preview.missing_chunks());
  }
  if (preview.is_cut()) ImGui::TextColored(kToolWarning, "only a part of it is shown");
}

/// Shows a button. Returns true if it is pressed. It stands on the line of the last item unless it
/// is the first one.
bool button_beside(const char* label, bool is_first = false) {
  if (!is_first) ImGui::SameLine();
  return ImGui::Button(label);
}

std::string name_of(const HudState& state, Material material) {
  if (material == kEmpty || !state.materials->knows(material)) return "nothing";
  return readable_name((*state.materials)[material].name);
}

}  // namespace

void ToolWindow::toggle() {
  const bool takes_mouse = !is_open_ || !has_mouse_;
  is_open_ = has_mouse_ = takes_mouse;
}

bool ToolWindow::close() { return std::exchange(is_open_, false); }

void ToolWindow::build(const HudState& state, double scale, std::vector<ToolCommand>& out) {
  // A click beside the window has captured the mouse: the player builds, and the window only shows.
  if (state.is_captured && !was_captured_) has_mouse_ = false;
  was_captured_ = state.is_captured;
  if (!is_open_ || !has_mouse_) {
    if (std::exchange(types_places_, false)) out.emplace_back(PlacesChange{});
  }
  if (!is_open_) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const auto width = static_cast<float>(460 * scale);
  ImGui::SetNextWindowPos({size.x - static_cast<float>(10 * scale), static_cast<float>(10 * scale)},
                          ImGuiCond_Appearing, {1, 0});
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, size.y * 0.86F});
  ImGui::Begin("Tools", &is_open_,
               ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                   ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushItemWidth(static_cast<float>(210 * scale));
  build_tools(*state.tools, out);
  ImGui::Separator();
  build_parameters(state.tools->tool(), out);
  build_texts(state.tools->tool(), out);
  build_next_click(state, out);
  build_places(state, out);
  build_symmetry(state, out);
  if (ImGui::CollapsingHeader("Time of day")) time_ = build_time_slider(state);
  build_selection(state, scale, out);
  ImGui::PopItemWidth();
  ImGui::End();
}

void ToolWindow::build_tools(const ToolBox& box, std::vector<ToolCommand>& out) const {
  if (!ImGui::BeginTable("tools", 3, ImGuiTableFlags_SizingFixedFit)) return;
  for (std::size_t i = 0; i < box.tools().size(); ++i) {
    const Tool& tool = *box.tools()[i];
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const std::string name(tool.name());
    if (ImGui::Selectable(name.c_str(), &tool == &box.tool(), ImGuiSelectableFlags_SpanAllColumns))
      out.emplace_back(ToolChoice{name});
    ImGui::TableNextColumn();
    ImGui::TextDisabled("%s", std::string(tool.what()).c_str());
    ImGui::TableNextColumn();
    const auto key = static_cast<Action>(static_cast<std::size_t>(Action::tool_1) + i);
    if (key <= Action::tool_10) ImGui::TextDisabled("%s", keys_.keys_text(key).c_str());
  }
  ImGui::EndTable();
}

TypedPlaces ToolWindow::typed_places() const {
  TypedPlaces typed{
      clears_ ? ToolButton::clear : ToolButton::place, {}, static_cast<Direction>(face_)};
  for (const Numbers& at : places_) typed.places.push_back(voxel_of(at));
  return typed;
}

void ToolWindow::build_places(const HudState& state, std::vector<ToolCommand>& out) {
  const ToolBox& box = *state.tools;
  const Tool& tool = box.tool();
  if (!ImGui::CollapsingHeader("Places by numbers")) {
    if (std::exchange(types_places_, false)) out.emplace_back(PlacesChange{});
    return;
  }
  const auto [least, most] = box.typed_count();
  const bool is_open_ended = least != most;
  const std::size_t shown = std::max(is_open_ended ? std::size_t{2} : least, least);
  const Numbers first = state.sight ? numbers_of(*state.sight) : Numbers{};
  if (places_.size() < shown) places_.resize(shown, places_.empty() ? first : places_.back());
  if (!is_open_ended) places_.resize(shown);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    place_fields(std::string(tool.place_name(i)).c_str(), places_[i]);
    if (const auto seen = sight_button(state)) places_[i] = numbers_of(*seen);
    ImGui::PopID();
  }
  if (is_open_ended) {
    ImGui::BeginDisabled(places_.size() >= most);
    if (button_beside("one more place", true)) places_.push_back(places_.back());
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(places_.size() <= shown);
    if (ImGui::Button("one less")) places_.pop_back();
    ImGui::EndDisabled();
  }
  if (tool.chooses_solid() && !tool.reaches_air()) choice("face", face_, kDirections);
  if (!tool.selects()) {
    int button = clears_ ? 1 : 0;
    ImGui::RadioButton("set", &button, 0);
    ImGui::SameLine();
    ImGui::RadioButton("remove", &button, 1);
    ImGui::SameLine();
    clears_ = button == 1;
  }
  const bool is_applied = ImGui::Button("Apply");
  if (has_mouse_) {
    types_places_ = true;
    TypedPlaces typed = typed_places();
    if (box.typed_places() != typed) out.emplace_back(PlacesChange{std::move(typed)});
    if (is_applied) out.emplace_back(TypedApply{});
  }
}

void ToolWindow::build_symmetry(const HudState& state, std::vector<ToolCommand>& out) {
  if (!ImGui::CollapsingHeader("Symmetry")) return;
  ImGui::PushID("symmetry");
  Symmetry symmetry = state.tools->symmetry();
  int kind = static_cast<int>(symmetry.kind);
  if (choice("kind", kind, kSymmetries)) {
    const bool begins = symmetry.kind == SymmetryKind::none;
    symmetry.kind = static_cast<SymmetryKind>(kind);
    if (begins && state.sight) {
      symmetry.centre2_x = 2 * state.sight->x;
      symmetry.centre2_z = 2 * state.sight->z;
    }
  }
  // A whole number is the middle of a voxel, and a half the border behind it.
  std::array<double, 2> centre = {symmetry.centre2_x / 2.0, symmetry.centre2_z / 2.0};
  const auto field = [](const char* label, double& value, std::int32_t& twice) {
    if (!ImGui::InputDouble(label, &value, 0.5, 1, "%.1f")) return;
    value = std::clamp<double>(value, kCoordinateMin, kCoordinateMax);
    twice = static_cast<std::int32_t>(std::lround(2 * value));
  };
  field("centre x", centre[0], symmetry.centre2_x);
  field("centre z", centre[1], symmetry.centre2_z);
  if (const auto seen = sight_button(state)) {
    symmetry.centre2_x = 2 * seen->x;
    symmetry.centre2_z = 2 * seen->z;
  }
  ImGui::PopID();
  if (symmetry != state.tools->symmetry()) out.emplace_back(SymmetryChange{symmetry});
}

void ToolWindow::build_selection(const HudState& state, double scale,
                                 std::vector<ToolCommand>& out) {
  if (!ImGui::CollapsingHeader("Selection and clipboard")) return;
  const ToolBox& box = *state.tools;
  const std::optional<VoxelBox>& selection = box.selection();
  Numbers corner{}, sides{1, 1, 1};
  if (selection) {
    corner = numbers_of(selection->min);
    sides = {selection->max.x - corner[0], selection->max.y - corner[1],
             selection->max.z - corner[2]};
  } else if (state.sight) {
    corner = numbers_of(*state.sight);
  }
  if (box.selected().voxels) {
    ImGui::TextDisabled("%llu voxels; the numbers are those of the box around them",
                        static_cast<unsigned long long>(box.selected().voxel_count));
  } else if (const std::size_t parts = box.selected().boxes.boxes().size(); parts > 1) {
    ImGui::TextDisabled("%zu boxes; the numbers are those of the box around them", parts);
  }
  bool is_changed = place_fields("lowest corner", corner);
  if (const auto seen = sight_button(state)) {
    corner = numbers_of(*seen);
    is_changed = true;
  }
  is_changed = place_fields("size", sides) || is_changed;
  for (int& side : sides) side = std::max(side, 1);
  if (is_changed) {
    out.emplace_back(SelectionChange{VoxelBox{
        voxel_of(corner), {corner[0] + sides[0], corner[1] + sides[1], corner[2] + sides[2]}}});
  }
  ImGui::BeginDisabled(!selection);
  const auto add = [&](SelectionCommand::Kind kind, Material material = kEmpty,
                       Material other = kEmpty) {
    out.emplace_back(SelectionCommand{kind, !keeps_air_, material, other, {}, 1});
  };
  using Kind = SelectionCommand::Kind;
  if (button_beside("Copy", true)) add(Kind::copy);
  if (button_beside("Cut")) add(Kind::cut);
  if (button_beside("Clear")) add(Kind::clear);
  const Material held = state.slots[state.slot];
  if (button_beside(("Fill with " + name_of(state, held) + "###fill").c_str()))
    add(Kind::fill, held);
  if (button_beside("None")) out.emplace_back(SelectionChange{});
  ImGui::Checkbox("copies with its air", &keeps_air_);
  ImGui::SetNextItemWidth(static_cast<float>(110 * scale));
  ImGui::InputTextWithHint("##replaced", "material", &replaced_);
  const auto found =
      replaced_.empty() ? std::vector<Material>{} : matching_materials(*state.materials, replaced_);
  const std::optional<Material> old = found.empty() ? state.aimed_at : found.front();
  ImGui::SameLine();
  ImGui::BeginDisabled(!old);
  const std::string label =
      "Replace " + name_of(state, old.value_or(kEmpty)) + " by " + name_of(state, held);
  if (ImGui::Button((label + "###replace").c_str())) add(Kind::replace, *old, held);
  ImGui::EndDisabled();
  build_steps(out);
  build_narrow(out);
  ImGui::EndDisabled();
  build_clipboard(box, out);
  if (state.has_files && file_.build(state)) add(SelectionCommand::Kind::copy);
}

void ToolWindow::build_steps(std::vector<ToolCommand>& out) {
  using Kind = SelectionCommand::Kind;
  ImGui::PushItemWidth(ImGui::GetFontSize() * 5);
  choice("##direction", direction_, kDirections);
  ImGui::SameLine();
  ImGui::InputInt("##count", &count_);
  ImGui::PopItemWidth();
  count_ = std::clamp(count_, -4096, 4096);
  constexpr std::array<std::pair<const char*, Kind>, 4> kSteps = {
      {{"Stack", Kind::stack}, {"Move", Kind::move}, {"Grow", Kind::grow}, {"Shift", Kind::shift}}};
  for (const auto& [label, kind] : kSteps) {
    if (!button_beside(label)) continue;
    SelectionCommand command;
    command.kind = kind;
    command.direction = static_cast<Direction>(direction_);
    command.count = count_;
    out.emplace_back(command);
  }
}

void ToolWindow::build_narrow(std::vector<ToolCommand>& out) {
  using Kind = SelectionCommand::Kind;
  ImGui::SetNextItemWidth(ImGui::GetFontSize() * 11);
  ImGui::InputTextWithHint("##narrowed", "is stone and exposed", &narrowed_);
  constexpr std::array<std::pair<const char*, Kind>, 2> kNarrows = {
      {{"Keep only these", Kind::keep}, {"Leave them out", Kind::drop}}};
  for (const auto& [label, kind] : kNarrows) {
    if (!button_beside(label)) continue;
    SelectionCommand command;
    command.kind = kind;
    command.filter = cut_utf8(narrowed_, kToolTextBytesMax);
    out.emplace_back(std::move(command));
  }
}

void ToolWindow::build_reshape(std::vector<ToolCommand>& out) {
  constexpr std::array<const char*, 3> kAxisNames = {"x", "y", "z"};
  ImGui::PushItemWidth(ImGui::GetFontSize() * 6);
  choice("##turn axis", turn_axis_, kAxisNames);
  ImGui::SameLine();
  ImGui::InputInt("degrees", &turn_degrees_);
  ImGui::SameLine();
  ImGui::InputInt("percent", &turn_percent_, 10);
  ImGui::PopItemWidth();
  turn_degrees_ = std::clamp(turn_degrees_, -360, 360);
  turn_percent_ = std::clamp(turn_percent_, kScaleMin, kScaleMax);
  if (button_beside("Turn and scale", true))
    out.emplace_back(
        ClipboardReshape{{static_cast<Axis>(turn_axis_), turn_degrees_, turn_percent_}});
}

void ToolWindow::build_clipboard(const ToolBox& box, std::vector<ToolCommand>& out) {
  const ToolClipboard& clipboard = box.clipboard();
  if (!clipboard.build) return ImGui::TextDisabled("nothing was copied");
  ImGui::TextUnformatted(("clipboard " + size_text(*clipboard.build)).c_str());
  if (button_beside("Turn left")) out.emplace_back(ClipboardTurn{1, std::nullopt});
  if (button_beside("right")) out.emplace_back(ClipboardTurn{-1, std::nullopt});
  constexpr std::array<std::pair<const char*, Axis>, 3> kAxes = {
      {{"Mirror x", Axis::x}, {"y", Axis::y}, {"z", Axis::z}}};
  for (const auto& [label, axis] : kAxes) {
    if (button_beside(label)) out.emplace_back(ClipboardTurn{0, axis});
  }
  build_reshape(out);
  if (button_beside("Paste", true)) out.emplace_back(ToolChoice{"paste"});
}

}  // namespace runstone
