#include "common/formats/look_material.hpp"

#include <string>
#include <string_view>

#include "common/core/hash.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

/// Returns the FNV-1a hash of a name, mixed.
std::uint64_t look_name_hash(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ULL;
  return mix64(hash);
}

std::string look_material_name(std::string_view name) {
  if (!name.empty() && name.size() <= kMaterialNameBytesMax && is_printable_utf8(name))
    return std::string(name);
  std::string out(name.substr(0, kMaterialNameBytesMax - 17));
  for (char& c : out) {
    if (c < 0x20 || c > 0x7e) c = '?';
  }
  out += '#';
  const std::uint64_t hash = look_name_hash(name);
  for (int shift = 60; shift >= 0; shift -= 4) out += "0123456789abcdef"[hash >> shift & 15];
  return out;
}

}  // namespace

MaterialInfo material_of_look(const ForeignBlock& block, bool) {
  MaterialInfo out;
  if (!block.look && block.name == "air") {
    out.name = "air";
    out.colour = {0, 0, 0, 0};
    out.visibility = Visibility::empty;
    return out;
  }
  if (!block.look) {
    const MaterialTable& known = default_material_table();
    if (const auto id = known.find(block.name)) {
      out = known[*id];
      out.generation = std::nullopt;
      return out;
    }
  }
  out.name = look_material_name(block.name == "air" ? "air (solid)" : block.name);
  if (block.look) {
    out.colour = block.look->colour;
    if (block.look->surface) out.look = nearest_valid_look(*block.look->surface);
  } else {
    const std::uint64_t hash = look_name_hash(block.name);
    for (unsigned i = 0; i < 3; ++i)
      out.colour[i] = static_cast<std::uint8_t>(96 + (hash >> (8 * i)) % 112);
  }
  out.visibility = out.colour[3] == 255 ? Visibility::opaque : Visibility::transparent;
  return out;
}

}  // namespace runstone
