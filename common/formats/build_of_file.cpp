#include "common/formats/build_of_file.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"
#include "common/formats/height_map.hpp"
#include "common/formats/piece_joiner.hpp"

namespace runstone {
namespace {

/// Returns the nearest plain name with at most `bytes_max` bytes, or an empty text if nothing is left.
std::string plain_name(std::string_view text, std::size_t bytes_max) {
  // A name of any length is cut before it is checked, and not inside a character.
  if (text.size() > 4 * bytes_max) text = cut_utf8(text, 4 * bytes_max);
  std::string out(text);
  const bool is_utf8 = is_printable_utf8(text);
  for (char& c : out) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f || (!is_utf8 && byte > 0x7f)) c = '?';
    if (c == '"' || c == '\\') c = '\'';
  }
  out = cut_utf8(with_unseen_replaced(out), bytes_max);
  const std::size_t first = out.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  out = out.substr(first, out.find_last_not_of(' ') - first + 1);
  return is_plain_name(out) ? out : "";
}

/// Returns where the lowest corner of the build is in the world of the file, or 0 if the file says a
/// place that no world has.
VoxelPos build_origin(VoxelPos world, const VoxelBox& box) {
  const auto sum = [](std::int32_t a, std::int32_t low, std::int32_t high, bool& fits) {
    const std::int64_t at = std::int64_t{a} + low;
    fits = fits && at >= -kWorldLimit && at + (std::int64_t{high} - low) <= kWorldLimit;
    return static_cast<std::int32_t>(fits ? at : 0);
  };
  bool fits = true;
  const VoxelPos out{sum(world.x, box.min.x, box.max.x, fits),
                     sum(world.y, box.min.y, box.max.y, fits),
                     sum(world.z, box.min.z, box.max.z, fits)};
  return fits ? out : VoxelPos{};
}

}  // namespace

Result<FileBuild> read_foreign_build(const Format& format, ByteView file,
                                     const ForeignReading& reading) {
  RUNSTONE_ASSERT(format.read != nullptr && format.material_of != nullptr);
  PieceJoiner joiner(format, reading.keep_all, reading.bytes_max, reading.only_cubes);
  const PieceSink sink = [&](ForeignPiece&& piece) { return joiner.add(std::move(piece)); };
  const auto info = reading.colours.empty() ? format.read(file, sink)
                                            : read_height_map(file, reading.colours, {}, sink);
  if (!info) return failure(info.error());
  if (!joiner.has_pieces()) return fail(ErrorCode::bad_value, "file has no voxels");
  const VoxelBox box = joiner.box();
  auto out = joiner.join();
  if (!out) return out;
  BuildInfo& made = out->info;
  made.name = plain_name(info->name, kBuildNameBytesMax);
  if (made.name.empty()) made.name = plain_name(reading.name, kBuildNameBytesMax);
  if (made.name.empty()) made.name = "build";
  made.author = plain_name(info->author, kBuildAuthorBytesMax);
  made.created_us = std::clamp(info->created_us, TimeUs{0}, kBuildTimeMax);
  const VoxelPos sides = out->build->sides();
  made.sides = {static_cast<std::uint32_t>(sides.x), static_cast<std::uint32_t>(sides.y),
                static_cast<std::uint32_t>(sides.z)};
  made.origin = build_origin(info->origin, box);
  RUNSTONE_ASSERT(validate(made).has_value());
  return out;
}

}  // namespace runstone
