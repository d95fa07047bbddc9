#include "server/store/record_checksum.hpp"

#include <xxhash.h>

namespace runstone {

std::uint64_t record_checksum(const EditRecord& record) {
  const Bytes bytes = encode_record(record);
  return XXH3_64bits(bytes.data(), bytes.size());
}

}  // namespace runstone
