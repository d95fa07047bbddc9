#include "server/web/client_files.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include "common/core/hex.hpp"
#include "common/os/private_file.hpp"

namespace runstone {
namespace {

struct KnownFile {
  std::string_view name;
  const char* type;
};
constexpr std::string_view kPage = "client.html";
constexpr std::array<KnownFile, 13> kFiles = {{
    {kPage, "text/html; charset=utf-8"},
    {"client.css", "text/css; charset=utf-8"},
    {"client.js", "text/javascript; charset=utf-8"},
    {"program.js", "text/javascript; charset=utf-8"},
    {"typing.js", "text/javascript; charset=utf-8"},
    {"keys.js", "text/javascript; charset=utf-8"},
    {"database.js", "text/javascript; charset=utf-8"},
    {"chunks.js", "text/javascript; charset=utf-8"},
    {"textures.js", "text/javascript; charset=utf-8"},
    {"ticker.js", "text/javascript; charset=utf-8"},
    {"runstone-web-client.js", "text/javascript; charset=utf-8"},
    {"runstone-web-client.wasm", "application/wasm"},
    {"DejaVuSans.ttf", "font/ttf"},
}};

// The largest file of the client has some 4 MiB.
constexpr std::size_t kClientFileBytesMax = std::size_t{64} << 20;

/// Returns a number that differs for different files with near certainty (FNV-1a).
std::uint64_t number_of(std::string_view bytes) {
  std::uint64_t out = 0xcbf29ce484222325;
  for (const char c : bytes) out = (out ^ static_cast<std::uint8_t>(c)) * 0x100000001b3;
  return out;
}

ClientFile file_of(const char* type, const char* encoding, std::string bytes) {
  std::array<std::uint8_t, 8> number{};
  std::uint64_t left = number_of(bytes);
  for (std::uint8_t& byte : number) {
    byte = static_cast<std::uint8_t>(left & 0xff);
    left >>= 8;
  }
  return {type, encoding, '"' + to_hex(number) + encoding + '"',
          std::make_shared<const std::string>(std::move(bytes))};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

}  // namespace

Result<ClientFiles, std::string> ClientFiles::load(const std::string& folder) {
  ClientFiles out;
  for (const auto& [name, type] : kFiles) {
    const std::string path = folder + '/' + std::string(name);
    auto bytes = read_file(path, kClientFileBytesMax);
    if (!bytes) return failure(bytes.error());
    Forms forms;
    forms.plain = file_of(type, "", *std::move(bytes));
    if (auto packed = read_file(path + ".gz", kClientFileBytesMax))
      forms.gzip = file_of(type, "gzip", *std::move(packed));
    if (auto packed = read_file(path + ".br", kClientFileBytesMax))
      forms.brotli = file_of(type, "br", *std::move(packed));
    out.files_[std::string(kClientPath) + std::string(name == kPage ? "" : name)] =
        std::move(forms);
  }
  return out;
}

const ClientFile* ClientFiles::find(std::string_view path, std::string_view accept_encoding) const {
  const auto found = files_.find(path);
  if (found == files_.end()) return nullptr;
  const Forms& forms = found->second;
  if (forms.brotli.bytes && accepts(accept_encoding, "br")) return &forms.brotli;
  if (forms.gzip.bytes && accepts(accept_encoding, "gzip")) return &forms.gzip;
  return &forms.plain;
}

bool accepts(std::string_view accept_encoding, std::string_view coding) {
  while (!accept_encoding.empty()) {
    const std::size_t comma = accept_encoding.find(',');
    const std::string_view one = accept_encoding.substr(0, comma);
    accept_encoding = comma == std::string_view::npos ? "" : accept_encoding.substr(comma + 1);
    const std::size_t semicolon = one.find(';');
    if (trimmed(one.substr(0, semicolon)) != coding) continue;
    if (semicolon == std::string_view::npos) return true;
    const std::string_view share = trimmed(one.substr(semicolon + 1));
    return !share.starts_with("q=0") || share.find_first_not_of("0.", 2) != std::string_view::npos;
  }
  return false;
}

}  // namespace runstone
