#include "bindings/c/refusal.hpp"

#include <array>
#include <cstdarg>
#include <cstdio>

namespace runstone::c_interface {
namespace {

thread_local std::array<char, 256> words{};

/// Removes the last character of full words unless it is one byte, because it may lack its end.
void cut_last_character() {
  std::size_t end = words.size() - 1;
  const auto is_ascii = [&] { return static_cast<unsigned char>(words[end - 1]) < 0x80; };
  if (is_ascii()) return;
  while (end > 1 && (static_cast<unsigned char>(words[end - 1]) & 0xc0) == 0x80) --end;
  if (!is_ascii()) --end;  // the first byte of the character
  words[end] = '\0';
}

}  // namespace

runstone_status keep_words(runstone_status status, const char* format, ...) {
  va_list arguments;
  va_start(arguments, format);
  const int bytes = std::vsnprintf(words.data(), words.size(), format, arguments);
  va_end(arguments);
  if (bytes >= static_cast<int>(words.size())) cut_last_character();
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
