// MaterialRow: what everybody sees of a material: its row in the material table, without the rule
// by which generators use it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/material_look.hpp"
#include "common/core/result.hpp"
#include "common/core/shape.hpp"
#include "common/core/visibility.hpp"

namespace runstone {

/// sRGB and alpha. Alpha is below 255 only for materials that are not opaque.
using MaterialColour = std::array<std::uint8_t, 4>;

/// The effect of a material on the body of a player. Values are frozen: tables, records and
/// messages hold them. A material that is empty lets every body pass, and its value is `solid`.
enum class MaterialBody : std::uint8_t {
  solid = 0,     // stops it
  liquid = 1,    // it swims
  passable = 2,  // it passes
};

struct MaterialRow {
  std::string name;  // unique in a table; 1 .. 64 bytes of UTF-8 without control characters
  MaterialColour colour{0, 0, 0, 255};
  Visibility visibility = Visibility::opaque;
  MaterialBody body = MaterialBody::solid;
  std::optional<MaterialLook> look = std::nullopt;  // if none is given, readers take default_look()
  Shape shape = {};                                 // a cube in a material that is empty
  friend bool operator==(const MaterialRow&, const MaterialRow&) = default;
};

inline constexpr std::size_t kMaterialNameBytesMax = 64;

/// Fails (bad_value) for a bad name, for an opaque material with alpha below 255, for a body that
/// is unknown or that an empty material has, and for a bad look (validate_look()). A shape is
/// checked apart (validate_shape()).
Result<void> validate_material(std::string_view name, const MaterialColour& colour,
                               Visibility visibility, MaterialBody body,
                               const std::optional<MaterialLook>& look);

}  // namespace runstone
