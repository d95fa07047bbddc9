#include "client/script/script.hpp"

#include <charconv>
#include <cmath>
#include <optional>

#include "protocol/limits.hpp"

namespace runstone {
namespace {

constexpr std::size_t kRepeatDepthMax = 8;

/// An error in a line. It is thrown and caught in this file only.
struct LineError {
  std::string what;
};

class Words {
 public:
  explicit Words(std::string_view line) : line_(line) {
    std::size_t at = 0;
    while (at < line.size()) {
      const std::size_t first = line.find_first_not_of(" \t\r", at);
      if (first == std::string_view::npos || line[first] == '#') break;
      const std::size_t last = std::min(line.find_first_of(" \t\r", first), line.size());
      words_.push_back(line.substr(first, last - first));
      at = last;
    }
  }
  bool more() const { return next_ < words_.size(); }
  bool empty() const { return words_.empty(); }
  /// Returns the next word without taking it, or an empty text if there is none.
  std::string_view peek() const { return more() ? words_[next_] : std::string_view{}; }
  /// Takes the next word. Throws LineError if there is none; `what` says what was expected.
  std::string_view word(const char* what) {
    if (!more()) throw LineError{std::string("expected ") + what};
    return words_[next_++];
  }
  /// Takes the rest of the line after the last word taken, including comments.
  std::string_view rest() {
    const std::size_t first =
        next_ == 0 ? 0
                   : static_cast<std::size_t>(words_[next_ - 1].data() - line_.data()) +
                         words_[next_ - 1].size();
    std::string_view text = line_.substr(first);
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r"), text.size()));
    text = text.substr(0, text.find_last_not_of(" \t\r") + 1);
    next_ = words_.size();
    return text;
  }
  void finish() const {
    if (more()) throw LineError{"unexpected \"" + std::string(words_[next_]) + "\""};
  }

 private:
  std::string_view line_;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
};

template <class T>
std::optional<T> to_number(std::string_view text) {
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>) {
    if (!std::isfinite(value)) return std::nullopt;
  }
  return value;
}

template <class T>
T number(Words& words, const char* what, T low, T high) {
  const std::string_view text = words.word(what);
  const auto value = to_number<T>(text);
  if (!value || *value < low || *value > high) {
    throw LineError{std::string(what) + ": \"" + std::string(text) +
                    "\" is not a number in its range"};
  }
  return *value;
}

ScriptCoordinate coordinate(Words& words, const char* what, bool is_y) {
  std::string_view text = words.word(what);
  ScriptCoordinate out;
  const std::string whole(text);
  if (text.front() == '~' || text.front() == '^') {
    out.base =
        text.front() == '~' ? ScriptCoordinate::Base::player : ScriptCoordinate::Base::surface;
    if (out.base == ScriptCoordinate::Base::surface && !is_y) throw LineError{"^ is for y only"};
    text.remove_prefix(1);
    if (text.empty()) return out;
  }
  const auto value = to_number<double>(text);
  if (!value || std::fabs(*value) > kWorldLimit) {
    throw LineError{std::string(what) + ": \"" + whole + "\" is not a coordinate"};
  }
  out.offset = *value;
  return out;
}

ScriptPosition position(Words& words) {
  const ScriptCoordinate x = coordinate(words, "X", false);
  const ScriptCoordinate y = coordinate(words, "Y", true);
  const ScriptCoordinate z = coordinate(words, "Z", false);
  return {x, y, z};
}

std::string material(Words& words) { return std::string(words.word("MATERIAL")); }

constexpr std::string_view kOnly = "only:";

bool is_mask(std::string_view text) {
  return text == "empty" || text == "solid" || text.starts_with(kOnly);
}

ScriptMask mask(Words& words) {
  if (!words.more()) return {};
  const std::string_view text = words.word("MASK");
  if (text == "empty") return {MaskKind::only_empty, {}};
  if (text == "solid") return {MaskKind::only_solid, {}};
  if (text.starts_with(kOnly) && text.size() > kOnly.size()) {
    return {MaskKind::only_material, std::string(text.substr(kOnly.size()))};
  }
  throw LineError{"MASK: \"" + std::string(text) + "\" is none of empty, solid, only:MATERIAL"};
}

script::Step stroke_step(Words& words) {
  script::Stroke stroke;
  stroke.radius = number<std::uint16_t>(words, "R", 1, kEditRadiusMax);
  stroke.material = material(words);
  while (words.more() && !is_mask(words.peek())) stroke.points.push_back(position(words));
  if (stroke.points.size() < 2) throw LineError{"a stroke needs two positions or more"};
  if (stroke.points.size() > kStrokePointsMax)
    throw LineError{"a stroke has at most 256 positions"};
  stroke.mask = mask(words);
  return stroke;
}

script::Step copy_step(Words& words) {
  script::Copy copy;
  copy.name = words.word("NAME");
  copy.from = position(words);
  copy.to = position(words);
  if (words.peek() == "solid") {
    words.word("solid");
    copy.solid = true;
  }
  return copy;
}

Axis axis(Words& words) {
  const std::string_view text = words.word("AXIS");
  if (text == "x") return Axis::x;
  if (text == "y") return Axis::y;
  if (text == "z") return Axis::z;
  throw LineError{"AXIS: \"" + std::string(text) + "\" is none of x, y, z"};
}

script::Step paste_step(Words& words) {
  script::Paste paste;
  paste.name = words.word("NAME");
  paste.at = position(words);
  for (;;) {
    if (words.peek() == "rotate") {
      words.word("rotate");
      paste.orientation = paste.orientation.rotated_about_y(number<int>(words, "QUARTERS", -3, 3));
    } else if (words.peek() == "mirror") {
      words.word("mirror");
      paste.orientation = paste.orientation.mirrored(axis(words));
    } else {
      break;
    }
  }
  paste.mask = mask(words);
  return paste;
}

script::Step travel_step(Words& words) {
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

script::Step wait_step(Words& words) {
  const std::string_view what = words.word("SECONDS, loaded, durable, synced or chat");
  if (what == "chat") {
    script::WaitChat wait{number<double>(words, "SECONDS", 0, 1e6), {}};
    wait.text = words.rest();
    if (wait.text.empty()) throw LineError{"expected TEXT"};
    return wait;
  }
  std::optional<script::Until> until;
  if (what == "loaded") until = script::Until::loaded;
  if (what == "durable") until = script::Until::durable;
  if (what == "synced") until = script::Until::synced;
  if (until) {
    const double most =
        words.more() ? number<double>(words, "SECONDS", 0, 1e6) : kScriptWaitSecondsMax;
    return script::WaitUntil{*until, most};
  }
  const auto seconds = to_number<double>(what);
  if (!seconds || *seconds < 0) {
    throw LineError{"\"" + std::string(what) +
                    "\" is none of SECONDS, loaded, durable, synced, chat"};
  }
  return script::Wait{*seconds};
}

/// Parses any command except `end`, which needs the lines before it.
script::Step step_of(std::string_view verb, Words& words) {
  if (verb == "move") return script::Move{position(words)};
  if (verb == "walk") {
    script::Walk walk{position(words), 0};
    walk.speed = number<double>(words, "SPEED", 0.001, 1e6);
    return walk;
  }
  if (verb == "roam") {
    script::Roam roam{position(words), 0};
    roam.speed = number<double>(words, "SPEED", 0.001, 1e6);
    return roam;
  }
  if (verb == "look") {
    script::Look look;
    look.yaw = number<double>(words, "YAW", -360, 360);
    look.pitch = number<double>(words, "PITCH", -90, 90);
    return look;
  }
  if (verb == "lookat") return script::LookAt{position(words)};
  if (verb == "set") {
    script::Set set{position(words), {}};
    set.material = material(words);
    return set;
  }
  if (verb == "remove") return script::Set{position(words), "0"};
  if (verb == "box") {
    script::Box box;
    box.from = position(words);
    box.to = position(words);
    box.material = material(words);
    box.mask = mask(words);
    return box;
  }
  if (verb == "sphere") {
    script::Sphere sphere;
    sphere.centre = position(words);
    sphere.radius = number<std::uint16_t>(words, "R", 0, kEditRadiusMax);
    sphere.material = material(words);
    sphere.mask = mask(words);
    return sphere;
  }
  if (verb == "stroke") return stroke_step(words);
  if (verb == "copy") return copy_step(words);
  if (verb == "paste") return paste_step(words);
  if (verb == "dig") return script::Dig{};
  if (verb == "place") return script::Place{material(words)};
  if (verb == "wait") return wait_step(words);
  if (verb == "screenshot") return script::Screenshot{std::string(words.word("FILE"))};
  if (verb == "expect") {
    script::Expect expect{position(words), {}};
    expect.material = material(words);
    return expect;
  }
  if (verb == "repeat")
    return script::Repeat{number<std::uint32_t>(words, "N", 0, 1'000'000'000), 0};
  if (verb == "burst") {
    script::Burst burst;
    burst.count = number<std::uint32_t>(words, "N", 0, 1'000'000'000);
    burst.rate = number<double>(words, "RATE", 0.001, 1e6);
    burst.radius = number<std::int32_t>(words, "RADIUS", 0, 4096);
    burst.seed = number<std::uint64_t>(words, "SEED", 0, UINT64_MAX);
    burst.material = material(words);
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
  if (verb == "quit") return script::Quit{};
  throw LineError{"unknown command \"" + std::string(verb) + "\""};
}

}  // namespace

Result<Script, TextError> parse_script(std::string_view text, std::string_view file) {
  Script script;
  script.file = file;
  std::vector<std::size_t> open;  // indices of repeats that have no end yet
  std::uint32_t number_of_line = 0;
  const auto error = [&](std::uint32_t line, std::string what) {
    return Unexpected<TextError>{TextError{std::string(file), line, "", std::move(what)}};
  };
  while (!text.empty()) {
    ++number_of_line;
    const std::size_t length = std::min(text.find('\n'), text.size());
    Words words(text.substr(0, length));
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
