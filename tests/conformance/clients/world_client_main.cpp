// The client of runstone::client under test by runstone-conformance.
//   conformance-world-client ADDRESS KEY tls|plain
#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>

#include "client/api/world_client.hpp"
#include "common/core/hex.hpp"
#include "common/edits/descriptor/edit_descriptor.hpp"
#include "common/runs/run_chunk.hpp"

using namespace runstone;

namespace {

void print_digests(const WorldClient& client) {
  for (const ChunkCoord at : client.chunks()) {
    const Digest digest = digest_of(*client.chunk(at));
    std::printf("chunk %d %d %d %016llx %016llx\n", at.x, at.y, at.z,
                static_cast<unsigned long long>(digest.lane[0]),
                static_cast<unsigned long long>(digest.lane[1]));
  }
  std::puts("done");
}

/// Does what a line says. Returns false if the program has to end.
bool obey(WorldClient& client, const std::string& line) {
  std::istringstream words(line);
  std::string verb, digits;
  words >> verb;
  if (verb == "digest") print_digests(client);
  if (verb == "edit") {
    words >> digits;
    Bytes bytes(digits.size() / 2);
    const auto edit = read_hex(digits, bytes)
                          ? decode_descriptor(bytes)
                          : Result<EditDescriptor>(fail(ErrorCode::bad_value, ""));
    const auto sent =
        edit ? client.submit(*edit) : Result<EditNumber, ClientRefusal>(EditNumber{0});
    if (!sent) std::printf("rejected %s\n", sent.error().text.c_str());
  }
  if (verb == "move") {
    ClientPlace place = client.place();
    words >> place.at.x >> place.at.y >> place.at.z;
    static_cast<void>(client.move(place));
  }
  return verb != "quit";
}

void report(const WorldEvent& event) {
  if (std::holds_alternative<WorldOpened>(event)) std::puts("open");
  if (const auto* lost = std::get_if<ConnectionLost>(&event)) {
    std::printf("lost %s %s: %s\n", lost->is_final ? "final" : "again", lost->headline.c_str(),
                lost->detail.c_str());
  }
  if (const auto* applied = std::get_if<EditConfirmed>(&event))
    std::printf("applied %llu\n", static_cast<unsigned long long>(applied->sequence));
  if (const auto* rejected = std::get_if<EditRejected>(&event))
    std::printf("rejected %s\n", rejected->reason.c_str());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const bool is_plain = std::string(argv[3]) == "plain";
  auto client =
      WorldClient::connect({.server = argv[1],
                            .encryption = is_plain ? Encryption::none : Encryption::any_certificate,
                            .view_radius = 2,
                            .view_radius_vertical = 2});
  if (!client) {
    std::cerr << client.error() << '\n';
    return 1;
  }
  std::setvbuf(stdout, nullptr, _IOLBF, 0);
  std::string text;
  for (;;) {
    client->wait(5);
    client->step();
    for (const WorldEvent& event : client->drain()) report(event);
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (::poll(&ready, 1, 0) <= 0) continue;
    char buffer[4096];
    const ssize_t got = ::read(STDIN_FILENO, buffer, sizeof buffer);
    if (got <= 0) return 0;
    text.append(buffer, static_cast<std::size_t>(got));
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
      if (!obey(*client, text.substr(0, end))) {
        client->close();
        return 0;
      }
      text.erase(0, end + 1);
    }
  }
}
