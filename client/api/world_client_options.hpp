// WorldClientOptions: the server that a WorldClient joins, and the player who joins it.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace runstone {

/// How a WorldClient protects its connection.
enum class Encryption : std::uint8_t {
  /// TLS 1.3. Every certificate is accepted, because the handshake proves the key of the server on
  /// this connection, and the key of a known world must be the known one.
  any_certificate,
  /// TLS 1.3 with a certificate of WorldClientOptions::authorities_file for the name of the server.
  authorities,
  /// No encryption, for servers that run with --insecure. No password is sent.
  none,
};

struct WorldClientOptions {
  /// HOST, HOST:PORT or a link `runstone://HOST:PORT/#INVITE`. Several addresses of servers of one
  /// world are separated by commas.
  std::string server = {};
  /// An invite token. Empty: the client uses the token of the link in `server`, if there is one.
  std::string invite = {};
  /// The password of the world. Empty: no password.
  std::string password = {};
  /// The name of the player, 1 to 32 bytes of UTF-8 (check_player_name()).
  std::string name = "builder";

  /// The file of the player's identity. It is made if it is missing, and only its owner may read
  /// it. The keys of known servers are kept beside it, in a file with `.servers` at the end of its
  /// name. Empty: the identity comes from `key_seed`, or is random, and is not kept.
  std::string key_file = {};
  /// The secret seed of the identity (Ed25519), for programs that keep it themselves. It is used if
  /// `key_file` is empty.
  std::optional<std::array<std::uint8_t, 32>> key_seed = std::nullopt;

  Encryption encryption = Encryption::any_certificate;
  /// A PEM file with authorities. Empty: the authorities that the system trusts.
  std::string authorities_file = {};

  /// The radii of the view around the player, in chunks: 0 to 64. The server may allow less.
  std::uint8_t view_radius = 8, view_radius_vertical = 4;
  /// The greatest memory of chunks and edits, in MiB: 16 to 65,536. If the server sends more, the
  /// view shrinks.
  std::uint64_t memory_mib = 1024;

  /// Chunks are kept in this folder between runs. Empty: they are not kept.
  std::string cache_folder = {};
  /// The greatest size of the cache, in MiB: 1 to 1,048,576.
  std::uint64_t cache_mib = 256;

  /// A thread of the library calls this function when step() has something to do. The function must
  /// not call the client, nor wait for a thread that may be in a call of the client.
  std::function<void()> wake = {};
};

}  // namespace runstone
