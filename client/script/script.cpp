#include "client/script/script.hpp"

#include <optional>
#include <utility>

#include "client/input/key.hpp"
#include "client/render/antialiasing.hpp"
#include "client/script/panel_words.hpp"
#include "client/script/script_words.hpp"
#include "client/script/tool_words.hpp"
#include "common/core/day_time.hpp"
#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr std::size_t kRepeatDepthMax = 8;

constexpr std::string_view kOnly = "only:";

bool is_mask(std::string_view text) {
  return text == "empty" || text == "solid" || text.starts_with(kOnly);
}

ScriptMask mask(ScriptWords& words) {
  if (!words.more()) return {};
  const std::string_view text = words.word("MASK");
  if (text == "empty") return {MaskKind::only_empty, {}};
  if (text == "solid") return {MaskKind::only_solid, {}};
  if (text.starts_with(kOnly) && text.size() > kOnly.size()) {
    return {MaskKind::only_material, std::string(text.substr(kOnly.size()))};
  }
  throw LineError{"MASK: \"" + std::string(text) + "\" is none of empty, solid, only:MATERIAL"};
}

script::Step stroke_step(ScriptWords& words) {
  script::Stroke stroke;
  stroke.radius = read_number<std::uint16_t>(words, "R", 1, kEditRadiusMax);
  stroke.material = read_material(words);
  while (words.more() && !is_mask(words.peek())) stroke.points.push_back(read_position(words));
  if (stroke.points.size() < 2) throw LineError{"a stroke needs two positions or more"};
  if (stroke.points.size() > kStrokePointsMax)
    throw LineError{"a stroke has at most 256 positions"};
  stroke.mask = mask(words);
  return stroke;
}

script::Step copy_step(ScriptWords& words) {
  script::Copy copy;
  copy.name = words.word("NAME");
  copy.from = read_position(words);
  copy.to = read_position(words);
  if (words.peek() == "solid") {
    words.word("solid");
    copy.solid = true;
  }
  return copy;
}

script::Step paste_step(ScriptWords& words) {
  script::Paste paste;
  paste.name = words.word("NAME");
  paste.at = read_position(words);
  for (;;) {
    if (words.peek() == "rotate") {
      words.word("rotate");
      paste.orientation =
          paste.orientation.rotated_about_y(read_number<int>(words, "QUARTERS", -3, 3));
    } else if (words.peek() == "mirror") {
      words.word("mirror");
      paste.orientation = paste.orientation.mirrored(read_axis(words));
    } else {
      break;
    }
  }
  paste.mask = mask(words);
  return paste;
}

script::Step travel_step(ScriptWords& words) {
  const std::string_view where = words.word("live, SEQ or -SECONDS");
  script::HistoryRequest travel;
  if (where == "live") return travel;
  if (where.starts_with('-')) {
    const auto seconds = to_number<double>(where.substr(1));
    if (!seconds || *seconds < 0 || *seconds > 1e9) {
      throw LineError{"\"" + std::string(where) + "\" is not a number of seconds ago"};
    }
    travel.to = HistoryTarget::time;
    travel.seconds_ago = *seconds;
    return travel;
  }
  const auto seq = to_number<Sequence>(where);
  if (!seq || *seq > kSequenceMax) {
    throw LineError{"\"" + std::string(where) + "\" is none of live, SEQ, -SECONDS"};
  }
  travel.to = HistoryTarget::sequence;
  travel.seq = *seq;
  return travel;
}

script::Step wait_step(ScriptWords& words) {
  const std::string_view what = words.word("SECONDS, loaded, horizon, durable, synced or chat");
  if (what == "chat") {
    script::WaitChat wait{read_number<double>(words, "SECONDS", 0, 1e6), {}};
    wait.text = words.rest();
    if (wait.text.empty()) throw LineError{"expected TEXT"};
    return wait;
  }
  std::optional<script::Until> until;
  if (what == "loaded") until = script::Until::loaded;
  if (what == "horizon") until = script::Until::horizon;
  if (what == "durable") until = script::Until::durable;
  if (what == "synced") until = script::Until::synced;
  if (until) {
    const double most =
        words.more() ? read_number<double>(words, "SECONDS", 0, 1e6) : kScriptWaitSecondsMax;
    return script::WaitUntil{*until, most};
  }
  const auto seconds = to_number<double>(what);
  if (!seconds || *seconds < 0) {
    throw LineError{"\"" + std::string(what) +
                    "\" is none of SECONDS, loaded, horizon, durable, synced, chat"};
  }
  return script::Wait{*seconds};
}

/// Parses any command except `end`, which needs the lines before it.
script::Step step_of(std::string_view verb, ScriptWords& words) {
  if (verb == "move") return script::Move{read_position(words)};
  if (verb == "walk") {
    script::Walk walk{read_position(words), 0};
    walk.speed = read_number<double>(words, "SPEED", 0.001, 1e6);
    return walk;
  }
  if (verb == "roam") {
    script::Roam roam{read_position(words), 0};
    roam.speed = read_number<double>(words, "SPEED", 0.001, 1e6);
    return roam;
  }
  if (verb == "look") {
    script::Look look;
    look.yaw = read_number<double>(words, "YAW", -360, 360);
    look.pitch = read_number<double>(words, "PITCH", -90, 90);
    return look;
  }
  if (verb == "time") {
    const auto share = parse_day_time(words.word("HH:MM"));
    if (!share) throw LineError{"expected a time of day, HH:MM"};
    return script::TimeOfDay{*share};
  }
  if (verb == "antialiasing") {
    const auto antialiasing = parse_antialiasing(words.word("CHOICE"));
    if (!antialiasing) throw LineError{"expected auto, off, fxaa or msaa"};
    return script::SmoothEdges{*antialiasing};
  }
  if (verb == "lookat") return script::LookAt{read_position(words)};
  if (verb == "set") {
    script::Set set{read_position(words), {}};
    set.material = read_material(words);
    return set;
  }
  if (verb == "remove") return script::Set{read_position(words), "0"};
  if (verb == "box") {
    script::Box box;
    box.from = read_position(words);
    box.to = read_position(words);
    box.material = read_material(words);
    box.mask = mask(words);
    return box;
  }
  if (verb == "sphere") {
    script::Sphere sphere;
    sphere.centre = read_position(words);
    sphere.radius = read_number<std::uint16_t>(words, "R", 0, kEditRadiusMax);
    sphere.material = read_material(words);
    sphere.mask = mask(words);
    return sphere;
  }
  if (verb == "stroke") return stroke_step(words);
  if (verb == "copy") return copy_step(words);
  if (verb == "paste") return paste_step(words);
  if (verb == "dig") return script::Dig{};
  if (verb == "place") return script::Place{read_material(words)};
  if (verb == "wait") return wait_step(words);
  if (verb == "screenshot") return script::Screenshot{std::string(words.word("FILE"))};
  if (verb == "expect") {
    script::Expect expect{read_position(words), {}};
    expect.material = read_material(words);
    return expect;
  }
  if (verb == "repeat")
    return script::Repeat{read_number<std::uint32_t>(words, "N", 0, 1'000'000'000), 0};
  if (verb == "burst") {
    script::Burst burst;
    burst.count = read_number<std::uint32_t>(words, "N", 0, 1'000'000'000);
    burst.rate = read_number<double>(words, "RATE", 0.001, 1e6);
    burst.radius = read_number<std::int32_t>(words, "RADIUS", 0, 4096);
    burst.seed = read_number<std::uint64_t>(words, "SEED", 0, UINT64_MAX);
    burst.material = read_material(words);
    return burst;
  }
  if (verb == "digests") return script::Digests{std::string(words.word("FILE"))};
  if (verb == "travel") return travel_step(words);
  if (verb == "undo" || verb == "redo") return script::Command{std::string(verb)};
  if (verb == "say") {
    script::Say say{std::string(words.rest())};
    if (say.text.empty()) throw LineError{"expected TEXT"};
    if (say.text.size() > kChatBytesMax) throw LineError{"TEXT has at most 512 bytes"};
    return say;
  }
  if (verb == "command") {
    script::Command command{std::string(words.rest())};
    if (command.text.empty()) throw LineError{"expected TEXT"};
    if (command.text.size() > kCommandBytesMax) throw LineError{"TEXT has at most 1024 bytes"};
    return command;
  }
  if (verb == "key") {
    const std::string_view chord = words.word("KEY");
    if (!parse_key_chord(chord)) throw LineError{"KEY: \"" + std::string(chord) + "\" is no key"};
    return script::PressKey{std::string(chord)};
  }
  if (verb == "type") {
    script::Type type{std::string(words.rest())};
    if (type.text.empty()) throw LineError{"expected TEXT"};
    if (!is_printable_utf8(type.text)) throw LineError{"TEXT is not UTF-8"};
    return type;
  }
  if (verb == "click") {
    script::Click click;
    click.x = read_number<double>(words, "X", 0, 65'535);
    click.y = read_number<double>(words, "Y", 0, 65'535);
    return click;
  }
  if (verb == "interface") return script::ShowInterface{read_on_off(words)};
  if (verb == "inspect") {
    const std::string_view name = words.word("MODE");
    const auto mode = parse_inspection_mode(name);
    if (!mode)
      throw LineError{"\"" + std::string(name) + "\" is none of wireframe, runs, orders, layers"};
    return script::Inspect{*mode, read_on_off(words)};
  }
  if (verb == "quit") return script::Quit{};
  if (auto step = tool_step(verb, words)) return *std::move(step);
  if (auto step = panel_step(verb, words)) return *std::move(step);
  throw LineError{"unknown command \"" + std::string(verb) + "\""};
}

}  // namespace

Result<Script, TextError> parse_script(std::string_view text, std::string_view file) {
  Script script;
  script.file = file;
  std::vector<std::size_t> open;  // indices of repeats that have no end yet
  std::uint32_t number_of_line = 0;
  const auto error = [&](std::uint32_t line, std::string what) {
    return failure(TextError{std::string(file), line, "", std::move(what)});
  };
  while (!text.empty()) {
    ++number_of_line;
    const std::size_t length = std::min(text.find('\n'), text.size());
    ScriptWords words(text.substr(0, length));
    text.remove_prefix(std::min(length + 1, text.size()));
    if (words.empty()) continue;
    try {
      const std::string_view verb = words.word("a command");
      if (verb == "end") {
        if (open.empty()) throw LineError{"end without repeat"};
        std::get<script::Repeat>(script.commands[open.back()].step).end = script.commands.size();
        script.commands.push_back({number_of_line, script::End{open.back()}});
        open.pop_back();
      } else {
        script.commands.push_back({number_of_line, step_of(verb, words)});
        if (verb == "repeat") open.push_back(script.commands.size() - 1);
        if (open.size() > kRepeatDepthMax) throw LineError{"repeat is nested too deeply"};
      }
      words.finish();
    } catch (const LineError& wrong) {
      return error(number_of_line, wrong.what);
    }
  }
  if (!open.empty()) return error(script.commands[open.back()].line, "repeat without end");
  return script;
}

}  // namespace runstone
