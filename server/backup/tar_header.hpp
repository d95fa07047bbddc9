// The headers of a tar file in the format ustar of POSIX.1-1988. A pack of a world is such a file,
// so that other programs can read it.
// Threads: any.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/bytes.hpp"
#include "common/core/result.hpp"

namespace runstone {

/// A header is one such block, and the bytes of a file are filled up to whole ones with zeros.
inline constexpr std::size_t kTarBlockBytes = 512;
using TarHeader = std::array<std::uint8_t, kTarBlockBytes>;

struct TarEntry {
  std::string name;  // without a folder, at most 100 bytes
  std::uint64_t bytes = 0;
  std::uint64_t time_s = 0;  // since 1970
  friend bool operator==(const TarEntry&, const TarEntry&) = default;
};

/// Returns the bytes that fill a file of `bytes` bytes up to whole blocks, 0 .. 511.
constexpr std::size_t tar_padding(std::uint64_t bytes) {
  return static_cast<std::size_t>((kTarBlockBytes - bytes % kTarBlockBytes) % kTarBlockBytes);
}

/// Returns the header of a regular file that only its owner may read. A size of 8 GiB or more is
/// written in binary, as GNU tar and others do. Fails if the name is longer than 100 bytes.
Result<TarHeader, std::string> tar_header(const TarEntry& entry);

/// Parses the header of a regular file. Returns nullopt for a block of zeros, which ends a tar
/// file. Fails on a wrong checksum and on every other kind of entry. The error is a part of a
/// sentence.
Result<std::optional<TarEntry>, std::string> parse_tar_header(const TarHeader& header);

}  // namespace runstone
