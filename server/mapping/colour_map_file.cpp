#include "server/mapping/colour_map_file.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/os/private_file.hpp"

namespace runstone {
namespace {

/// More than the pixels of the largest map take.
constexpr std::size_t kColourMapBytesMax = std::size_t{256} << 20;

}  // namespace

Result<void, std::string> add_colour_map(const std::string& file, std::string& bytes,
                                         ForeignReading& reading) {
  if (file.empty()) return {};
  auto read = read_file(file, kColourMapBytesMax, FileKinds::regular);
  if (!read) return failure(read.error());
  if (read->empty()) return failure(file + ": has no bytes");
  bytes = *std::move(read);
  reading.colours = {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
  reading.colours_file = file;
  return {};
}

}  // namespace runstone
