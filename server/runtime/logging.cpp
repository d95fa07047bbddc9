#include "server/runtime/logging.hpp"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>

#include <atomic>
#include <cstdio>

#include "common/core/assert.hpp"
#include "server/runtime/log_formatter.hpp"

namespace runstone {
namespace {

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::debug:
      return spdlog::level::debug;
    case LogLevel::info:
      return spdlog::level::info;
    case LogLevel::warn:
      return spdlog::level::warn;
    case LogLevel::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::atomic<std::uint64_t> unwritten_lines = 0;

/// Writes lines to stderr, and counts those that could not be written: a pipe may have lost its
/// reader, a disk may be full.
class CountingSink : public spdlog::sinks::stderr_color_sink_mt {
 public:
  void log(const spdlog::details::log_msg& line) override {
    spdlog::sinks::stderr_color_sink_mt::log(line);
    if (std::ferror(stderr) == 0) return;
    ++unwritten_lines;
    std::clearerr(stderr);
  }
};

}  // namespace

void start_logging(LogLevel level, LogFormat format) {
  // Logging must not delay the world strand: lines wait in a bounded queue. If the reader of stderr
  // is too slow, the oldest lines are dropped.
  constexpr std::size_t kQueuedLinesMax = 8192;
  if (spdlog::thread_pool() == nullptr) spdlog::init_thread_pool(kQueuedLinesMax, 1);
  const auto sink = std::make_shared<CountingSink>();
  for (const char* module : {"world", "net", "store", "app"}) {
    auto found = spdlog::get(module);
    if (found == nullptr) {
      found = std::make_shared<spdlog::async_logger>(module, sink, spdlog::thread_pool(),
                                                     spdlog::async_overflow_policy::overrun_oldest);
      spdlog::register_logger(found);
    }
    found->set_formatter(make_log_formatter(format));
    found->set_level(spdlog_level(level));
    found->flush_on(spdlog::level::info);
  }
}

spdlog::logger& logger(const char* module) {
  const auto found = spdlog::get(module);
  RUNSTONE_ASSERT(found != nullptr);
  return *found;  // spdlog's registry owns it
}

std::uint64_t dropped_log_lines() {
  const auto threads = spdlog::thread_pool();
  return unwritten_lines + (threads == nullptr ? 0 : threads->overrun_counter());
}

}  // namespace runstone
