#include "server/runtime/log_payload.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "server/runtime/log_formatter.hpp"

using namespace runstone;

namespace {

std::string line_of(LogFormat format, const std::string& payload) {
  spdlog::details::log_msg message(spdlog::log_clock::time_point(std::chrono::milliseconds(1'123)),
                                   {}, "app", spdlog::level::warn, payload);
  spdlog::memory_buf_t out;
  make_log_formatter(format)->format(message, out);
  return {out.data(), out.size()};
}

/// Texts that try to break a line, forge a field or control a terminal.
const std::string kHostile[] = {"a\nadmin came author=1",
                                "x\" author=1 y=\"",
                                "\x1b[2Jgone",
                                "\\",
                                "a\x1f"
                                "author\x1d"
                                "1",
                                "\xff\xfe",
                                "\xc2\x85",
                                std::string("\0b", 2)};

}  // namespace

TEST_CASE("a payload becomes text with fields", "[log]") {
  std::string payload = with_field("came", "name", "the mole");
  payload = with_field(payload, "key", "0a1b");
  payload = with_field(payload, "author", std::uint64_t{3});
  CHECK(text_of(payload) == "came name=\"the mole\" key=0a1b author=3");
  CHECK(json_of(payload) == R"("message":"came","name":"the mole","key":"0a1b","author":3)");
  CHECK(text_of(with_field("came", "name", "")) == "came name=\"\"");
  CHECK(text_of("session=7 chunk=1,0,-3") == "session=7 chunk=1,0,-3");
}

TEST_CASE("no value breaks a line of text or forges a field", "[log]") {
  for (const std::string& value : kHostile) {
    CAPTURE(value);
    for (const std::string& payload : {with_field("came", "name", value), value}) {
      const std::string line = line_of(LogFormat::text, payload);
      CHECK(std::count(line.begin(), line.end(), '\n') == 1);
      CHECK(std::none_of(line.begin(), line.end() - 1, [](char c) {
        return (c >= 0 && c < ' ') || c == '\x7f' || static_cast<unsigned char>(c) > 0xf4;
      }));
    }
  }
  CHECK(text_of(with_field("came", "name", "x\" author=1")) == R"(came name="x\" author=1")");
  CHECK(text_of(with_field("came", "name", "a\nb")) == R"(came name="a\x0ab")");
}

TEST_CASE("every line of JSON is one object with the values as they are", "[log]") {
  for (const std::string& value : kHostile) {
    CAPTURE(value);
    const std::string line = line_of(LogFormat::json, with_field("came", "name", value));
    CHECK(std::count(line.begin(), line.end(), '\n') == 1);
    const auto object = nlohmann::json::parse(line);
    CHECK(object.size() == 5);
    CHECK(object["message"] == "came");
    CHECK(object["level"] == "warning");
    CHECK(object["logger"] == "app");
    CHECK(object["time"] == "1970-01-01T00:00:01.123Z");
    const bool is_text = value.find_first_of("\x1f\xff\xc2") == std::string::npos;
    if (is_text) CHECK(object["name"] == value);
  }
}

TEST_CASE("a long value is cut", "[log]") {
  const std::string payload = with_field("came", "name", std::string(1'000'000, 'x'));
  CHECK(text_of(payload).size() < kPayloadBytesMax + 100);
  CHECK(json_of(payload).size() < kPayloadBytesMax + 100);
}
