#include "client/fleet/recorded_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

#include "common/os/private_file.hpp"

namespace runstone {

Result<RecordedLog, std::string> read_recorded_file(const std::string& file) {
  // A pipe cannot be read from its middle, and opening one waits for its other end.
  if (const auto kind = check_file_kind(file); !kind) return failure(kind.error());
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(file + ": cannot be read: " + std::strerror(errno));
  auto log = read_recorded_log(
      [&in](std::uint64_t position, std::span<std::uint8_t> out) -> std::optional<std::size_t> {
        in.clear();  // an earlier read may have met the end
        if (!in.seekg(static_cast<std::streamoff>(position))) return std::nullopt;
        in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
        if (in.bad()) return std::nullopt;
        return static_cast<std::size_t>(in.gcount());
      });
  if (!log) return failure(file + ": " + log.error());
  return log;
}

}  // namespace runstone
