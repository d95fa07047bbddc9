#include "protocol/codec/brush_stroke.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string_view>

#include "common/core/text.hpp"
#include "protocol/limits.hpp"

namespace runstone {
namespace {

/// The mode of a terrain brush that smooths reads further, and the one that erodes works in rounds.
constexpr std::uint8_t kSmoothMode = 2, kErodeMode = 3;

/// Returns the difference of two places along each axis.
std::array<std::int64_t, 3> step_between(const VoxelPos& a, const VoxelPos& b) {
  return {std::abs(std::int64_t{b.x} - a.x), std::abs(std::int64_t{b.y} - a.y),
          std::abs(std::int64_t{b.z} - a.z)};
}

bool is_stroke_place(const VoxelPos& at) {
  const auto is_in = [](std::int32_t v) { return v >= -kWorldLimit && v < kWorldLimit; };
  return is_in(at.x) && is_in(at.y) && is_in(at.z);
}

bool is_stroke_text(std::string_view text) {
  return text.size() <= kBrushTextBytesMax && (text.empty() || is_printable_utf8(text));
}

/// Checks all but the number of bytes.
Result<void> check_values(const BrushStroke& s) {
  const auto wrong = [](const char* what) { return fail(ErrorCode::bad_value, what); };
  const bool is_path = s.brush == BrushKind::path;
  if (static_cast<std::uint8_t>(s.brush) > kBrushKindMax) return wrong("stroke: unknown brush");
  if (s.mode > (is_path ? kPathModeMax : kTerrainModeMax)) return wrong("stroke: unknown mode");
  if (s.size == 0 || s.size > (is_path ? kPathSizeMax : kTerrainSizeMax))
    return wrong("stroke: a brush of this size does not exist");
  if (s.falloff > kFalloffMax) return wrong("stroke: unknown falloff");
  if (s.strength == 0 || s.strength > kTerrainStrengthMax)
    return wrong("stroke: a strength out of range");
  if (s.seed > kBrushSeedMax) return wrong("stroke: a seed out of range");
  if (is_path && (s.falloff != 0 || s.strength != 1 || s.lowers || s.seed != 1))
    return wrong("stroke: a path with settings of a terrain brush");
  if (static_cast<std::uint8_t>(s.mask.kind) > static_cast<std::uint8_t>(MaskKind::only_material))
    return wrong("stroke: unknown mask");
  if (s.mask.kind != MaskKind::only_material && s.mask.material != kEmpty)
    return wrong("stroke: a mask with a material that it does not use");
  if (!is_stroke_text(s.where)) return wrong("stroke: the filter is too long or not printable");
  if (!is_stroke_text(s.mix)) return wrong("stroke: the mix is too long or not printable");
  if (s.places.empty()) return wrong("stroke: no place");
  if (s.places.size() > kPreviewStrokePlacesMax) return wrong("stroke: too many places");
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    if (!is_stroke_place(s.places[i])) return wrong("stroke: a place outside of the world");
    if (i == 0) continue;
    const auto step = step_between(s.places[i - 1], s.places[i]);
    if (*std::max_element(step.begin(), step.end()) > kStrokeStepMax)
      return wrong("stroke: two places too far apart");
  }
  if (stroke_work(s) > kPreviewStrokeWorkMax) return wrong("stroke: too much work for a preview");
  return {};
}

Bytes bytes_of_stroke(const BrushStroke& s) {
  Bytes bytes;
  ByteWriter out(bytes);
  out.u8(static_cast<std::uint8_t>(s.brush));
  out.u8(s.mode);
  out.varint(s.size);
  if (s.brush == BrushKind::terrain) {
    out.u8(s.falloff);
    out.varint(s.strength);
    out.u8(s.lowers ? 1 : 0);
    out.varint(s.seed);
  }
  out.varint(s.material);
  out.u8(static_cast<std::uint8_t>(s.mask.kind));
  if (s.mask.kind == MaskKind::only_material) out.varint(s.mask.material);
  for (const std::string* const text : {&s.where, &s.mix}) {
    out.varint(text->size());
    out.bytes({reinterpret_cast<const std::uint8_t*>(text->data()), text->size()});
  }
  VoxelPos before{};
  for (const VoxelPos& at : s.places) {
    out.svarint(std::int64_t{at.x} - before.x);
    out.svarint(std::int64_t{at.y} - before.y);
    out.svarint(std::int64_t{at.z} - before.z);
    before = at;
  }
  return bytes;
}

}  // namespace

std::uint64_t stroke_work(const BrushStroke& s) {
  const bool is_path = s.brush == BrushKind::path;
  const bool smooths = !is_path && s.mode == kSmoothMode;
  const std::int64_t margin = is_path ? s.size : s.size + 1 + (smooths ? 2 * s.strength : 0);
  VoxelBox box{s.places.front(), s.places.front()};
  std::int64_t steps = 0, between = 0;
  for (std::size_t i = 0; i < s.places.size(); ++i) {
    const VoxelPos& at = s.places[i];
    box.min.x = std::min(box.min.x, at.x);
    box.min.z = std::min(box.min.z, at.z);
    box.max.x = std::max(box.max.x, at.x);
    box.max.z = std::max(box.max.z, at.z);
    if (i == 0) continue;
    const auto [x, y, z] = step_between(s.places[i - 1], at);
    steps += x + y + z;
    between += x * z;
  }
  const std::int64_t columns = (std::int64_t{box.max.x} - box.min.x + 2 * margin + 1) *
                               (std::int64_t{box.max.z} - box.min.z + 2 * margin + 1);
  const std::int64_t rounds = !is_path && s.mode == kErodeMode ? s.strength : 1;
  // A path has two points of its curve for a step of one voxel, and sets a square around each. A
  // terrain brush measures the box around each segment.
  const std::int64_t side = is_path ? s.size + 1 : 2 * s.size + 1;
  const std::int64_t passed =
      is_path ? (2 * steps + 1) * side * side
              : static_cast<std::int64_t>(s.places.size()) * side * side + steps * side + between;
  // Reading a column costs as much as some ten measurements.
  return static_cast<std::uint64_t>(columns * rounds * 10 + passed);
}

Result<void> check_stroke(const BrushStroke& stroke) {
  if (const auto ok = check_values(stroke); !ok) return ok;
  if (bytes_of_stroke(stroke).size() > kPreviewStrokeBytesMax)
    return fail(ErrorCode::limit_exceeded, "stroke: too many bytes");
  return {};
}

Bytes encode_stroke(const BrushStroke& stroke) { return bytes_of_stroke(stroke); }

Result<BrushStroke> decode_stroke(ByteView bytes) {
  if (bytes.size() > kPreviewStrokeBytesMax)
    return fail(ErrorCode::limit_exceeded, "stroke: too many bytes");
  ByteReader in(bytes);
  BrushStroke s;
  const std::uint8_t brush = in.u8();
  if (in.ok() && brush > kBrushKindMax) in.reject(ErrorCode::bad_value, "stroke: unknown brush");
  s.brush = static_cast<BrushKind>(std::min(brush, kBrushKindMax));
  s.mode = in.u8();
  s.size = static_cast<std::uint16_t>(in.varint_max(UINT16_MAX, "stroke: a size out of range"));
  if (s.brush == BrushKind::terrain) {
    s.falloff = in.u8();
    s.strength =
        static_cast<std::uint16_t>(in.varint_max(UINT16_MAX, "stroke: a strength out of range"));
    const std::uint8_t lowers = in.u8();
    if (in.ok() && lowers > 1) in.reject(ErrorCode::bad_value, "stroke: unknown direction");
    s.lowers = lowers == 1;
    s.seed =
        static_cast<std::uint32_t>(in.varint_max(kBrushSeedMax, "stroke: a seed out of range"));
  }
  s.material = static_cast<Material>(in.varint_max(UINT16_MAX, "stroke: a material out of range"));
  s.mask.kind = static_cast<MaskKind>(in.u8());
  if (s.mask.kind == MaskKind::only_material)
    s.mask.material =
        static_cast<Material>(in.varint_max(UINT16_MAX, "stroke: a material out of range"));
  for (std::string* const text : {&s.where, &s.mix}) {
    const auto length = in.varint_max(kBrushTextBytesMax, "stroke: a text is too long");
    const ByteView view = in.bytes(static_cast<std::size_t>(length));
    text->assign(reinterpret_cast<const char*>(view.data()), view.size());
  }
  VoxelPos at{};
  while (in.ok() && !in.at_end()) {
    if (s.places.size() == kPreviewStrokePlacesMax)
      return fail(ErrorCode::bad_value, "stroke: too many places");
    const auto next = [&](std::int32_t from) {
      const std::int64_t low = std::int64_t{-kWorldLimit} - from;
      return static_cast<std::int32_t>(from +
                                       in.svarint_in(low, low + 2 * std::int64_t{kWorldLimit} - 1,
                                                     "stroke: a place outside of the world"));
    };
    at.x = next(at.x);
    at.y = next(at.y);
    at.z = next(at.z);
    s.places.push_back(at);
  }
  if (const auto ok = in.finish(); !ok) return failure(ok.error());
  if (const auto ok = check_values(s); !ok) return failure(ok.error());
  return s;
}

}  // namespace runstone
