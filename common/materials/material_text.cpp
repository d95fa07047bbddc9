// Writes the text form of a material table.
#include <charconv>
#include <string>

#include "common/core/assert.hpp"
#include "common/materials/material_names.hpp"
#include "common/materials/material_table.hpp"

namespace runstone {
namespace {

std::string toml_string(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// Returns the shortest decimal that reads back to the same double, always in a form that TOML
/// reads as a float.
std::string decimal(double value) {
  char buffer[32];
  const auto [end, status] = std::to_chars(buffer, buffer + sizeof buffer, value);
  RUNSTONE_ASSERT(status == std::errc{});
  std::string out(buffer, end);
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

std::string surface_text(const SurfaceRule& rule) {
  return "{ seed = " + std::to_string(rule.seed) + ", elevation = " + decimal(rule.elevation) +
         ", distance = " + decimal(rule.distance) + ", frequency = " + decimal(rule.frequency) +
         " }";
}

std::string colour_text(const std::array<std::uint8_t, 4>& colour) {
  constexpr char kHex[] = "0123456789abcdef";
  std::string out = "#";
  const std::size_t count = colour[3] == 255 ? 3 : 4;
  for (std::size_t i = 0; i < count; ++i) {
    out += kHex[colour[i] >> 4];
    out += kHex[colour[i] & 15];
  }
  return out;
}

/// Leaves out what has the value of MaterialLook{}, so that a table of many looks stays short.
std::string look_text(const MaterialLook& look) {
  const MaterialLook usual;
  std::string keys;
  const auto add = [&](const char* key, const std::string& value) {
    keys.append(keys.empty() ? " " : ", ").append(key).append(" = ").append(value);
  };
  const auto share = [&](const char* key, std::uint8_t value, std::uint8_t usual_value) {
    if (value != usual_value) add(key, std::to_string(value));
  };
  share("variation", look.variation, usual.variation);
  share("grain", look.grain, usual.grain);
  share("roughness", look.roughness, usual.roughness);
  share("emission", look.emission, usual.emission);
  if (look.pattern != usual.pattern)
    add("pattern", toml_string(kPatternNames[static_cast<std::size_t>(look.pattern)]));
  return keys.empty() ? "{}" : "{" + keys + " }";
}

std::string shape_text(const Shape& shape) {
  std::string out = shape.form == ShapeForm::crossed ? "crossed = [" : "shape = [";
  const char* between = "";
  for (const ShapeBox& box : shape.boxes) {
    out += between;
    between = ", ";
    char open = '[';
    for (const auto& corner : {box.min, box.max}) {
      for (const std::uint8_t place : corner) {
        out += open;
        out += std::to_string(place);
        open = ',';
      }
    }
    out += ']';
  }
  return out + "]\n";
}

}  // namespace

std::string to_toml(const MaterialTable& table) {
  std::string out;
  for (const MaterialInfo& row : table.rows()) {
    if (!out.empty()) out += '\n';
    out += "[[material]]\nname = " + toml_string(row.name) + "\n";
    out += "colour = " + toml_string(colour_text(row.colour)) + "\n";
    out += std::string("visibility = \"") +
           kVisibilityNames[static_cast<std::size_t>(row.visibility)] + "\"\n";
    if (row.body != MaterialBody::solid)
      out += std::string("body = \"") + kBodyNames[static_cast<std::size_t>(row.body)] + "\"\n";
    if (row.look) out += "look = " + look_text(*row.look) + "\n";
    if (!row.shape.is_cube()) out += shape_text(row.shape);
    if (!row.generation) continue;
    out += "[material.generate]\nsurface = " + surface_text(row.generation->surface) + "\n";
    if (row.generation->reversed)
      out += "reversed = " + surface_text(*row.generation->reversed) + "\n";
  }
  return out;
}

}  // namespace runstone
