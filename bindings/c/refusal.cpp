#include "bindings/c/refusal.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace runstone::c_interface {
namespace {

thread_local std::array<char, 256> words{};

}  // namespace

runstone_status keep_words(runstone_status status, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(words.data(), words.size(), format, arguments);
  va_end(arguments);
  return status;
}

const char* kept_words() { return words.data(); }

void refuse(runstone_status status, const char* name, const char* why) {
  throw RefusedCall{keep_words(status, "%s %s", name, why)};
}

void refuse(const char* name, const Error& error) {
  const auto status = static_cast<runstone_status>(static_cast<int>(error.code) + 1);
  throw RefusedCall{keep_words(status, "%s: %s (at %llu)", name, error.what,
                               static_cast<unsigned long long>(error.offset))};
}

}  // namespace runstone::c_interface
