// FileWriting: the choices of how a build becomes a file. A choice counts for its formats only.
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/model_writers/model_writing.hpp"

namespace runstone {

/// The versions of a .schem that are written.
enum class SchemVersion : std::uint8_t { two = 2, three = 3 };

/// Returns the version of a text, which is "2" or "3", or nullopt.
constexpr std::optional<SchemVersion> parse_schem_version(std::string_view text) {
  if (text == "2") return SchemVersion::two;
  if (text == "3") return SchemVersion::three;
  return std::nullopt;
}

struct FileWriting {
  ModelWriting model{};  // of formats of triangles
  SchemVersion schem = SchemVersion::three;
};

}  // namespace runstone
