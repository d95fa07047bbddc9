#include "client/script/script_words.hpp"

namespace runstone {
namespace {

ScriptCoordinate coordinate(ScriptWords& words, const char* what, bool is_y) {
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

}  // namespace

ScriptPosition read_position(ScriptWords& words) {
  const ScriptCoordinate x = coordinate(words, "X", false);
  const ScriptCoordinate y = coordinate(words, "Y", true);
  const ScriptCoordinate z = coordinate(words, "Z", false);
  return {x, y, z};
}

Axis read_axis(ScriptWords& words) {
  const std::string_view text = words.word("AXIS");
  if (text == "x") return Axis::x;
  if (text == "y") return Axis::y;
  if (text == "z") return Axis::z;
  throw LineError{"AXIS: \"" + std::string(text) + "\" is none of x, y, z"};
}

std::string read_material(ScriptWords& words) { return std::string(words.word("MATERIAL")); }

bool read_on_off(ScriptWords& words) {
  const std::string_view state = words.word("on or off");
  if (state != "on" && state != "off")
    throw LineError{"\"" + std::string(state) + "\" is none of on, off"};
  return state == "on";
}

}  // namespace runstone
