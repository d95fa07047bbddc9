#include "client/script/tool_words.hpp"

#include <array>
#include <string>
#include <utility>

#include "common/build_files/build_files.hpp"
#include "common/build_files/model_words.hpp"
#include "common/models/model_format.hpp"

namespace runstone {
namespace {

constexpr std::int32_t kStepsMax = 4096;

Direction read_direction(ScriptWords& words) {
  constexpr std::array<std::string_view, kDirectionCount> kNames = {"-x", "+x", "-y",
                                                                    "+y", "-z", "+z"};
  const std::string_view text = words.word("DIRECTION");
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (text == kNames[i]) return static_cast<Direction>(i);
  }
  throw LineError{"DIRECTION: \"" + std::string(text) + "\" is none of -x, +x, -y, +y, -z, +z"};
}

/// Takes the word if it is the next one.
bool takes_word(ScriptWords& words, const char* word) {
  if (words.peek() != word) return false;
  words.word(word);
  return true;
}

script::Step use_step(script::UseTool::Part part, ScriptWords& words) {
  const bool is_clear = takes_word(words, "clear");
  return script::UseTool{part, is_clear ? ToolButton::clear : ToolButton::place};
}

script::Step aim_step(ScriptWords& words) {
  script::AimAt aim;
  if (takes_word(words, "look")) return aim;
  aim.voxel = read_position(words);
  aim.face = read_direction(words);
  return aim;
}

script::Step select_step(ScriptWords& words) {
  script::Select select;
  if (takes_word(words, "none")) return select;
  if (takes_word(words, "add")) select.mode = SelectMode::add;
  if (select.mode == SelectMode::fresh && takes_word(words, "remove"))
    select.mode = SelectMode::remove;
  select.from = read_position(words);
  select.to = read_position(words);
  return select;
}

script::Step selection_step(ScriptWords& words) {
  using Kind = SelectionCommand::Kind;
  constexpr std::array<std::pair<std::string_view, Kind>, 11> kKinds = {{{"copy", Kind::copy},
                                                                         {"cut", Kind::cut},
                                                                         {"clear", Kind::clear},
                                                                         {"fill", Kind::fill},
                                                                         {"replace", Kind::replace},
                                                                         {"stack", Kind::stack},
                                                                         {"move", Kind::move},
                                                                         {"grow", Kind::grow},
                                                                         {"shift", Kind::shift},
                                                                         {"keep", Kind::keep},
                                                                         {"drop", Kind::drop}}};
  const std::string_view text = words.word("what to do with the selection");
  script::SelectionEdit edit;
  SelectionCommand& command = edit.command;
  bool is_known = false;
  for (const auto& [name, kind] : kKinds) {
    if (text != name) continue;
    command.kind = kind;
    is_known = true;
  }
  if (!is_known)
    throw LineError{"\"" + std::string(text) + "\" is nothing to do with the selection"};
  switch (command.kind) {
    case Kind::copy:
    case Kind::cut:
      command.is_solid = takes_word(words, "solid");
      break;
    case Kind::clear:
      break;
    case Kind::fill:
      edit.material = read_material(words);
      break;
    case Kind::replace:
      edit.material = read_material(words);
      edit.other = read_material(words);
      break;
    case Kind::keep:
    case Kind::drop:
      command.filter = words.rest();
      if (command.filter.empty()) throw LineError{"expected FILTER"};
      break;
    case Kind::stack:
    case Kind::move:
    case Kind::grow:
    case Kind::shift:
      command.is_all_around = command.kind == Kind::grow && takes_word(words, "all");
      if (!command.is_all_around) command.direction = read_direction(words);
      command.count = read_number<std::int32_t>(words, "N", -kStepsMax, kStepsMax);
      break;
  }
  return edit;
}

script::Step places_step(ScriptWords& words) {
  script::TypePlaces typed;
  if (takes_word(words, "none")) return typed;
  if (takes_word(words, "clear")) typed.button = ToolButton::clear;
  if (takes_word(words, "face")) typed.face = read_direction(words);
  do {
    typed.places.push_back(read_position(words));
  } while (words.more());
  if (typed.places.size() > kStrokePointsMax) throw LineError{"there are more than 256 places"};
  return typed;
}

script::Step symmetry_step(ScriptWords& words) {
  constexpr std::array<std::string_view, 5> kKinds = {"none", "x", "z", "both", "point"};
  const std::string_view text = words.word("none, x, z, both or point");
  script::SetSymmetry symmetry;
  bool is_known = false;
  for (std::size_t i = 0; i < kKinds.size(); ++i) {
    if (text != kKinds[i]) continue;
    symmetry.kind = static_cast<SymmetryKind>(i);
    is_known = true;
  }
  if (!is_known)
    throw LineError{"\"" + std::string(text) + "\" is none of none, x, z, both, point"};
  if (symmetry.kind != SymmetryKind::none) symmetry.centre = read_position(words);
  return symmetry;
}

script::Step turn_step(ScriptWords& words) {
  BuildRotation rotation;
  rotation.axis = read_axis(words);
  rotation.degrees = read_number<std::int32_t>(words, "DEGREES", -360, 360);
  if (words.more())
    rotation.percent = read_number<std::int32_t>(words, "PERCENT", kScaleMin, kScaleMax);
  return script::RunToolCommand{ClipboardReshape{rotation}};
}

/// Returns the bytes of `text` that name a file. Behind the name of a model, which may have blanks,
/// words of ModelChoices may stand.
std::size_t file_name_bytes(std::string_view text) {
  if (file_refusal(std::string(text), false).empty()) return text.size();
  for (std::size_t end = text.find(' '); end != std::string_view::npos;
       end = text.find(' ', end + 1)) {
    if (model_format_of(text.substr(0, end))) return end;
  }
  return text.size();
}

void read_model_choices(std::string_view text, ModelChoices& choices) {
  ScriptWords words(text);
  while (words.more()) {
    const std::string name(words.word("WORD"));
    const ModelWord* const word = model_word(name);
    if (word == nullptr) throw LineError{"unexpected \"" + name + "\""};
    std::string value;
    if (word->has_value()) value = words.word(std::string(word->values).c_str());
    if (const auto chosen = choose_by_word(*word, value, choices); !chosen)
      throw LineError{name + " \"" + value + "\": " + chosen.error()};
  }
}

script::Step clipboard_step(ScriptWords& words) {
  const std::string_view what = words.word("load or save");
  if (what != "load" && what != "save")
    throw LineError{"\"" + std::string(what) + "\" is neither load nor save"};
  const std::string_view rest = words.rest();
  if (rest.empty()) throw LineError{"expected FILE"};
  if (what == "save") return script::FileOfClipboard{true, std::string(rest), {}};
  const std::size_t bytes = file_name_bytes(rest);
  script::FileOfClipboard step{false, std::string(rest.substr(0, bytes)), {}};
  read_model_choices(rest.substr(bytes), step.model);
  if (const std::string why = choices_refusal(step.model); !why.empty())
    throw LineError{step.file + ": " + why};
  return step;
}

script::Step hotbar_step(ScriptWords& words) {
  using What = script::NamedHotbar::What;
  const std::string_view verb = words.word("keep, take or forget");
  if (verb != "keep" && verb != "take" && verb != "forget")
    throw LineError{"\"" + std::string(verb) + "\" is none of keep, take, forget"};
  const What what = verb == "keep" ? What::keep : verb == "take" ? What::take : What::forget;
  script::NamedHotbar out{what, std::string(words.rest())};
  if (out.name.empty()) throw LineError{"expected NAME"};
  return out;
}

}  // namespace

std::optional<script::Step> tool_step(std::string_view verb, ScriptWords& words) {
  using Part = script::UseTool::Part;
  if (verb == "tool") return script::ChooseTool{std::string(words.word("TOOL"))};
  if (verb == "param") {
    script::SetParameter parameter{std::string(words.word("NAME")), {}};
    parameter.value = words.word("VALUE");
    return parameter;
  }
  if (verb == "text") {
    TextChange text{std::string(words.word("NAME")), {}};
    text.text = words.rest();
    return script::RunToolCommand{std::move(text)};
  }
  if (verb == "aim") return aim_step(words);
  if (verb == "hold") return script::Hold{read_material(words)};
  if (verb == "hotbar") return hotbar_step(words);
  if (verb == "use") return use_step(Part::click, words);
  if (verb == "press") return use_step(Part::press, words);
  if (verb == "drag") return script::UseTool{Part::drag, {}};
  if (verb == "release") return script::UseTool{Part::release, {}};
  if (verb == "select") return select_step(words);
  if (verb == "selection") return selection_step(words);
  if (verb == "nudge") return script::RunToolCommand{PasteNudge{read_direction(words)}};
  if (verb == "rotate")
    return script::RunToolCommand{
        ClipboardTurn{read_number<int>(words, "QUARTERS", -3, 3), std::nullopt}};
  if (verb == "mirror") return script::RunToolCommand{ClipboardTurn{0, read_axis(words)}};
  if (verb == "turn") return turn_step(words);
  if (verb == "symmetry") return symmetry_step(words);
  if (verb == "clipboard") return clipboard_step(words);
  if (verb == "preview") return script::RunToolCommand{PreviewChange{read_on_off(words)}};
  if (verb == "places") return places_step(words);
  if (verb == "apply") return script::RunToolCommand{TypedApply{}};
  return std::nullopt;
}

}  // namespace runstone
