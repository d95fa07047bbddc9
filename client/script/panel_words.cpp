#include "client/script/panel_words.hpp"

#include <string>

#include "common/core/build_info.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

script::Step map_step(ScriptWords& words) {
  const std::string_view state = words.word("on, full, off or zoom");
  if (state == "zoom") return script::ZoomMap{read_number<double>(words, "PIXELS", 0.01, 100)};
  if (state == "on") return script::ShowMap{true, false};
  if (state == "full") return script::ShowMap{true, true};
  if (state == "off") return script::ShowMap{false, false};
  throw LineError{"\"" + std::string(state) + "\" is none of on, full, off, zoom"};
}

script::Step timeline_step(ScriptWords& words) {
  const std::string_view state = words.word("on or off");
  if (state != "on" && state != "off")
    throw LineError{"\"" + std::string(state) + "\" is none of on, off"};
  return script::ShowTimeline{state == "on"};
}

script::Step rollback_step(ScriptWords& words) {
  using Kind = script::Rollback::Kind;
  const std::string_view verb = words.word("preview, apply, undo or forget");
  if (verb == "apply") return script::Rollback{Kind::apply, {}};
  if (verb == "undo") return script::Rollback{Kind::undo, {}};
  if (verb == "forget") return script::Rollback{Kind::forget, {}};
  if (verb != "preview")
    throw LineError{"\"" + std::string(verb) + "\" is none of preview, apply, undo, forget"};
  constexpr std::size_t kWordsBefore = 32;  // "rollback preview "
  script::Rollback out{Kind::preview, std::string(words.rest())};
  if (out.filters.empty()) throw LineError{"expected FILTERS"};
  if (out.filters.size() + kWordsBefore > kCommandBytesMax)
    throw LineError{"FILTERS have at most 992 bytes"};
  return out;
}

script::Step library_step(ScriptWords& words) {
  const std::string_view verb = words.word("on, off, list, take or add");
  if (verb == "on" || verb == "off") return script::ShowLibrary{verb == "on"};
  if (verb == "take") {
    return script::TakeBuild{read_number<Sequence>(words, "NUMBER", 1, kSequenceMax)};
  }
  if (verb == "add") {
    script::AddBuild out{std::string(words.rest())};
    if (out.name.empty()) throw LineError{"expected NAME"};
    if (out.name.size() > kBuildNameBytesMax) throw LineError{"NAME has at most 64 bytes"};
    return out;
  }
  if (verb != "list")
    throw LineError{"\"" + std::string(verb) + "\" is none of on, off, list, take, add"};
  if (!words.more()) return script::ListBuilds{};
  const std::string_view filter = words.word("name PART");
  if (filter != "name") throw LineError{"\"" + std::string(filter) + "\" is not \"name\""};
  script::ListBuilds out{std::string(words.rest())};
  if (out.name.empty()) throw LineError{"expected PART"};
  if (out.name.size() > kBuildNameBytesMax) throw LineError{"PART has at most 64 bytes"};
  return out;
}

}  // namespace

std::optional<script::Step> panel_step(std::string_view verb, ScriptWords& words) {
  if (verb == "map") return map_step(words);
  if (verb == "timeline") return timeline_step(words);
  if (verb == "rollback") return rollback_step(words);
  if (verb == "library") return library_step(words);
  return std::nullopt;
}

}  // namespace runstone
