// Fields of the wire schema and the checks that messages share. Internal to the message decoder.
// The FlatBuffers verifier has found each field inside the buffer. Each take_ function copies one
// and returns true if its value is valid.
#pragma once
#include <flatbuffers/flatbuffers.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/text.hpp"
#include "protocol/codec/messages.hpp"
#include "protocol/schema/runstone_generated.h"

namespace runstone {

using ByteField = flatbuffers::Vector<std::uint8_t>;

inline ByteView view_of(const ByteField* from) {
  return from == nullptr ? ByteView{} : ByteView(from->data(), from->size());
}

/// Requires exactly N bytes.
template <std::size_t N>
bool take_exact(const ByteField* from, std::array<std::uint8_t, N>& to) {
  if (from == nullptr || from->size() != N) return false;
  std::copy(from->begin(), from->end(), to.begin());
  return true;
}

/// Requires printable UTF-8 of bytes_min .. bytes_max bytes. An absent text counts as empty.
inline bool take_text(const flatbuffers::String* from, std::size_t bytes_min, std::size_t bytes_max,
                      std::string& to) {
  if (from == nullptr) return bytes_min == 0;
  if (from->size() < bytes_min || from->size() > bytes_max) return false;
  to.assign(from->c_str(), from->size());
  return is_printable_utf8(to);
}

/// Requires a chunk with a voxel inside the world, so that the positions of its voxels fit i32.
inline bool take_coord(std::int32_t x, std::int32_t y, std::int32_t z, std::int32_t edge,
                       ChunkCoord& to) {
  to = {x, y, z};
  const std::int32_t reach = kWorldLimit / edge;
  const auto inside = [reach](std::int32_t c) { return c >= -reach && c < reach; };
  return inside(x) && inside(y) && inside(z);
}

inline bool take_position(const wire::Position* from, WorldPos& to) {
  if (from == nullptr) return false;
  to = {from->x(), from->y(), from->z()};
  // Written so that a NaN is outside.
  const auto inside = [](double c) { return std::fabs(c) <= kWorldLimit; };
  return inside(to.x) && inside(to.y) && inside(to.z);
}

inline bool take_pose(const wire::Pose* from, Pose& to) {
  if (from == nullptr || !take_position(&from->at(), to.at)) return false;
  to.yaw = from->yaw();
  to.pitch = from->pitch();
  return true;
}

/// Reads a MaterialRow or MaterialInfo. MaterialTable checks the rest. A look is never a reason to
/// refuse a row: it is taken for the nearest valid one.
template <class Row>
bool take_material(const wire::MaterialRow& row, Row& info) {
  if (!take_text(row.name(), 1, kMaterialNameBytesMax, info.name)) return false;
  for (unsigned c = 0; c < 4; ++c)
    info.colour[c] = static_cast<std::uint8_t>(row.rgba() >> (8 * c));
  if (row.visibility() > static_cast<std::uint8_t>(Visibility::transparent)) return false;
  info.visibility = static_cast<Visibility>(row.visibility());
  if (row.body() > static_cast<std::uint8_t>(MaterialBody::passable)) return false;
  info.body = static_cast<MaterialBody>(row.body());
  if (const wire::MaterialLook* look = row.look()) {
    info.look =
        nearest_valid_look({look->variation(), look->grain(), look->roughness(), look->emission(),
                            static_cast<MaterialPattern>(look->pattern())});
  }
  return true;
}

/// Returns the number of entries of a vector that may be absent, or nullopt if it exceeds
/// `count_max`.
template <class Vector>
std::optional<std::uint32_t> count_of(const Vector* vector, std::size_t count_max) {
  const std::uint32_t count = vector == nullptr ? 0 : vector->size();
  return count <= count_max ? std::optional(count) : std::nullopt;
}

}  // namespace runstone
