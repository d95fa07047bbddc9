// The random numbers of libsodium in the WebAssembly of @runstone/core. They are those of the
// page's crypto.getRandomValues(), which getentropy() calls. Without random numbers no key is safe,
// so the program ends if there are none.
#include <sodium/randombytes.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

extern "C" {

void randombytes_buf(void* const to, const std::size_t bytes) {
  constexpr std::size_t kEntropyBytesMax = 256;  // of one call
  auto* at = static_cast<unsigned char*>(to);
  for (std::size_t left = bytes; left != 0;) {
    const std::size_t next = std::min(left, kEntropyBytesMax);
    if (getentropy(at, next) != 0) std::abort();
    at += next;
    left -= next;
  }
}

void randombytes(unsigned char* const to, const unsigned long long bytes) {
  randombytes_buf(to, static_cast<std::size_t>(bytes));
}

uint32_t randombytes_random() {
  uint32_t out = 0;
  randombytes_buf(&out, sizeof out);
  return out;
}

uint32_t randombytes_uniform(const uint32_t upper_bound) {
  if (upper_bound < 2) return 0;
  // Numbers below 2^32 mod upper_bound would make the first results more frequent.
  const uint32_t first = (0U - upper_bound) % upper_bound;
  uint32_t out = randombytes_random();
  while (out < first) out = randombytes_random();
  return out % upper_bound;
}

void randombytes_stir() {}
int randombytes_close() { return 0; }

}  // extern "C"
