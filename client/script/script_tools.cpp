// The commands of ScriptRunner that work the building tools.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "client/script/script_runner.hpp"

namespace runstone {
namespace {

/// Returns the value of a number or of a choice of the parameter, or nullopt if it is neither.
std::optional<std::int32_t> value_of(const ToolParameter& parameter, const std::string& text) {
  const auto choice = std::find(parameter.choices.begin(), parameter.choices.end(), text);
  if (choice != parameter.choices.end())
    return parameter.low + static_cast<std::int32_t>(choice - parameter.choices.begin());
  std::int32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void ScriptRunner::start_edits(ToolEdits made) {
  start();
  made_ = {};
  if (!made) return fail("edit refused: " + made.error());
  made_ = *std::move(made);
}

ScriptRunner::Progress ScriptRunner::propose_edits() {
  if (is_building_ || host_.needs_build(made_)) return build(made_);
  const std::vector<EditDescriptor>& edits = made_.edits;
  for (; state_.count < edits.size(); ++state_.count) {
    const EditDescriptor& edit = edits[state_.count];
    if (made_.has_followers && state_.count > 0) {
      // The edit of a neighbour does not wait for the edit budget. If the budget is used up, it is
      // left out.
      static_cast<void>(host_.propose(edit, now_us_, now_us_, ActionPart::next));
      continue;
    }
    const Progress progress = propose(edit, part_of(made_, state_.count));
    if (progress != Progress::done) return progress;
  }
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::ChooseTool& c) {
  if (const auto done = host_.tool_box().choose(c.name); !done) return give_up(done.error());
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::SetParameter& c) {
  const Tool& tool = host_.tool_box().tool();
  for (const ToolParameter& parameter : tool.parameters()) {
    if (parameter.name != c.name) continue;
    const auto value = value_of(parameter, c.value);
    if (!value) return give_up("\"" + c.value + "\" is no value of " + c.name);
    const auto done = host_.tool_box().set_parameter(c.name, *value);
    return done ? Progress::done : give_up(done.error());
  }
  return give_up("the tool " + std::string(tool.name()) + " has no parameter " + c.name);
}

ScriptRunner::Progress ScriptRunner::run(const script::AimAt& c) {
  if (!c.voxel) {
    host_.fix_aim(std::nullopt);
    return Progress::done;
  }
  const auto at = resolve_voxel(*c.voxel);
  if (!at) return Progress::stop;
  host_.fix_aim(FixedAim{*at, c.face});
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::Hold& c) {
  const auto material = resolve_material(c.material);
  if (!material) return Progress::stop;
  host_.hold(*material);
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::NamedHotbar& c) {
  const auto done = host_.use_hotbar(c);
  return done ? Progress::done : give_up(done.error());
}

ScriptRunner::Progress ScriptRunner::run(const script::UseTool& c) {
  using Part = script::UseTool::Part;
  ToolBox& box = host_.tool_box();
  if (!started_) {
    if (!host_.replica().opened()) return give_up("no world is open");
    const Aim aim = host_.aim();
    ToolEdits edits = ToolAction{};
    if (c.part == Part::click || c.part == Part::press)
      edits = box.press(host_.replica(), aim, c.button);
    if (c.part == Part::drag) box.drag(aim);
    const bool releases =
        c.part == Part::release || (c.part == Part::click && box.tool().is_drawn());
    if (edits && releases) edits = box.release(host_.replica(), aim);
    start_edits(std::move(edits));
  }
  return propose_edits();
}

ScriptRunner::Progress ScriptRunner::run(const script::Select& c) {
  if (!c.from || !c.to) {
    host_.tool_box().select(std::nullopt);
    return Progress::done;
  }
  const auto a = resolve_voxel(*c.from);
  const auto b = resolve_voxel(*c.to);
  if (!a || !b) return Progress::stop;
  const auto done = host_.tool_box().select(box_between(*a, *b), c.mode);
  return done ? Progress::done : give_up(done.error());
}

ToolEdits ScriptRunner::carry_out(const ToolCommand& command) {
  return runstone::carry_out(host_.tool_box(), host_.replica(), host_.aim().held, command);
}

ScriptRunner::Progress ScriptRunner::run(const script::SelectionEdit& c) {
  if (!started_) {
    SelectionCommand command = c.command;
    const std::pair<const std::string*, Material*> materials[] = {{&c.material, &command.material},
                                                                  {&c.other, &command.other}};
    for (const auto& [name, id] : materials) {
      if (name->empty()) continue;
      const auto material = resolve_material(*name);
      if (!material) return Progress::stop;
      *id = *material;
    }
    start_edits(carry_out(command));
  }
  return propose_edits();
}

ScriptRunner::Progress ScriptRunner::run(const script::RunToolCommand& c) {
  if (!started_) start_edits(carry_out(c.command));
  return propose_edits();
}

ScriptRunner::Progress ScriptRunner::run(const script::FileOfClipboard& c) {
  const auto done =
      c.is_written ? host_.save_clipboard(c.file) : host_.load_clipboard(c.file, c.model);
  return done ? Progress::done : give_up(done.error());
}

ScriptRunner::Progress ScriptRunner::run(const script::TypePlaces& c) {
  TypedPlaces typed{c.button, {}, c.face};
  for (const ScriptPosition& place : c.places) {
    const auto at = resolve_voxel(place);
    if (!at) return Progress::stop;
    typed.places.push_back(*at);
  }
  PlacesChange change;
  if (!typed.places.empty()) change.typed = std::move(typed);
  static_cast<void>(carry_out(std::move(change)));
  return Progress::done;
}

ScriptRunner::Progress ScriptRunner::run(const script::SetSymmetry& c) {
  if (c.kind == SymmetryKind::none) {
    host_.tool_box().set_symmetry({});
    return Progress::done;
  }
  const auto at = resolve(c.centre);
  if (!at) return Progress::stop;
  // A whole number is the middle of that voxel, and a half the border behind it.
  const auto twice = [](double v) { return static_cast<std::int32_t>(std::lround(2 * v)); };
  host_.tool_box().set_symmetry({c.kind, twice(at->x), twice(at->z)});
  return Progress::done;
}

}  // namespace runstone
