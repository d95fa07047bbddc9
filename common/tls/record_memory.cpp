#include "common/tls/record_memory.hpp"

#include <openssl/crypto.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <mutex>

namespace runstone {
namespace {

// Sizes of which a block is used: OpenSSL's buffers of records and of handshakes.
constexpr std::size_t kRecycledMin = 12 * 1024, kBlockBytes = 24 * 1024;
// What is kept at most. A buffer is in use for microseconds, unless a peer sends a record slowly.
constexpr std::size_t kKeptMax = 32;

/// Stands before each allocation.
struct alignas(std::max_align_t) Header {
  std::size_t bytes;  // without the header
};

class Blocks {
 public:
  Header* take() {
    const std::lock_guard lock(mutex_);
    return count_ == 0 ? nullptr : kept_[--count_];
  }
  bool keep(Header* block) {
    const std::lock_guard lock(mutex_);
    if (count_ == kKeptMax) return false;
    kept_[count_++] = block;
    return true;
  }

 private:
  std::mutex mutex_;  // a leaf
  std::array<Header*, kKeptMax> kept_{};
  std::size_t count_ = 0;
};

// Never destroyed, because OpenSSL frees memory when the process ends.
Blocks& blocks() {
  static auto* const all = new Blocks;
  return *all;
}

bool is_recycled(std::size_t bytes) { return bytes >= kRecycledMin && bytes <= kBlockBytes; }

void* allocate(std::size_t bytes, const char* /*file*/, int /*line*/) {
  if (bytes == 0) return nullptr;
  const bool is_block = is_recycled(bytes);
  Header* header = is_block ? blocks().take() : nullptr;
  const std::size_t room = is_block ? kBlockBytes : bytes;
  if (header == nullptr) header = static_cast<Header*>(std::malloc(sizeof(Header) + room));
  if (header == nullptr) return nullptr;
  header->bytes = room;
  return header + 1;
}

void release(void* memory, const char* /*file*/, int /*line*/) {
  if (memory == nullptr) return;
  Header* const header = static_cast<Header*>(memory) - 1;
  if (header->bytes == kBlockBytes && blocks().keep(header)) return;
  std::free(header);
}

void* reallocate(void* memory, std::size_t bytes, const char* file, int line) {
  if (memory == nullptr) return allocate(bytes, file, line);
  void* const moved = allocate(bytes, file, line);
  if (moved == nullptr && bytes != 0) return nullptr;
  const std::size_t before = (static_cast<Header*>(memory) - 1)->bytes;
  if (moved != nullptr) std::memcpy(moved, memory, std::min(before, bytes));
  release(memory, file, line);
  return moved;
}

}  // namespace

void recycle_record_memory() {
  static const int done = CRYPTO_set_mem_functions(allocate, reallocate, release);
  (void)done;
}

}  // namespace runstone
