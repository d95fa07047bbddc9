#include "client/net/key_file.hpp"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "common/core/hex.hpp"
#include "common/os/private_file.hpp"
#include "common/os/text_file.hpp"

namespace runstone {
namespace {

constexpr const char* kPinsSuffix = ".servers";

[[noreturn]] void throw_error(const std::string& file, const std::string& why) {
  throw std::runtime_error(file + ": " + why);
}

void need_sodium() {
  if (sodium_init() < 0) throw std::runtime_error("libsodium cannot start");
}

}  // namespace

void write_new_secret_file(const std::string& file, const std::string& text) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0) throw_error(file, std::strerror(errno));
  const bool is_written =
      ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(fd) == 0;
  const bool is_closed = ::close(fd) == 0;
  if (is_written && is_closed) return;
  ::unlink(file.c_str());
  throw_error(file, "cannot be written");
}

void require_new_key_file(const std::string& file) {
  if (std::filesystem::exists(file))
    throw_error(file, "exists, and a key file is never overwritten");
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw_error(file, "cannot be written: " + folder.string() + ": " + std::strerror(errno));
}

void save_new_key(const std::string& file, const KeySeed& seed) {
  write_new_secret_file(file, to_hex(seed) + "\n");
}

KeySeed load_key_seed(const std::string& file) {
  struct stat info{};
  if (::stat(file.c_str(), &info) != 0) throw_error(file, std::strerror(errno));
  const auto kind = check_file_kind(file, FileKinds::regular_or_pipe);
  if (!kind) throw std::runtime_error(kind.error());
  if ((info.st_mode & 077) != 0)
    throw_error(file, "other users may read this key: run chmod 600 on it");
  const auto line = read_first_line(file);
  KeySeed seed;
  if (!line || !read_hex(*line, seed))
    throw_error(file,
                "is not a key file (64 hex digits): copy the key again, or take a backup of it");
  return seed;
}

KeyPair load_or_create_key(const std::string& file) {
  need_sodium();
  struct stat info{};
  if (::stat(file.c_str(), &info) != 0 && errno == ENOENT) {
    KeySeed seed;
    randombytes_buf(seed.data(), seed.size());
    save_new_key(file, seed);
    return key_pair_of(seed);
  }
  return key_pair_of(load_key_seed(file));
}

KeyPair random_key() {
  need_sodium();
  KeySeed seed;
  randombytes_buf(seed.data(), seed.size());
  return key_pair_of(seed);
}

Nonce random_nonce() {
  need_sodium();
  Nonce nonce;
  randombytes_buf(nonce.data(), nonce.size());
  return nonce;
}

ClientInstance random_instance() {
  need_sodium();
  ClientInstance instance = 0;
  while (instance == 0) randombytes_buf(&instance, sizeof instance);
  return instance;
}

std::map<WorldId, PublicKey> load_pinned_servers(const std::string& key_file) {
  std::map<WorldId, PublicKey> pinned;
  const std::string file = key_file + kPinsSuffix;
  if (!std::filesystem::exists(file)) return pinned;
  const auto text = read_text_file(file, kTextFileBytesMax);
  if (!text) throw std::runtime_error(text.error());
  std::istringstream in(*text);
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    std::istringstream fields(line);
    std::string world, key;
    WorldId world_id;
    PublicKey server_key;
    if (!(fields >> world >> key) || !read_hex(world, world_id) || !read_hex(key, server_key)) {
      throw_error(file + ":" + std::to_string(number),
                  "expected a world id and a server key in hex");
    }
    pinned[world_id] = server_key;
  }
  return pinned;
}

void save_pinned_servers(const std::string& key_file, const std::map<WorldId, PublicKey>& pinned) {
  const std::string file = key_file + kPinsSuffix;
  std::string text;
  for (const auto& [world, key] : pinned) text += to_hex(world) + ' ' + to_hex(key) + '\n';
  const auto written = write_private_file(file, text);
  if (!written) throw std::runtime_error(written.error());
}

}  // namespace runstone
