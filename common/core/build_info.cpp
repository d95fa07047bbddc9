#include "common/core/build_info.hpp"

#include <algorithm>
#include <functional>
#include <string_view>
#include <utility>

#include "common/core/assert.hpp"
#include "common/core/text.hpp"

namespace runstone {
namespace {

void write_build_text(ByteWriter& w, std::string_view text) {
  w.varint(text.size());
  w.bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string read_build_text(ByteReader& r, std::size_t bytes_max, const char* what) {
  const ByteView text = r.bytes(static_cast<std::size_t>(r.varint_max(bytes_max, what)));
  return {text.begin(), text.end()};
}

bool is_build_side(std::uint32_t side) { return side >= 1 && side <= kBuildSideMax; }

Result<void> check_build_sides(const BuildSides& sides) {
  if (!is_build_side(sides.x) || !is_build_side(sides.y) || !is_build_side(sides.z))
    return fail(ErrorCode::limit_exceeded, "side of the build is outside 1 .. 1048576");
  return {};
}

bool is_build_name(std::string_view text, std::size_t bytes_max) {
  return text.size() <= bytes_max && is_plain_name(text);
}

}  // namespace

Result<void> validate(const BuildInfo& info) {
  if (!is_build_name(info.name, kBuildNameBytesMax))
    return fail(ErrorCode::bad_value, "name of the build must be a plain name of 1 .. 64 bytes");
  if (!info.author.empty() && !is_build_name(info.author, kBuildAuthorBytesMax))
    return fail(ErrorCode::bad_value, "author must be a plain name of at most 32 bytes, or empty");
  if (info.tags.size() > kBuildTagsMax)
    return fail(ErrorCode::limit_exceeded, "build has more than 16 tags");
  for (const std::string& tag : info.tags) {
    if (!is_build_name(tag, kBuildTagBytesMax))
      return fail(ErrorCode::bad_value, "tag must be a plain name of 1 .. 32 bytes");
  }
  if (std::adjacent_find(info.tags.begin(), info.tags.end(), std::greater_equal<>{}) !=
      info.tags.end())
    return fail(ErrorCode::not_canonical, "tags do not ascend");
  if (info.created_us < 0 || info.created_us > kBuildTimeMax)
    return fail(ErrorCode::bad_value, "time of the build is outside 0 .. 2^53");
  if (auto sides = check_build_sides(info.sides); !sides) return sides;
  // The limit of the world is below 2^31 - 2^20, so the sum fits.
  const auto fits = [](std::int32_t at, std::uint32_t side) {
    return at >= -kWorldLimit && at <= kWorldLimit - static_cast<std::int32_t>(side);
  };
  if (!fits(info.origin.x, info.sides.x) || !fits(info.origin.y, info.sides.y) ||
      !fits(info.origin.z, info.sides.z))
    return fail(ErrorCode::bad_value, "build reaches out of the world");
  return {};
}

void write_build_info(ByteWriter& w, const BuildInfo& info) {
  RUNSTONE_ASSERT(validate(info).has_value());
  for (const std::uint32_t side : {info.sides.x, info.sides.y, info.sides.z}) w.varint(side - 1);
  for (const std::int32_t at : {info.origin.x, info.origin.y, info.origin.z}) w.svarint(at);
  w.varint(static_cast<std::uint64_t>(info.created_us));
  write_build_text(w, info.name);
  write_build_text(w, info.author);
  w.varint(info.tags.size());
  for (const std::string& tag : info.tags) write_build_text(w, tag);
}

BuildInfo read_build_info(ByteReader& r) {
  BuildInfo info;
  for (std::uint32_t* side : {&info.sides.x, &info.sides.y, &info.sides.z}) {
    *side = 1 + static_cast<std::uint32_t>(
                    r.varint_max(kBuildSideMax - 1, "side of the build is outside 1 .. 1048576"));
  }
  for (std::int32_t* at : {&info.origin.x, &info.origin.y, &info.origin.z}) {
    *at = static_cast<std::int32_t>(
        r.svarint_in(-kWorldLimit, kWorldLimit - 1, "origin lies outside the world"));
  }
  info.created_us =
      static_cast<TimeUs>(r.varint_max(kBuildTimeMax, "time of the build is outside 0 .. 2^53"));
  info.name = read_build_text(r, kBuildNameBytesMax, "name of the build is too long");
  info.author = read_build_text(r, kBuildAuthorBytesMax, "author of the build is too long");
  const std::uint64_t tags = r.varint_max(kBuildTagsMax, "build has more than 16 tags");
  for (std::uint64_t i = 0; i < tags && r.ok(); ++i)
    info.tags.push_back(read_build_text(r, kBuildTagBytesMax, "tag is too long"));
  if (!r.ok()) return info;
  if (const auto sound = validate(info); !sound) r.reject(sound.error().code, sound.error().what);
  return info;
}

}  // namespace runstone
