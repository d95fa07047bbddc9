#include "server/runtime/log_formatter.hpp"

#include <spdlog/fmt/chrono.h>
#include <spdlog/pattern_formatter.h>

#include <chrono>
#include <string_view>

#include "server/runtime/log_payload.hpp"

namespace runstone {
namespace {

std::string_view view_of(spdlog::string_view_t text) { return {text.data(), text.size()}; }

/// The payload in a pattern.
class PayloadFlag final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& line, const std::tm& /*time*/,
              spdlog::memory_buf_t& out) override {
    const std::string text = text_of(view_of(line.payload));
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<PayloadFlag>();
  }
};

class JsonFormatter final : public spdlog::formatter {
 public:
  void format(const spdlog::details::log_msg& line, spdlog::memory_buf_t& out) override {
    using std::chrono::duration_cast;
    const auto since = line.time.time_since_epoch();
    const auto seconds = duration_cast<std::chrono::seconds>(since);
    const std::string text =
        fmt::format("{{\"time\":\"{:%Y-%m-%dT%H:%M:%S}.{:03}Z\",\"level\":{},\"logger\":{},{}}}\n",
                    fmt::gmtime(spdlog::log_clock::to_time_t(line.time)),
                    duration_cast<std::chrono::milliseconds>(since - seconds).count(),
                    json_string(view_of(spdlog::level::to_string_view(line.level))),
                    json_string(view_of(line.logger_name)), json_of(view_of(line.payload)));
    out.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<JsonFormatter>();
  }
};

}  // namespace

std::unique_ptr<spdlog::formatter> make_log_formatter(LogFormat format) {
  if (format == LogFormat::json) return std::make_unique<JsonFormatter>();
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<PayloadFlag>('*').set_pattern("%Y-%m-%dT%H:%M:%S.%e %^%l%$ %n: %*");
  return formatter;
}

}  // namespace runstone
