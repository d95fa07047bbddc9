#include "server/store/record_checksum.hpp"

#include <xxhash.h>

namespace runstone {

std::uint64_t record_checksum(const EditRecord& record) {
  return record_checksum(ByteView(encode_record(record)));
}

std::uint64_t record_checksum(ByteView bytes) { return XXH3_64bits(bytes.data(), bytes.size()); }

}  // namespace runstone
