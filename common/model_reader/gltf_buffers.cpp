#include "common/model_reader/gltf_buffers.hpp"

#include <nlohmann/json.hpp>
#include <utility>

#include "common/model_reader/folder_files.hpp"
#include "common/models/printable_line.hpp"

namespace runstone {
namespace {

constexpr std::size_t kGlbChunkHeadBytes = 8;
constexpr std::size_t kAddressBytesMax = 100;  // of a message

int base64_digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

}  // namespace

std::optional<std::string> base64_decoded(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  unsigned count = 0;
  for (const char c : text) {
    const int digit = base64_digit(c);
    if (digit < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<std::uint32_t>(digit)) & 0xffff;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(static_cast<char>(bits >> count & 0xff));
  }
  return out;
}

Result<GltfBuffers::Source, std::string> GltfBuffers::open(const nlohmann::json& buffer) {
  Source out;
  const auto uri = buffer.find("uri");
  if (uri == buffer.end()) {
    if (!head_.is_binary) return failure(std::string("a buffer has no address"));
    out.is_chunk = true;
    return out;
  }
  const auto& address = uri->get_ref<const std::string&>();
  if (address.compare(0, 5, "data:") == 0) {
    const std::size_t comma = address.find(',');
    constexpr std::string_view kBase64 = ";base64";
    const bool is_base64 = comma != std::string::npos && comma >= kBase64.size() &&
                           address.compare(comma - kBase64.size(), kBase64.size(), kBase64) == 0;
    auto bytes = is_base64 ? base64_decoded(std::string_view(address).substr(comma + 1))
                           : std::optional<std::string>();
    if (!bytes) return failure(std::string("a buffer in the file is no base64"));
    out.bytes = *std::move(bytes);
    return out;
  }
  auto opened = folder_.open(address);
  if (!opened && opened.error() == ModelFolder::Refusal::missing)
    opened = folder_.open(percent_decoded(address));
  if (!opened)
    return failure("refers to \"" + printable_line(address, kAddressBytesMax) + "\", " +
                   ModelFolder::words(opened.error()));
  out.file = *std::move(opened);
  return out;
}

Result<void, std::string> GltfBuffers::read(std::uint64_t buffer, std::uint64_t offset, void* to,
                                            std::size_t count) {
  auto known = sources_.find(buffer);
  if (known == sources_.end()) {
    if (buffer >= buffers_.size()) return failure(std::string("a buffer does not exist"));
    auto source = open(buffers_.at(static_cast<std::size_t>(buffer)));
    if (!source) return failure(source.error());
    known = sources_.emplace(buffer, *std::move(source)).first;
  }
  const Source& source = known->second;
  std::size_t got = 0;
  if (source.is_chunk) {
    got = file_.read(to, count, head_.end + kGlbChunkHeadBytes + offset);
  } else if (source.file) {
    got = source.file->read(to, count, offset);
  } else if (offset < source.bytes.size()) {
    got = source.bytes.copy(static_cast<char*>(to), count, static_cast<std::size_t>(offset));
  }
  if (got != count) return failure(std::string("ends early: a buffer has too few bytes"));
  return {};
}

}  // namespace runstone
