#include "server/web/web_log.hpp"

#include <atomic>
#include <cstdio>
#include <string>

namespace runstone {
namespace {

std::atomic<std::uint64_t> dropped_lines = 0;

}  // namespace

void log_web_line(std::string_view line) {
  std::string text = "runstone-web: ";
  text += line;
  text += '\n';
  // Standard error has no buffer, so the result is that of the system.
  if (std::fwrite(text.data(), 1, text.size(), stderr) == text.size()) return;
  ++dropped_lines;
  std::clearerr(stderr);
}

std::uint64_t dropped_web_lines() { return dropped_lines; }

}  // namespace runstone
