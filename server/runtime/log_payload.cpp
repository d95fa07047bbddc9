#include "server/runtime/log_payload.hpp"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <iterator>
#include <vector>

#include "common/core/text.hpp"

namespace runstone {
namespace {

// Control characters, which no value has after with_field(): the separators of units and records.
constexpr char kText = '\x1f', kNumber = '\x1e', kValue = '\x1d';

struct PayloadField {
  std::string_view name, value;
  bool is_number = false;
};
struct SplitPayload {
  std::string_view text;
  std::vector<PayloadField> fields;
};

bool is_separator(char c) { return c == kText || c == kNumber || c == kValue; }

SplitPayload split(std::string_view payload) {
  SplitPayload out;
  std::size_t at = std::min(payload.find_first_of("\x1f\x1e"), payload.size());
  out.text = payload.substr(0, at);
  while (at < payload.size()) {
    const std::size_t end = std::min(payload.find_first_of("\x1f\x1e", at + 1), payload.size());
    const std::string_view field = payload.substr(at + 1, end - at - 1);
    const std::size_t value = field.find(kValue);
    if (value != std::string_view::npos) {
      out.fields.push_back(
          {field.substr(0, value), field.substr(value + 1), payload[at] == kNumber});
    }
    at = end;
  }
  return out;
}

/// Returns the number of bytes of the printable character at the beginning of `text`, or 0 if there
/// is none.
std::size_t printable_bytes(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t bytes = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
  const std::string_view character = text.substr(0, bytes);
  return character.size() == bytes && is_printable_utf8(character) ? bytes : 0;
}

/// Appends a text. `escape` gets each byte that is no part of a printable character. Printable
/// characters of `quoted` get a backslash before them.
template <class Escape>
void append(std::string& out, std::string_view text, std::string_view quoted, Escape&& escape) {
  const bool is_cut = text.size() > kPayloadBytesMax;
  if (is_cut) text = text.substr(0, kPayloadBytesMax);
  while (!text.empty()) {
    const std::size_t bytes = printable_bytes(text);
    if (bytes == 0) {
      escape(out, static_cast<unsigned char>(text.front()));
    } else {
      if (quoted.find(text.front()) != std::string_view::npos) out += '\\';
      out += text.substr(0, bytes);
    }
    text.remove_prefix(std::max<std::size_t>(bytes, 1));
  }
  if (is_cut) out += "...";
}

void append_text(std::string& out, std::string_view text, std::string_view quoted) {
  append(out, text, quoted, [](std::string& line, unsigned char byte) {
    fmt::format_to(std::back_inserter(line), "\\x{:02x}", byte);
  });
}

bool is_plain_value(std::string_view value) {
  return !value.empty() && std::all_of(value.begin(), value.end(), [](char c) {
    constexpr std::string_view kSigns = "._:,/+-[]";
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           kSigns.find(c) != std::string_view::npos;
  });
}

}  // namespace

std::string with_field(std::string payload, std::string_view name, std::string_view value) {
  payload += kText;
  payload += name;
  payload += kValue;
  std::replace_copy_if(value.begin(), value.end(), std::back_inserter(payload), is_separator, '?');
  return payload;
}

std::string with_field(std::string payload, std::string_view name, std::uint64_t value) {
  payload += kNumber;
  payload += name;
  payload += kValue;
  payload += std::to_string(value);
  return payload;
}

std::string text_of(std::string_view payload) {
  const SplitPayload parts = split(payload);
  std::string out;
  append_text(out, parts.text, "");
  for (const PayloadField& field : parts.fields) {
    out += ' ';
    out += field.name;
    out += '=';
    const bool is_plain = is_plain_value(field.value);
    if (!is_plain) out += '"';
    append_text(out, field.value, "\"\\");
    if (!is_plain) out += '"';
  }
  return out;
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  append(out, text, "\"\\", [](std::string& line, unsigned char byte) {
    if (byte < 0x80) {
      fmt::format_to(std::back_inserter(line), "\\u{:04x}", byte);
    } else {
      line += "\\ufffd";
    }
  });
  return out + '"';
}

std::string json_of(std::string_view payload) {
  const SplitPayload parts = split(payload);
  std::string out = "\"message\":" + json_string(parts.text);
  for (const PayloadField& field : parts.fields) {
    out += ",\"" + std::string(field.name) + "\":";
    out += field.is_number ? std::string(field.value) : json_string(field.value);
  }
  return out;
}

}  // namespace runstone
