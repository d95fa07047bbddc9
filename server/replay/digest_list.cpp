#include "server/replay/digest_list.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "common/core/hex.hpp"
#include "common/core/m61.hpp"
#include "common/os/output_file.hpp"
#include "common/os/private_file.hpp"

namespace runstone {

namespace {

using Json = nlohmann::json;

/// A row has about 120 bytes, so this is the list of 30 million chunks.
constexpr std::size_t kDigestListBytesMax = std::size_t{4} << 30;

Unexpected<TextError> text_failure(std::string_view file, std::string key, std::string what) {
  return {TextError{std::string(file), 0, std::move(key), std::move(what)}};
}

/// Parses exactly `digits` lower-case hex digits.
std::optional<std::uint64_t> parse_hex(std::string_view text, std::size_t digits) {
  std::uint64_t value = 0;
  if (text.size() != digits) return std::nullopt;
  for (const char c : text) {
    if ((c < '0' || c > '9') && (c < 'a' || c > 'f')) return std::nullopt;
  }
  if (std::from_chars(text.data(), text.data() + text.size(), value, 16).ec != std::errc())
    return std::nullopt;
  return value;
}

std::optional<Digest> parse_digest(std::string_view text) {
  if (text.size() != 32) return std::nullopt;
  Digest digest;
  for (std::size_t lane = 0; lane < 2; ++lane) {
    const auto value = parse_hex(text.substr(16 * lane, 16), 16);
    if (!value || *value >= m61::kPrime) return std::nullopt;
    digest.lane[lane] = *value;
  }
  return digest;
}

/// Returns member `key` of an object if it is an integer in [low, high].
template <class T>
std::optional<T> integer(const Json& object, const char* key, T low, T high) {
  const auto member = object.find(key);
  if (member == object.end() || !member->is_number_integer()) return std::nullopt;
  if (member->is_number_unsigned()) {
    const auto value = member->get<std::uint64_t>();
    if (value > static_cast<std::uint64_t>(high)) return std::nullopt;
    return std::max(low, static_cast<T>(value)) == static_cast<T>(value)
               ? std::optional<T>(static_cast<T>(value))
               : std::nullopt;
  }
  const auto value = member->get<std::int64_t>();
  if constexpr (std::is_unsigned_v<T>) return std::nullopt;
  if (value < static_cast<std::int64_t>(low)) return std::nullopt;
  return static_cast<T>(value);
}

std::optional<std::string> text_member(const Json& object, const char* key) {
  const auto member = object.find(key);
  if (member == object.end() || !member->is_string()) return std::nullopt;
  return member->get<std::string>();
}

std::optional<DigestCheckEntry> parse_entry(const Json& row) {
  if (!row.is_object()) return std::nullopt;
  constexpr auto kLow = std::numeric_limits<std::int32_t>::min();
  constexpr auto kHigh = std::numeric_limits<std::int32_t>::max();
  const auto lod = integer<std::uint32_t>(row, "lod", 0, 255);
  const auto x = integer<std::int32_t>(row, "x", kLow, kHigh);
  const auto y = integer<std::int32_t>(row, "y", kLow, kHigh);
  const auto z = integer<std::int32_t>(row, "z", kLow, kHigh);
  const auto epoch = integer<Epoch>(row, "epoch", 0, std::numeric_limits<Epoch>::max());
  const auto seq = integer<Sequence>(row, "seq", 0, std::numeric_limits<Sequence>::max());
  const auto hex = text_member(row, "digest");
  const auto digest = hex ? parse_digest(*hex) : std::nullopt;
  if (!lod || !x || !y || !z || !epoch || !seq || !digest) return std::nullopt;
  return DigestCheckEntry{{static_cast<std::uint8_t>(*lod), {*x, *y, *z}}, {*epoch, *seq}, *digest};
}

}  // namespace

std::string to_json(const DigestList& list) {
  std::vector<const DigestCheckEntry*> rows;
  rows.reserve(list.chunks.size());
  for (const DigestCheckEntry& entry : list.chunks) rows.push_back(&entry);
  std::sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->key < b->key; });
  // The JSON library would put each number on a line of its own, or everything on one line.
  std::string json = "{\"world_id\":\"" + to_hex(list.world_id) +
                     "\",\"seq\":" + std::to_string(list.seq) +
                     (list.is_clean ? "" : ",\"clean\":false") + ",\"chunks\":[";
  const char* separator = "\n";
  for (const DigestCheckEntry* row : rows) {
    const ChunkCoord at = row->key.at;
    json += separator;
    json += "{\"lod\":" + std::to_string(row->key.lod) + ",\"x\":" + std::to_string(at.x) +
            ",\"y\":" + std::to_string(at.y) + ",\"z\":" + std::to_string(at.z) +
            ",\"epoch\":" + std::to_string(row->version.epoch) +
            ",\"seq\":" + std::to_string(row->version.seq) + ",\"digest\":\"" +
            to_hex(row->digest) + "\"}";
    separator = ",\n";
  }
  json += "\n]}\n";
  return json;
}

Result<DigestList, TextError> parse_digests_json(std::string_view text, std::string_view file) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return text_failure(file, "", "is no JSON object");
  DigestList list;
  const auto world = text_member(json, "world_id");
  if (!world || world->size() != 2 * list.world_id.size())
    return text_failure(file, "world_id", "needs 32 hex digits");
  for (std::size_t i = 0; i < list.world_id.size(); ++i) {
    const auto byte = parse_hex(std::string_view(*world).substr(2 * i, 2), 2);
    if (!byte) return text_failure(file, "world_id", "needs 32 hex digits");
    list.world_id[i] = static_cast<std::uint8_t>(*byte);
  }
  const auto seq = integer<Sequence>(json, "seq", 0, std::numeric_limits<Sequence>::max());
  if (!seq) return text_failure(file, "seq", "needs a sequence number");
  list.seq = *seq;
  if (const auto clean = json.find("clean"); clean != json.end() && *clean != Json(true)) {
    return text_failure(
        file, "clean",
        "is not true: the server did not stop cleanly, so this is no digest of its seq");
  }
  const auto chunks = json.find("chunks");
  if (chunks == json.end() || !chunks->is_array())
    return text_failure(file, "chunks", "needs a list");
  list.chunks.reserve(chunks->size());
  for (const Json& row : *chunks) {
    auto entry = parse_entry(row);
    if (!entry) {
      return text_failure(file, "chunks[" + std::to_string(list.chunks.size()) + "]",
                          "needs lod, x, y, z, epoch, seq in range and a digest of 32 hex digits");
    }
    list.chunks.push_back(*entry);
  }
  return list;
}

Result<void, std::string> write_digests_json(const std::string& file, const DigestList& list) {
  return write_output_file(file, to_json(list));
}

Result<DigestList, TextError> read_digests_json(const std::string& file) {
  const auto text = read_file(file, kDigestListBytesMax, FileKinds::regular_or_pipe);
  // The line of the error begins with the name of the file, which is a field of its own in TextError.
  if (!text) return text_failure(file, "", text.error().substr(file.size() + 2));
  return parse_digests_json(*text, file);
}

}  // namespace runstone
