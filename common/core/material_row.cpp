#include "common/core/material_row.hpp"

#include "common/core/text.hpp"

namespace runstone {

Result<void> validate_material(std::string_view name, const MaterialColour& colour,
                               Visibility visibility, MaterialBody body,
                               const std::optional<MaterialLook>& look) {
  if (name.empty() || name.size() > kMaterialNameBytesMax || !is_printable_utf8(name)) {
    return fail(ErrorCode::bad_value,
                "name must be 1 .. 64 bytes of UTF-8 without control characters");
  }
  if (visibility == Visibility::opaque && colour[3] != 255)
    return fail(ErrorCode::bad_value, "colour of an opaque material must not be see-through");
  if (body > MaterialBody::passable || (visibility == Visibility::empty && body != MaterialBody{}))
    return fail(ErrorCode::bad_value, "body is unknown, or the material is empty and has one");
  return look ? validate_look(*look) : Result<void>{};
}

}  // namespace runstone
