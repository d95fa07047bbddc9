#include "common/formats/vox_look.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <optional>

#include "common/core/text.hpp"

namespace runstone {
namespace {

/// The rows of the palette on the screen, of 8 colours each. The first note is that of the last row.
constexpr std::size_t kVoxRows = 32, kVoxRowColours = 8;
/// Names and states of a build are shorter. Each piece has a copy of them.
constexpr std::size_t kVoxTextBytesMax = 1024;
/// A note that is longer is cut, so that a name has room for the rest.
constexpr std::size_t kVoxNoteBytesMax = 28;

std::uint8_t percent_of(double share) {
  return static_cast<std::uint8_t>(std::lround(std::min(std::max(share, 0.0), 1.0) * 100));
}

std::optional<MaterialLook> vox_look_of_text(std::string_view text) {
  std::array<std::uint8_t, 5> numbers{};
  for (std::uint8_t& number : numbers) {
    if (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc{}) return std::nullopt;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
  return nearest_valid_look(
      {numbers[0], numbers[1], numbers[2], numbers[3], static_cast<MaterialPattern>(numbers[4])});
}

std::string_view note_of(const VoxFile& file, std::size_t colour) {
  const std::size_t row = (file.shown_at[colour] + kVoxColours - 1) % kVoxColours / kVoxRowColours;
  if (file.notes.size() < kVoxRows) return {};
  const std::string_view note = file.notes[kVoxRows - 1 - row];
  return is_printable_utf8(note) ? cut_utf8(note, kVoxNoteBytesMax) : std::string_view();
}

/// Returns the look of a colour with its entry of MATL. Of materials, those that are see-through, that
/// shine and that give light are known.
ForeignLook vox_look(const VoxFile& file, std::size_t colour) {
  const VoxMaterial& material = file.materials[colour];
  ForeignLook out{file.palette[colour]};
  std::uint8_t& alpha = out.colour[3];
  // Many programs write 0, which MagicaVoxel ignores.
  if (alpha == 0) alpha = 255;
  const bool is_glass = material.type == "_glass" || material.type == "_blend";
  if (is_glass && alpha == 255) {
    const double share = material.trans >= 0 ? material.trans : material.weight;
    const double opaque = share >= 0 ? 1 - std::min(share, 1.0) : 0.5;
    alpha = static_cast<std::uint8_t>(std::min(254L, std::max(1L, std::lround(opaque * 255))));
  }
  const bool is_light = material.type == "_emit";
  const bool is_metal = material.type == "_metal";
  if (!is_glass && !is_light && !is_metal) return out;
  MaterialLook surface;
  if (!is_light && material.rough >= 0) surface.roughness = percent_of(material.rough);
  if (is_light) surface.emission = percent_of(material.emit >= 0 ? material.emit : material.weight);
  out.surface = surface;
  return out;
}

}  // namespace

std::string vox_colour_text(const MaterialColour& colour) {
  constexpr std::string_view kHexDigits = "0123456789abcdef";
  std::string out = "#";
  for (const std::uint8_t part : colour) {
    if (out.size() == 7 && part == 255) break;
    out += kHexDigits[part >> 4];
    out += kHexDigits[part & 15];
  }
  return out;
}

std::string vox_look_text(const MaterialLook& look) {
  std::string out;
  for (const unsigned number :
       {unsigned{look.variation}, unsigned{look.grain}, unsigned{look.roughness},
        unsigned{look.emission}, static_cast<unsigned>(look.pattern)}) {
    if (!out.empty()) out += ' ';
    out += std::to_string(number);
  }
  return out;
}

std::vector<ForeignBlock> vox_blocks(const VoxFile& file) {
  std::vector<ForeignBlock> out;
  for (std::size_t colour = 1; colour < kVoxColours; ++colour) {
    const VoxMaterial& material = file.materials[colour];
    ForeignBlock block;
    if (material.has_name) {
      block.name = material.name.substr(0, kVoxTextBytesMax);
      block.states = material.states.substr(0, kVoxTextBytesMax);
      block.look = ForeignLook{file.palette[colour], vox_look_of_text(material.look)};
    } else {
      block.look = vox_look(file, colour);
      const std::string_view note = note_of(file, colour);
      block.name =
          std::string(note.empty() ? "colour" : note) + " " + vox_colour_text(block.look->colour);
      if (const auto& surface = block.look->surface) {
        if (surface->roughness != MaterialLook{}.roughness)
          block.name += " rough " + std::to_string(surface->roughness);
        if (surface->emission != 0) block.name += " light " + std::to_string(surface->emission);
      }
    }
    out.push_back(std::move(block));
  }
  return out;
}

}  // namespace runstone
