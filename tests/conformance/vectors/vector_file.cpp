#include "tests/conformance/vectors/vector_file.hpp"

#include <algorithm>

#include "common/core/hex.hpp"
#include "protocol/codec/message_table.hpp"
#include "protocol/codec/messages.hpp"

namespace runstone::conformance {
namespace {

constexpr const char* kMessages = "messages";

/// Decodes a message of a file. Returns nullopt if it is not valid.
std::optional<Message> message_of(const Json& entry, std::uint16_t edge) {
  const std::string digits = entry.at("bytes").get<std::string>();
  // The decoder requires aligned bytes, which a vector of large elements has.
  std::vector<std::uint64_t> aligned(digits.size() / 2 / 8 + 1);
  const std::span<std::uint8_t> bytes(reinterpret_cast<std::uint8_t*>(aligned.data()),
                                      digits.size() / 2);
  if (!read_hex(digits, bytes)) return std::nullopt;
  const auto kind = entry.at("kind").get<std::size_t>();
  if (kind < 1 || kind > kMessageKindCount) return std::nullopt;
  const Sender sender =
      entry.at("from").get<std::string>() == "client" ? Sender::client : Sender::server;
  if (!may_send(info_of(kind - 1), sender)) return std::nullopt;
  auto decoded = decode_message(sender, kind - 1, bytes, edge);
  if (!decoded) return std::nullopt;
  return *std::move(decoded);
}

std::optional<std::string> message_difference(const Json& now, const Json& kept) {
  if (now.size() != kept.size()) return "another number of messages";
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (now[i].at("kind") != kept[i].at("kind") || now[i].at("from") != kept[i].at("from"))
      return "message " + std::to_string(i) + " is of another kind";
    const auto expected = message_of(now[i], 32), found = message_of(kept[i], 32);
    if (!found || found != expected) return "message " + std::to_string(i) + " has another meaning";
  }
  return std::nullopt;
}

}  // namespace

std::vector<VectorFile> vector_files() {
  return {{"chunks.json", chunk_vectors()},
          {"edits.json", edit_vectors()},
          {"borders.json", border_vectors()},
          {"tiles.json", tile_vectors()},
          {"handshake.json", handshake_vectors()}};
}

std::string text_of(const Json& content) {
  std::string out = "{";
  const char* before = "\n";
  for (const auto& [key, value] : content.items()) {
    out += before;
    out += Json(key).dump() + ": ";
    before = ",\n";
    if (!value.is_array()) {
      out += value.dump();
      continue;
    }
    const char* between = "[\n  ";
    for (const Json& entry : value) {
      out += between + entry.dump();
      between = ",\n  ";
    }
    out += "\n]";
  }
  return out + "\n}\n";
}

std::optional<std::string> difference(const VectorFile& now, std::string_view kept) {
  Json old = Json::parse(kept, nullptr, false);
  if (old.is_discarded()) return now.name + " is no JSON";
  Json expected = now.content;
  if (expected.contains(kMessages)) {
    if (!old.contains(kMessages)) return now.name + " has no messages";
    try {
      if (const auto why = message_difference(expected[kMessages], old[kMessages]))
        return now.name + ": " + *why;
    } catch (const Json::exception& error) {
      return now.name + ": " + error.what();
    }
    expected.erase(kMessages);
    old.erase(kMessages);
  }
  for (const auto& [key, value] : expected.items()) {
    if (!old.contains(key)) return now.name + " lacks " + key;
    const Json& found = old[key];
    if (found == value) continue;
    if (value.is_array() && found.is_array()) {
      for (std::size_t i = 0; i < std::min(value.size(), found.size()); ++i) {
        if (value[i] != found[i])
          return now.name + ": " + key + " " + std::to_string(i) + " differs: " + value[i].dump();
      }
      return now.name + ": " + key + " has another number of vectors";
    }
    return now.name + ": " + key + " differs";
  }
  if (old.size() != expected.size()) return now.name + " has more than the library makes";
  return std::nullopt;
}

}  // namespace runstone::conformance
