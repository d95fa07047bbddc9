// Visibility: how the faces of a material are drawn and what they hide.
#pragma once
#include <cstdint>

namespace runstone {

/// Values are frozen: material tables store them.
///   - empty: never drawn and hides nothing;
///   - opaque: drawn, and hides the faces behind it;
///   - transparent: drawn in the blended pass. Two equal transparent materials hide the faces
///     between them; two different ones do not.
enum class Visibility : std::uint8_t { empty = 0, opaque = 1, transparent = 2 };

}  // namespace runstone
