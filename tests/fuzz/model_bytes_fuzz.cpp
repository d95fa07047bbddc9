// The target decodes any bytes as a model of a child program. What is decoded is valid and is encoded
// to bytes that decode to the same bytes.
#include <algorithm>
#include <cstdint>
#include <span>

#include "common/core/assert.hpp"
#include "common/models/model_bytes.hpp"

using namespace runstone;

namespace {

Result<ReadModel> decode(ByteView bytes) {
  const auto source = [&bytes](std::span<std::uint8_t> to) {
    if (to.size() > bytes.size()) return false;
    std::copy_n(bytes.begin(), to.size(), to.begin());
    bytes = bytes.subspan(to.size());
    return true;
  };
  return decode_model(source, std::size_t{1} << 20);
}

Bytes encode(const ReadModel& read) {
  Bytes out;
  const bool is_written = encode_model(read, [&out](ByteView bytes) {
    out.insert(out.end(), bytes.begin(), bytes.end());
    return true;
  });
  RUNSTONE_ASSERT(is_written);
  return out;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto read = decode({data, size});
  if (!read) {
    RUNSTONE_ASSERT(read.error().what[0] != '\0');
    return 0;
  }
  RUNSTONE_ASSERT(validate(read->model).has_value());
  const Bytes bytes = encode(*read);
  const auto again = decode(bytes);
  RUNSTONE_ASSERT(again.has_value());
  RUNSTONE_ASSERT(encode(*again) == bytes);
  return 0;
}
