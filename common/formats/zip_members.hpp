// The members of a zip file. Internal to npy. Every byte is untrusted.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"
#include "common/formats/inflate_source.hpp"

namespace runstone {

struct ZipMember {
  std::string_view name;
  bool is_deflated = false;  // otherwise stored
  ByteView packed;
  std::size_t offset = 0;  // of `packed` in the file
  std::uint64_t bytes = 0;
  std::uint32_t checksum = 0;

  InflateSource open() const {
    return {packed, is_deflated ? std::optional(DeflateForm::raw) : std::nullopt};
  }
};

/// Returns the members by the directory at the end of the file. Fails if the directory is not found or
/// bad, if a member is encrypted, has another packing than none and deflate, lies outside the file, or
/// says a size that it cannot have, and if there are more than 1024.
Result<std::vector<ZipMember>> zip_members(ByteView file);

}  // namespace runstone
