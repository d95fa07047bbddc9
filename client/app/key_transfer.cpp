#include "client/app/key_transfer.hpp"

#include <sodium.h>

#include <chrono>
#include <ostream>
#include <utility>

#include "client/net/key_file.hpp"
#include "client/net/net_client.hpp"
#include "client/net/wake_up.hpp"
#include "client/session/key_transfer_session.hpp"
#include "common/os/steady_clock.hpp"
#include "protocol/codec/device_code.hpp"
#include "protocol/codec/key_fingerprint.hpp"

namespace runstone {
namespace {

/// Runs the session on one connection until it has an outcome.
Result<KeyTransferSession::Answer, std::string> run_transfer(const KeyCommand& command,
                                                             KeyTransferSession& session) {
  WakeUp wake;
  LinkConfig link;
  link.host = command.server.host;
  link.port = command.server.port;
  link.tls = command.tls;
  NetClient net(std::move(link), [&wake] { wake.notify(); });
  const TimeUs end_us = steady_now_us() + kKeyTransferMs * 1'000;
  ConnectionNumber connection = 0;
  while (!session.outcome()) {
    for (LinkEvent& event : net.take_events()) {
      if (const auto* up = std::get_if<LinkConnected>(&event)) {
        connection = up->connection;
        session.connected(random_nonce(), up->binding);
      } else if (const auto* down = std::get_if<LinkDisconnected>(&event)) {
        session.disconnected(down->why);
      } else {
        session.receive(std::get<LinkReceived>(event).message);
      }
      for (const Message& message : session.take_outgoing())
        net.send(connection, encode_message(message));
    }
    if (steady_now_us() >= end_us) session.disconnected("no answer in time");
    if (!session.outcome()) wake.wait(std::chrono::milliseconds(50));
  }
  net.stop(0);
  const auto& outcome = *session.outcome();
  if (!outcome) return failure(to_string(command.server) + ": " + outcome.error());
  return *outcome;
}

/// Saves and prints the key of a server that was met for the first time.
void note_first_contact(const KeyCommand& command, const KeyTransferSession& session,
                        std::size_t pinned_before, std::ostream& out) {
  if (session.pinned().size() == pinned_before) return;
  save_pinned_servers(command.key_file, session.pinned());
  out << "first contact with this server: its fingerprint is "
      << key_fingerprint(session.welcome()->server_key) << "\n";
}

template <std::size_t N>
std::array<std::uint8_t, N> random_array() {
  std::array<std::uint8_t, N> bytes{};
  randombytes_buf(bytes.data(), bytes.size());
  return bytes;
}

}  // namespace

Result<void, std::string> send_key(const KeyCommand& command, std::ostream& out) {
  const KeySeed seed = load_key_seed(command.key_file);
  if (sodium_init() < 0) return failure("libsodium cannot start");
  const DeviceCode code(random_array<kDeviceCodeBytes>());
  const KeyDeposit deposit{code.slot(), code.seal(seed, random_array<kDeviceNonceBytes>()), {}};
  const auto pinned = load_pinned_servers(command.key_file);
  KeyTransferSession session(key_pair_of(seed), pinned, deposit);
  const auto answer = run_transfer(command, session);
  if (!answer) return failure(answer.error());
  note_first_contact(command, session, pinned.size(), out);
  out << "code " << code.text() << "\nWithin " << std::get<KeyDeposited>(*answer).seconds / 60
      << " minutes, type on the other device:\n  runstone-client key receive --connect "
      << to_string(command.server)
      << " --key FILE\nIt asks for the code, which works once. Whoever "
      << "has the code gets your key: tell it to nobody.\n";
  return {};
}

Result<KeySeed, std::string> receive_key(const KeyCommand& command, std::ostream& out) {
  // A code works once. The checks that need no server come first, so that they do not use it up.
  require_new_key_file(command.key_file);
  const auto code = DeviceCode::parse(command.code);
  if (!code) return failure("this is no code: a code is 16 letters and digits, without U");
  const auto pinned = load_pinned_servers(command.key_file);
  KeyTransferSession session(random_key(), pinned, KeyRequest{code->slot()});
  const auto answer = run_transfer(command, session);
  if (!answer) return failure(answer.error());
  const auto seed = code->open(std::get<SealedKey>(*answer).sealed);
  if (!seed) return failure("the server sent something that is not a key sealed with this code");
  save_new_key(command.key_file, *seed);
  note_first_contact(command, session, pinned.size(), out);
  return *seed;
}

}  // namespace runstone
