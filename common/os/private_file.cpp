#include "common/os/private_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "common/os/file_writer.hpp"

namespace runstone {
namespace {

using Written = Result<void, std::string>;

}  // namespace

bool make_private_folder(const std::string& folder) {
  if (folder.empty() || ::access(folder.c_str(), F_OK) == 0) return true;
  return make_private_folder(std::filesystem::path(folder).parent_path().string()) &&
         (::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST);
}

Written write_private_file(const std::string& file, std::string_view bytes) {
  const auto fail = [&file](const std::string& why) {
    return Written(failure(file + ": cannot be written: " + why));
  };
  const std::string folder = std::filesystem::absolute(file).parent_path().string();
  if (!make_private_folder(folder)) return fail(std::strerror(errno));
  auto out = FileWriter::replace(file, 0600);
  if (!out) return fail(out.error());
  out->write(bytes);
  if (const auto done = out->finish(); !done) return fail(done.error());
  return {};
}

Result<std::string, std::string> read_file(const std::string& file, std::size_t bytes_max) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return failure(file + ": is a folder");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) return failure(file + ": cannot be read: " + std::strerror(errno));
  std::string bytes(bytes_max + 1, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad()) return failure(file + ": cannot be read");
  if (bytes.size() > bytes_max)
    return failure(file + ": is larger than " + std::to_string(bytes_max) + " bytes");
  return bytes;
}

std::string set_aside(const std::string& file) {
  const std::string broken = file + ".broken";
  return ::rename(file.c_str(), broken.c_str()) == 0 ? broken : std::string();
}

}  // namespace runstone
